//! Rows that several commands share.

use crate::at_rest::AtRest;
use crate::columns::Style;
use crate::rows::{ReadBack, rows};
use crate::text::{short, vector};
use funicular::cable::{LocalAxes, Sag};
use funicular::dynamics::Linearisation;
use funicular::math::{Vec6, rotation};
use funicular::modes;
use funicular::pose_error::PoseDifference;
use funicular::robot::{Load, Pose, WinchMode, Wind};
use funicular::statics::{Limit, TensionMargin, TensionRange, TensionRule};

/// Names of the components of a vector.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Names of the angles of a pose.
pub(crate) const ANGLES: [&str; 3] = ["roll", "pitch", "yaw"];

rows! {
    /// Models used for a result, by the names that JSON has.
    #[derive(Debug, Clone, Copy)]
    pub struct Models {
        pub static_model: &'static str;
        pub cable_model: &'static str;
        pub assembly: &'static str;
        pub in_plane_only: bool;
        /// Winches in vibration; absent if they are as in the robot file.
        pub winches: Option<&'static str>;
        pub origin: Origin = spread;
    }
}

rows! {
    /// Origin of the tensions of an equilibrium.
    #[derive(Debug, Clone, Copy)]
    pub struct Origin {
        /// Rule that chose the tensions; absent if there was no choice.
        pub tension_rule: Option<&'static str>;
        /// True if the unstrained lengths of a pose are held; absent otherwise.
        pub lengths_held: bool = sparse;
    }
}

impl Origin {
    pub fn of(at_rest: &AtRest) -> Self {
        let tension_rule = at_rest.rule.as_ref().map(TensionRule::name);
        Self { tension_rule, lengths_held: at_rest.held_pose.is_some() }
    }

    /// Description that continues a line; empty if the tensions follow from the state alone.
    pub fn phrase(&self) -> String {
        let rule = self.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        format!("{rule}{}", if self.lengths_held { ", lengths of the pose held" } else { "" })
    }
}

impl Models {
    pub fn of(at_rest: &AtRest, linearisation: Linearisation) -> Self {
        Self {
            origin: Origin::of(at_rest),
            static_model: at_rest.equilibrium.model.name(),
            cable_model: linearisation.cable_model.name(),
            assembly: linearisation.assembly.name(),
            in_plane_only: linearisation.in_plane_only,
            winches: Some(linearisation.winches).filter(|mode| *mode != WinchMode::AsGiven).map(WinchMode::name),
        }
    }

    /// Description in one line.
    pub fn line(&self) -> String {
        let plane = if self.in_plane_only { ", in plane only" } else { "" };
        let winches = self.winches.map_or_else(String::new, |mode| format!(", winches {mode}"));
        let origin = self.origin.phrase();
        format!(
            "{} statics, {} cables, {} assembly{plane}{winches}{origin}",
            self.static_model, self.cable_model, self.assembly
        )
    }
}

rows! {
    /// Numbers of a cable's sag for JSON. They are absent for a cable without tension. The string frequency is also
    /// absent for a cable without mass.
    #[derive(Debug, Clone, Copy)]
    pub struct SagNumbers {
        pub sag_ratio: Option<f64>;
        pub lambda2: Option<f64>;
        pub string_frequency_hz: Option<f64>;
    }
}

impl SagNumbers {
    pub fn of(sag: &Sag) -> Self {
        let taut = sag.tension > 0.0;
        Self {
            sag_ratio: taut.then(|| sag.ratio()),
            lambda2: taut.then_some(sag.lambda2),
            string_frequency_hz: taut.then(|| sag.string_frequency_hz()).filter(|f| f.is_finite()),
        }
    }
}

rows! {
    /// Pose of the platform.
    pub struct PoseRow in tables(decimals: [usize; 2]) {
        /// Position of the platform origin, {}.
        pub position_m: [f64; 3] => each(AXES, "{}_m").decimals("position", decimals[0]);
        /// Orientation as a quaternion w, x, y, z.
        pub quaternion_wxyz: [f64; 4];
        /// Roll, pitch, yaw of the platform.
        pub roll_pitch_yaw_deg: [f64; 3] => each(ANGLES, "{}_deg", "{} of the platform")
            .decimals("roll, pitch, yaw", decimals[1]);
    }
}

