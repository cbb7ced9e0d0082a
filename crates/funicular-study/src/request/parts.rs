//! Groups of keys that several commands share.

use super::steps::Steps;
use crate::names::{TensionRuleName, optional};
use crate::values::{finite, not_negative, positive};
use anyhow::{Result, anyhow, bail};
use funicular::cable::CableModel;
use funicular::dynamics::Assembly;
use funicular::math::{Quaternion, Rotation, rotation};
use funicular::robot::WinchMode;
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

/// State and loads of the robot. A value that is not given comes from the robot file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Unstrained lengths [m], one per cable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lengths_m: Option<Vec<f64>>,
    /// Pose of the platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// Hold the unstrained lengths with which the robot of the file, without any change, rests at the pose. Changes of
    /// mass, loads and other values then move the platform.
    #[serde(default)]
    pub hold_lengths_of_pose: bool,
    /// Mass of the platform [kg].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Static model of the cables.
    #[serde(default, with = "crate::names")]
    pub static_model: StaticModel,
    /// Loads besides weight.
    #[serde(flatten)]
    pub load: Load,
}

/// Loads on platform and cables besides their weight, fixed in world axes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Force on the platform [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_n: Option<[f64; 3]>,
    /// Moment on the platform [N m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment_n_m: Option<[f64; 3]>,
    /// Point where the force acts, platform frame [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_point_m: Option<[f64; 3]>,
    /// Velocity of the steady wind [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<[f64; 3]>,
    /// Load per metre of every cable besides its weight [N/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable_load_n_per_m: Option<[f64; 3]>,
}

/// Rule and limits of the tensions at a pose.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Tensions {
    /// Rule.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "optional")]
    pub tension_rule: Option<TensionRuleName>,
    /// Target tensions [N], one for all cables or one per cable in the order of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_tension_n: Option<Vec<f64>>,
    /// Minimum tension anywhere in a cable [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_tension_n: Option<f64>,
    /// Maximum tension anywhere in a cable [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_tension_n: Option<f64>,
}

/// Linearisation of the robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Cable model. The default depends on the static model.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "optional")]
    pub cable_model: Option<CableModel>,
    /// Terms of the stiffness.
    #[serde(flatten)]
    pub terms: Terms,
}

/// Terms of the stiffness.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// Terms to take: all, or only the end stiffness of the cables.
    #[serde(default, with = "crate::names")]
    pub assembly: Assembly,
    /// Leave out the out-of-plane stiffness of the cables.
    #[serde(default)]
    pub in_plane_only: bool,
    /// Winches in vibration.
    #[serde(default, with = "crate::names")]
    pub winches: WinchMode,
}

/// Points of the platform for the input and the output of a response, platform frame [m].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ResponsePoints {
    /// Point where the force acts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input_point_m: Option<[f64; 3]>,
    /// Point whose motion is measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_point_m: Option<[f64; 3]>,
}

/// Range of frequencies, ends included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrequencyRange {
    /// First frequency [Hz].
    pub from_hz: f64,
    /// Last frequency [Hz].
    pub to_hz: f64,
    /// Number of frequencies; may be left out only where frequencies are added adaptively.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<usize>,
    /// Equal ratios instead of equal steps.
    #[serde(default)]
    pub log: bool,
}

/// Range of frequencies of a response, ends included; a limit that is left out follows from the robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ResponseRange {
    /// First frequency [Hz]. Default: 0, or with equal ratios a fraction of the last one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_hz: Option<f64>,
    /// Last frequency [Hz]. Default: above the lowest natural frequencies and the first mode of the platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_hz: Option<f64>,
    /// Number of frequencies; without it frequencies are added adaptively.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<usize>,
    /// Equal ratios instead of equal steps.
    #[serde(default)]
    pub log: bool,
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

impl OneOrSeveral {
    /// One signal for a list of one name, else several.
    pub fn of(mut names: Vec<String>) -> Self {
        if names.len() == 1 { Self::One(names.remove(0)) } else { Self::Several(names) }
    }

    /// Names in their order.
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names,
        }
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

/// Quantities and options of every point of a map or sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EachPoint {
    /// Names of the quantities.
    #[serde(default = "EachPoint::default_quantities")]
    pub quantities: Vec<String>,
    /// Upper limit of the search for natural frequencies [Hz].
    #[serde(default = "default_up_to_hz")]
    pub up_to_hz: f64,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Centre of mass of the payload, platform frame [m]. Default: that of the platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_center_m: Option<[f64; 3]>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Linearisation.
    #[serde(flatten)]
    pub model: Model,
}

impl EachPoint {
    /// Quantities of a request that names none.
    pub fn default_quantities() -> Vec<String> {
        vec!["tension-min".to_owned(), "tension-max".to_owned()]
    }
}

fn default_up_to_hz() -> f64 {
    MAX_HZ
}

/// Rope values that files of other programs may lack. A value given here takes precedence over the files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ImportRopes {
    /// Mass per unstrained length [kg/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg_per_m: Option<f64>,
    /// Axial stiffness EA [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axial_stiffness_n: Option<f64>,
    /// Young's modulus of the full circular section [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub youngs_modulus_pa: Option<f64>,
    /// Diameter [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
}

/// Platform values that files of other programs may lack. A value given here takes precedence over the files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ImportPlatform {
    /// Mass [kg].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Inertia tensor about the centre of mass, platform axes [kg m²]: xx, yy, zz, xy, xz, yz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_kg_m2: Option<[f64; 6]>,
    /// Centre of mass in the platform frame [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_of_mass_m: Option<[f64; 3]>,
    /// Pose of the state.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
}

/// Checks a number if it is given; the message names its key.
pub(crate) fn check(key: &str, value: Option<f64>, rule: fn(f64) -> Result<f64, String>) -> Result<()> {
    value.map_or(Ok(()), |value| rule(value).map(drop).map_err(|reason| anyhow!("⟪{key}⟫: {reason}")))
}

/// Checks a vector if it is given; the message names its key.
pub(crate) fn check_vector(key: &str, vector: Option<[f64; 3]>) -> Result<()> {
    vector.iter().flatten().try_for_each(|value| check(key, Some(*value), finite))
}

impl State {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<()> {
        for length in self.lengths_m.iter().flatten() {
            check("lengths_m", Some(*length), positive)?;
        }
        check("mass_kg", self.mass_kg, positive)?;
        let Load { force_n, moment_n_m, load_point_m, wind_m_s, cable_load_n_per_m } = self.load;
        check_vector("force_n", force_n)?;
        check_vector("moment_n_m", moment_n_m)?;
        check_vector("load_point_m", load_point_m)?;
        check_vector("wind_m_s", wind_m_s)?;
        check_vector("cable_load_n_per_m", cable_load_n_per_m)
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
    pub(crate) fn check(&self) -> Result<()> {
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
    pub(crate) fn check(&self) -> Result<()> {
        check("mass_kg", self.mass_kg, positive)?;
        self.inertia_kg_m2.iter().flatten().try_for_each(|value| check("inertia_kg_m2", Some(*value), finite))?;
        check_vector("center_of_mass_m", self.center_of_mass_m)
    }
}

/// Default of the minimum fraction of the kinetic energy in the platform for a mode of the platform.
pub(crate) fn platform_share() -> f64 {
    funicular::modes::PLATFORM_SHARE
}
