//! Groups of keys that several commands share.

use super::key::declared;
use super::steps::Steps;
use crate::names::{TensionRuleName, optional};
use crate::values::{finite, not_negative, positive};
use anyhow::{Result, anyhow, bail};
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::math::{Quaternion, Rotation, Vec3, rotation};
use funicular::robot::{Robot, RobotChange, WinchMode};
use funicular::statics::StaticModel;
use serde::{Deserialize, Serialize};

/// Text of a robot file with its changes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotText {
    /// Origin of the text, for messages and pages.
    #[serde(default)]
    pub name: String,
    /// Text of the robot file (TOML).
    pub text: String,
    /// Changes of the text, made in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<Change>,
}

/// Change of one value of the robot file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Keys from the root of the file, as in `platform.mass_kg` or `cables.3.anchor_m`.
    pub path: String,
    /// New value: a number, a text, a truth value, or a list of these.
    pub value: serde_json::Value,
}

/// Pose of the platform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "PoseForm", into = "PoseForm")]
pub enum Pose {
    /// Position x, y, z [m] and roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
    Angles([f64; 6]),
    /// Position [m] and unit quaternion w, x, y, z from platform to world axes, with every digit.
    Quaternion([f64; 3], [f64; 4]),
}

/// Forms of a pose in JSON.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "a pose is [x, y, z], [x, y, z, roll, pitch, yaw] or {position_m, quaternion_wxyz}")]
enum PoseForm {
    Position([f64; 3]),
    Angles([f64; 6]),
    Quaternion { position_m: [f64; 3], quaternion_wxyz: [f64; 4] },
}

impl From<PoseForm> for Pose {
    fn from(form: PoseForm) -> Self {
        match form {
            PoseForm::Position([x, y, z]) => Self::Angles([x, y, z, 0.0, 0.0, 0.0]),
            PoseForm::Angles(numbers) => Self::Angles(numbers),
            PoseForm::Quaternion { position_m, quaternion_wxyz } => Self::Quaternion(position_m, quaternion_wxyz),
        }
    }
}

impl From<Pose> for PoseForm {
    fn from(pose: Pose) -> Self {
        match pose {
            Pose::Angles(numbers) => Self::Angles(numbers),
            Pose::Quaternion(position_m, quaternion_wxyz) => Self::Quaternion { position_m, quaternion_wxyz },
        }
    }
}

impl Pose {
    /// Converts the pose for the analyses.
    ///
    /// # Errors
    /// A number that is not finite, or a quaternion that is not of unit length.
    pub fn to_robot(self) -> Result<funicular::robot::Pose> {
        let checked = |values: &[f64]| values.iter().try_for_each(|value| check("pose", Some(*value), finite));
        match self {
            Self::Angles(numbers) => {
                checked(&numbers)?;
                let [x, y, z, roll, pitch, yaw] = numbers;
                Ok(funicular::robot::Pose::new([x, y, z], [roll, pitch, yaw]))
            }
            Self::Quaternion(position_m, wxyz) => {
                // A unit quaternion printed with seven digits stays below this error.
                const MAX_NORM_ERROR: f64 = 1e-6;

                checked(&position_m)?;
                checked(&wxyz)?;
                let [w, x, y, z] = wxyz;
                let quaternion = Quaternion::new(w, x, y, z);
                let norm = quaternion.norm();
                if (norm - 1.0).abs() > MAX_NORM_ERROR {
                    bail!("⟪pose⟫: `quaternion_wxyz` has the norm {norm}; give a unit quaternion, with norm 1");
                }
                // A quaternion of unit length to rounding is not normalised, so that a pose stays bit for bit the same
                // if it is written and read again.
                let is_unit = (norm - 1.0).abs() <= 4.0 * f64::EPSILON;
                let rot_wp =
                    if is_unit { Rotation::new_unchecked(quaternion) } else { Rotation::from_quaternion(quaternion) };
                Ok(funicular::robot::Pose { position_w: position_m.into(), rot_wp })
            }
        }
    }