impl PoseRow {
    pub fn of(pose: &Pose) -> Self {
        Self {
            position_m: pose.position_w.into(),
            quaternion_wxyz: rotation::quaternion_wxyz(&pose.rot_wp),
            roll_pitch_yaw_deg: rotation::to_roll_pitch_yaw_deg(&pose.rot_wp),
        }
    }

    /// Takes a pose from the numbers of its columns.
    pub(crate) fn read(numbers: &mut &[f64], _: [usize; 2]) -> Option<Self> {
        let (position_m, roll_pitch_yaw_deg) = (<[f64; 3]>::take(3, numbers)?, <[f64; 3]>::take(3, numbers)?);
        let [roll, pitch, yaw] = roll_pitch_yaw_deg;
        let rot_wp = rotation::from_roll_pitch_yaw_deg(roll, pitch, yaw);
        Some(Self { position_m, quaternion_wxyz: rotation::quaternion_wxyz(&rot_wp), roll_pitch_yaw_deg })
    }
}

rows! {
    /// Platform in motion.
    pub struct MotionRow in tables(decimals: [usize; 2]) read back {
        /// Pose.
        pub pose: PoseRow = spread => columns(decimals);
        /// Velocity of the platform origin, {}.
        pub velocity_m_s: [f64; 3] => each(AXES);
        /// Angular velocity of the platform, {}.
        pub angular_velocity_rad_s: [f64; 3] => each(AXES);
        /// Acceleration of the platform origin, {}.
        pub acceleration_m_s2: [f64; 3] => each(AXES);
        /// Angular acceleration of the platform, {}.
        pub angular_acceleration_rad_s2: [f64; 3] => each(AXES);
    }
}

impl MotionRow {
    /// Row of a pose with a velocity and an acceleration, world axes.
    pub fn of(pose: &Pose, velocity_w: &Vec6, acceleration_w: &Vec6) -> Self {
        let halves = |of: &Vec6| [[of[0], of[1], of[2]], [of[3], of[4], of[5]]];
        let [velocity_m_s, angular_velocity_rad_s] = halves(velocity_w);
        let [acceleration_m_s2, angular_acceleration_rad_s2] = halves(acceleration_w);
        let pose = PoseRow::of(pose);
        Self { pose, velocity_m_s, angular_velocity_rad_s, acceleration_m_s2, angular_acceleration_rad_s2 }
    }
}

rows! {
    /// Translation and rotation between two poses.
    #[derive(Clone, Copy)]
    pub struct PoseDifferenceRow {
        pub translation_m: [f64; 3];
        pub distance_m: f64;
        pub angle_deg: f64;
    }
}

impl From<PoseDifference> for PoseDifferenceRow {
    fn from(difference: PoseDifference) -> Self {
        Self {
            translation_m: difference.translation,
            distance_m: difference.distance,
            angle_deg: difference.angle.to_degrees(),
        }
    }
}

rows! {
    /// Load on the platform.
    pub struct LoadRow {
        pub force_n: [f64; 3];
        pub moment_n_m: [f64; 3];
        pub point_m: [f64; 3];
    }
}

impl LoadRow {
    /// Row for a load; `None` if there is no load.
    pub fn of(load: &Load) -> Option<Self> {
        (load.force_w.norm() > 0.0 || load.moment_w.norm() > 0.0).then(|| Self::of_any(load))
    }

    /// Row for a load that may be zero.
    pub(super) fn of_any(load: &Load) -> Self {
        Self { force_n: load.force_w.into(), moment_n_m: load.moment_w.into(), point_m: load.point_p.into() }
    }

    /// Description in one phrase.
    pub fn text(&self) -> String {
        let [force, moment, point] = [&self.force_n, &self.moment_n_m, &self.point_m].map(|three| vector(three, 4));
        format!("force ({force}) N at ({point}) m of the platform, moment ({moment}) N m")
    }
}

rows! {
    /// Wind.
    pub struct WindRow {
        pub velocity_m_s: [f64; 3];
        pub air_density_kg_m3: f64;
    }
}

impl WindRow {
    /// Row for a wind; `None` in still air.
    pub fn of(wind: &Wind) -> Option<Self> {
        (wind.velocity_w.norm() > 0.0)
            .then(|| Self { velocity_m_s: wind.velocity_w.into(), air_density_kg_m3: wind.air_density })
    }

    /// Description in one phrase.
    pub fn text(&self) -> String {
        format!("({}) m/s, air density {} kg/m³", vector(&self.velocity_m_s, 3), short(self.air_density_kg_m3, 4))
    }
}