    /// Roll, pitch, yaw as they are written [degrees]; zero for a quaternion.
    pub(crate) fn written_angles_deg(self) -> [f64; 3] {
        match self {
            Self::Angles([_, _, _, roll, pitch, yaw]) => [roll, pitch, yaw],
            Self::Quaternion(..) => [0.0; 3],
        }
    }
}

impl From<&funicular::robot::Pose> for Pose {
    fn from(pose: &funicular::robot::Pose) -> Self {
        Self::Quaternion(pose.position_w.into(), rotation::quaternion_wxyz(&pose.rot_wp))
    }
}

/// Numbers of a table by the names of its columns.
pub type NumberColumns = std::collections::BTreeMap<String, Vec<f64>>;

/// Columns of numbers with gaps.
pub type GappedColumns = std::collections::BTreeMap<String, Vec<Option<f64>>>;

declared! {
    /// State and loads of the robot. A value that is not given comes from the robot file.
    pub struct State {
        /// Unstrained lengths [m], one per cable in the order of the file; the pose follows from them.
        lengths_m: Option<Vec<f64>> = None =>
            (PerCable(Positive)).form("L1,L2,…").under("State").excludes(&["pose", "hold_lengths_of_pose"]);
        /// Pose x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll); the lengths follow from it.
        pose: Option<Pose> = None => (Pose).under("State");
        /// Hold the unstrained lengths with which the robot of the file rests at the pose (of the file or of ⟪pose⟫);
        /// all changes (⟪set⟫, ⟪mass_kg⟫, loads, wind, ⟪vary⟫) then act at these lengths and move the platform.
        hold_lengths_of_pose: bool = false => (Switch).under("State");
        /// Mass of the platform [kg]; inertia and centre of mass do not change.
        mass_kg: Option<f64> = None => (Number(Positive)).under("State");
        /// Static model of the cables.
        #[serde(with = "crate::names")]
        static_model: StaticModel = StaticModel::default() => (name::<StaticModel>()).form("MODEL").under("State");
        /// Loads besides weight.
        #[serde(flatten)]
        load: Load = Load::default() => group;
    }
}

declared! {
    /// Loads on platform and cables besides their weight, fixed in world axes; they replace the loads of the robot
    /// file.
    #[derive(Copy)]
    pub struct Load {
        /// Force on the platform, world axes [N].
        force_n: Option<[f64; 3]> = None => (Vector).under("Load");
        /// Moment on the platform, world axes [N m].
        moment_n_m: Option<[f64; 3]> = None => (Vector).under("Load");
        /// Point where the force acts, platform frame [m].
        load_point_m: Option<[f64; 3]> = None =>
            (Vector).under("Load").otherwise("from the robot file, or the origin");
        /// Velocity of the steady wind, world axes [m/s]; it acts on ropes with a `drag_coefficient` and platforms with
        /// a `drag_area_m2`.
        wind_m_s: Option<[f64; 3]> = None => (Vector).under("Load");
        /// Load per metre of every cable besides its weight, world axes [N/m].
        cable_load_n_per_m: Option<[f64; 3]> = None => (Vector).under("Load");
    }
}

declared! {
    /// Choice of the tensions at a pose, for a robot with more cables than degrees of freedom.
    pub struct Tensions {
        /// Rule that chooses the tensions at a pose if there are more cables than degrees of freedom.
        #[serde(with = "optional")]
        tension_rule: Option<TensionRuleName> = None =>
            (name::<TensionRuleName>()).form("RULE").under("Tensions").otherwise("lowest");
        /// Target tensions [N], one for all cables or one per cable in the order of the file; the rule is then closest.
        target_tension_n: Option<Vec<f64>> = None => (OneOrPerCable(NotNegative)).form("T|T1,T2,…").under("Tensions");
        /// Minimum tension anywhere in a cable [N].
        min_tension_n: Option<f64> = None =>
            (Number(NotNegative)).under("Tensions").otherwise("from the robot file, or 2.5 times the cable's weight");
        /// Maximum tension anywhere in a cable [N].
        max_tension_n: Option<f64> = None =>
            (Number(Positive)).under("Tensions").otherwise("from the robot file, or none");
    }
}

declared! {
    /// Linearisation of the robot.
    #[derive(Copy)]
    pub struct Model {
        /// Cable model: how cables respond to motion of the platform.
        #[serde(with = "optional")]
        cable_model: Option<CableModel> = None => (name::<CableModel>()).form("MODEL").under("Model")
            .otherwise("catenary-dynamic; shallow-dynamic for static models other than catenary");
        /// Terms of the stiffness.
        #[serde(flatten)]
        terms: Terms = Terms::default() => group;
    }
}

declared! {
    /// Terms of the stiffness.
    #[derive(Copy)]
    pub struct Terms {
        /// Terms of the stiffness.
        #[serde(with = "crate::names")]
        assembly: Assembly = Assembly::default() => (name::<Assembly>()).form("TERMS").under("Model");
        /// Leave out the out-of-plane stiffness of the cables, as in Yuan et al. 2014.
        in_plane_only: bool = false => (Switch).under("Model");
        /// Winches in vibration, for cables that run to a winch.
        #[serde(with = "crate::names")]
        winches: WinchMode = WinchMode::default() => (name::<WinchMode>()).form("MODE").under("Model");
    }
}

declared! {
    /// Points of the platform for the input and the output of a response.
    #[derive(Copy)]
    pub struct ResponsePoints {
        /// Point where the force acts, platform frame [m].
        input_point_m: Option<[f64; 3]> = None => (Vector).otherwise("the origin");
        /// Point whose motion is measured, platform frame [m].
        output_point_m: Option<[f64; 3]> = None => (Vector).otherwise("the origin");
    }
}

declared! {
    /// Range of frequencies, ends included.
    #[derive(Copy)]
    pub struct FrequencyRange {
        /// First frequency [Hz].
        from_hz: f64 = 0.0 => (Number(NotNegative)).required();
        /// Last frequency [Hz].
        to_hz: f64 = 0.0 => (Number(Positive)).required();
        /// Number of frequencies, 2 to 1000000.
        points: Option<usize> = None => (Count(2..=1_000_000)).required();
        /// Equal ratios between frequencies instead of equal steps.
        log: bool = false => (Switch);
    }
}

declared! {
    /// Range of frequencies of a response, ends included; a limit that is left out follows from the robot.
    #[derive(Copy)]
    pub struct ResponseRange {
        /// First frequency [Hz].
        from_hz: Option<f64> = None =>
            (Number(NotNegative)).otherwise("0; with equal ratios a thousandth of the last one");
        /// Last frequency [Hz].
        to_hz: Option<f64> = None => (Number(Positive))
            .otherwise("above the 20 lowest natural frequencies and the first mode of the platform");
        /// Number of frequencies, 2 to 1000000; with ⟪adaptive⟫ the number from which it starts.
        points: Option<usize> = None => (Count(2..=1_000_000)).otherwise("200, and others are added");
        /// Equal ratios between frequencies instead of equal steps.
        log: bool = false => (Switch);
    }
}

impl From<FrequencyRange> for ResponseRange {
    fn from(range: FrequencyRange) -> Self {
        let FrequencyRange { from_hz, to_hz, points, log } = range;
        Self { from_hz: Some(from_hz), to_hz: Some(to_hz), points, log }
    }
}

/// Name of one signal, or names of several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a signal is a text, and several signals are a list of texts")]
pub enum OneOrSeveral {
    /// One signal.
    One(String),
    /// Several signals, in the order of the results.
    Several(Vec<String>),
}

impl Default for OneOrSeveral {
    fn default() -> Self {
        Self::Several(Vec::new())
    }
}

impl OneOrSeveral {
    /// One signal for a list of one name, else several.
    pub fn of(mut names: Vec<String>) -> Self {
        if names.len() == 1 { Self::One(names.remove(0)) } else { Self::Several(names) }
    }

    /// True for one name that stands alone.
    pub fn is_one(&self) -> bool {
        matches!(self, Self::One(_))
    }

    /// Names in their order.
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names,
        }
    }
}