rows! {
    /// Tension limits of a cable, and the distance of its tension from them.
    pub struct LimitNumbers {
        pub minimum_tension_n: f64;
        pub maximum_tension_n: Option<f64>;
        /// Distance from the nearer limit.
        pub tension_margin_n: f64;
        /// Distance from the nearer limit, divided by the distance between the limits.
        pub tension_margin: Option<f64>;
        pub limit_reached: Option<&'static str>;
    }
}

impl LimitNumbers {
    /// Minimum and maximum of the tension as a text.
    pub fn range(&self, style: Style) -> String {
        let maximum = self.maximum_tension_n.map_or_else(|| "∞".to_owned(), |maximum| style.short(maximum, 4));
        format!("{} to {maximum}", style.short(self.minimum_tension_n, 4))
    }

    /// Distance from the nearer limit as a text; its name if the tension is there.
    pub fn margin(&self, style: Style) -> String {
        match self.limit_reached {
            Some(limit) if self.tension_margin_n.abs() <= 1e-6 * self.minimum_tension_n.max(1.0) => limit.to_owned(),
            _ => style.decimals(self.tension_margin_n, 1),
        }
    }

    pub fn of(margin: &TensionMargin) -> Self {
        let TensionRange { minimum, maximum } = margin.range;
        Self {
            minimum_tension_n: minimum,
            maximum_tension_n: maximum.is_finite().then_some(maximum),
            tension_margin_n: margin.distance(),
            tension_margin: margin.relative(),
            limit_reached: margin.reached().map(Limit::name),
        }
    }
}

rows! {
    /// Unit vectors of a cable, world axes: along the chord, normal to it in plane, out of plane.
    pub struct Axes {
        /// Along the chord.
        pub e: [f64; 3];
        /// Normal to the chord, in plane and up.
        pub n: [f64; 3];
        /// Out of plane.
        pub b: [f64; 3];
    }
}

impl Axes {
    pub fn of(axes: &LocalAxes) -> Self {
        Self { e: axes.e.into(), n: axes.n.into(), b: axes.b.into() }
    }
}

rows! {
    /// Mode of vibration.
    pub struct ModeRow {
        pub frequency_hz: f64;
        pub multiplicity: usize;
        pub damping_ratio: f64;
        /// Time in which its amplitude falls to the requested percentage; absent for a mode that does not decay.
        pub decay_time_s: Option<f64>;
        /// Eigenvalue λ = −ζω + iω√(1 − ζ²): real and imaginary part.
        pub eigenvalue_per_s: Option<[f64; 2]>;
        pub kind: &'static str;
        pub platform_energy_fraction: f64;
        pub cable_energy_fractions: Vec<f64>;
        /// Kinetic energy of the drive of each cable; absent if no drive has inertia.
        pub drive_energy_fractions: Vec<f64> = sparse;
        /// Kinetic energy of each flexible support; absent on a rigid frame.
        pub support_energy_fractions: Vec<f64> = sparse;
        /// Share of the stretch of each cable in the energy of deformation; absent in the closed form of
        /// shallow-dynamic cables and for rigid ones.
        pub stretching_share: Vec<f64> = sparse;
        pub shape: [f64; 6];
        pub modal_mass_kg: f64;
        pub residual: f64;
        pub residue_per_kg: Option<f64>;
        /// Height of the peak of this mode alone.
        pub peak: Option<f64>;
        /// Displacements (e, n, b) of the stations of every cable, in the scale of `shape`.
        pub cable_shapes: Vec<Vec<[f64; 3]>> = sparse;
    }
}

impl From<modes::Mode> for ModeRow {
    fn from(mode: modes::Mode) -> Self {
        Self {
            frequency_hz: mode.frequency_hz,
            multiplicity: mode.multiplicity,
            damping_ratio: mode.damping_ratio,
            decay_time_s: None,
            eigenvalue_per_s: None,
            kind: mode.kind.name(),
            platform_energy_fraction: mode.platform_energy_fraction,
            cable_energy_fractions: mode.cable_energy_fractions,
            drive_energy_fractions: mode.drive_energy_fractions,
            support_energy_fractions: mode.support_energy_fractions,
            stretching_share: mode.stretching_shares,
            // `+ 0.0` makes a negative zero positive.
            shape: mode.shape.map(|x| x + 0.0),
            modal_mass_kg: mode.modal_mass,
            residual: mode.residual,
            residue_per_kg: None,
            peak: None,
            cable_shapes: Vec::new(),
        }
    }
}