declared! {
    /// Poses at which a command works: a grid, or a list.
    pub struct Places {
        /// Axis of the grid: x, y, z [m], roll, pitch, yaw [degrees], with N values from A to B, or with listed values
        /// (repeatable); an axis that is not given keeps the value of the robot's state or of ⟪pose⟫.
        grid: Vec<Axis> = Vec::new() => (List(ProgramForm::GridAxis)).form("AXIS=A:B:N|V,V,…");
        /// List of poses instead of a grid: position [m] and roll, pitch, yaw [degrees].
        poses: Option<Vec<[f64; 6]>> = None => (Poses).excludes(&["grid", "pose", "lengths_m"])
            .read_by(Reader::Poses, "the poses");
    }
}

/// Axis of a grid: equal steps, or listed values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum Axis {
    /// Equal steps, ends included.
    Range {
        /// Name of the axis, or path into the robot file.
        axis: String,
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// Number of values.
        count: usize,
    },
    /// Listed values.
    List {
        /// Name of the axis, or path into the robot file.
        axis: String,
        /// Values along the axis.
        values: Vec<f64>,
    },
}

impl Axis {
    /// Axis with a name and values.
    pub fn new(axis: String, steps: &Steps) -> Self {
        match steps {
            Steps::Range { from, to, count } => Self::Range { axis, from: *from, to: *to, count: *count },
            Steps::List(values) => Self::List { axis, values: values.clone() },
        }
    }

    /// Name of the axis.
    pub fn name(&self) -> &str {
        match self {
            Self::Range { axis, .. } | Self::List { axis, .. } => axis,
        }
    }

    /// Values along the axis.
    ///
    /// # Errors
    /// A range that does not ascend, values that are not finite, or no values.
    pub fn steps(&self) -> Result<Steps, String> {
        match self {
            Self::Range { from, to, count, .. } => Steps::range(finite(*from)?, finite(*to)?, *count),
            Self::List { values, .. } if values.is_empty() => Err("it has no values".to_owned()),
            Self::List { values, .. } => {
                Ok(Steps::List(values.iter().map(|value| finite(*value)).collect::<Result<_, _>>()?))
            }
        }
    }
}

/// Default of the upper limit of the search for natural frequencies [Hz]: far above the first frequency of any cable
/// robot, and low enough that a search ends.
pub const MAX_HZ: f64 = 1000.0;

declared! {
    /// Rope values that files of other programs may lack. A value given here takes precedence over the files.
    #[derive(Copy)]
    pub struct ImportRopes {
        /// Mass of the ropes per unstrained length [kg/m]; 0 for massless ropes.
        mass_kg_per_m: Option<f64> = None => (Number(NotNegative)).under("Ropes");
        /// Axial stiffness EA of the ropes [N].
        axial_stiffness_n: Option<f64> = None =>
            (Number(Positive)).under("Ropes").excludes(&["youngs_modulus_pa", "diameter_m"]);
        /// Young's modulus of the full circular section of the ropes [Pa]; needs the diameter.
        youngs_modulus_pa: Option<f64> = None => (Number(Positive)).form("PA").under("Ropes");
        /// Diameter of the ropes [m].
        diameter_m: Option<f64> = None => (Number(Positive)).under("Ropes");
    }
}

declared! {
    /// Platform values that files of other programs may lack. A value given here takes precedence over the files.
    #[derive(Copy)]
    pub struct ImportPlatform {
        /// Mass of the platform [kg].
        mass_kg: Option<f64> = None => (Number(Positive)).under("Platform");
        /// Inertia tensor about the centre of mass, platform axes [kg m²]: xx, yy, zz, xy, xz, yz.
        inertia_kg_m2: Option<[f64; 6]> = None => (Tensor).under("Platform");
        /// Centre of mass in the platform frame [m].
        center_of_mass_m: Option<[f64; 3]> = None => (Vector).under("Platform");
        /// Pose of the state x,y,z[,roll,pitch,yaw] [m, degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
        pose: Option<Pose> = None => (Pose).under("Platform").otherwise("from the file");
    }
}

/// Checks a number if it is given; the message names its key.
///
/// # Errors
/// The reason of the rule, as those of [`values`](crate::values) give it.
pub fn check(key: &str, value: Option<f64>, rule: fn(f64) -> Result<f64, String>) -> Result<()> {
    value.map_or(Ok(()), |value| rule(value).map(drop).map_err(|reason| anyhow!("⟪{key}⟫: {reason}")))
}

/// Checks a vector if it is given; the message names its key.
pub(crate) fn check_vector(key: &str, vector: Option<[f64; 3]>) -> Result<()> {
    vector.iter().flatten().try_for_each(|value| check(key, Some(*value), finite))
}

/// Vector of a request that stands for one of the robot file.
pub(crate) struct FileVector {
    /// Key of the request.
    pub(crate) key: &'static str,
    /// Path in the robot file.
    pub(crate) path: &'static str,
    /// Value, if the request gives it.
    pub(crate) value: Option<[f64; 3]>,
    /// Place in a robot.
    pub(crate) of_robot: fn(&mut Robot) -> &mut Vec3,
    /// Place in a change of a robot.
    pub(crate) of_change: fn(&mut RobotChange) -> &mut Vec3,
}

impl Load {
    /// Vectors that stand for those of the robot file. The load of the cables stands for one of each cable.
    pub(crate) fn of_file(&self) -> [FileVector; 4] {
        let Self { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m: _ } = *self;
        [
            FileVector {
                key: "force_n",
                path: "loads.force_n",
                value: force_n,
                of_robot: |robot| &mut robot.load.force_w,
                of_change: |change| &mut change.force_w,
            },
            FileVector {
                key: "moment_n_m",
                path: "loads.moment_n_m",
                value: moment_n_m,
                of_robot: |robot| &mut robot.load.moment_w,
                of_change: |change| &mut change.moment_w,
            },
            FileVector {
                key: "load_point_m",
                path: "loads.point_m",
                value: load_point_m,
                of_robot: |robot| &mut robot.load.point_p,
                of_change: |change| &mut change.point_p,
            },
            FileVector {
                key: "wind_m_s",
                path: "wind.velocity_m_s",
                value: wind_m_s,
                of_robot: |robot| &mut robot.wind.velocity_w,
                of_change: |change| &mut change.wind_velocity_w,
            },
        ]
    }
}

impl State {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        for length in self.lengths_m.iter().flatten() {
            check("lengths_m", Some(*length), positive)?;
        }
        check("mass_kg", self.mass_kg, positive)?;
        self.load.of_file().iter().try_for_each(|vector| check_vector(vector.key, vector.value))?;
        check_vector("cable_load_n_per_m", self.load.cable_load_n_per_m)
    }
}

impl ResponsePoints {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        check_vector("input_point_m", self.input_point_m)?;
        check_vector("output_point_m", self.output_point_m)
    }
}

impl Tensions {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        for tension in self.target_tension_n.iter().flatten() {
            check("target_tension_n", Some(*tension), not_negative)?;
        }
        check("min_tension_n", self.min_tension_n, not_negative)?;
        check("max_tension_n", self.max_tension_n, positive)
    }
}

impl ImportRopes {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number out of its range, or an axial stiffness that is given twice.
    pub fn check(&self) -> Result<()> {
        check("mass_kg_per_m", self.mass_kg_per_m, not_negative)?;
        check("axial_stiffness_n", self.axial_stiffness_n, positive)?;
        check("youngs_modulus_pa", self.youngs_modulus_pa, positive)?;
        check("diameter_m", self.diameter_m, positive)?;
        if self.axial_stiffness_n.is_some() && (self.youngs_modulus_pa.is_some() || self.diameter_m.is_some()) {
            bail!(
                "⟪axial_stiffness_n⟫ is EA, which ⟪youngs_modulus_pa⟫ and ⟪diameter_m⟫ also determine: leave them out"
            );
        }
        Ok(())
    }
}

impl ImportPlatform {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A number out of its range.
    pub fn check(&self) -> Result<()> {
        check("mass_kg", self.mass_kg, positive)?;
        self.inertia_kg_m2.iter().flatten().try_for_each(|value| check("inertia_kg_m2", Some(*value), finite))?;
        check_vector("center_of_mass_m", self.center_of_mass_m)
    }
}
