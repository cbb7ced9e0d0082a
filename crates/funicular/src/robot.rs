//! The robot as plain data: platform, cables, ropes and gravity. A robot that was read from a file is valid, and no
//! analysis changes it. Code that writes a public field keeps it within the range of the field's key.
//!
//! Frames: `w` world, `p` platform. `exit_w` is a point in world coordinates, `attachment_p` a point in platform
//! coordinates, and `rot_wp` turns platform coordinates into world coordinates: neighbouring letters cancel.

mod anchor;
mod body;
mod change;
mod constraint;
mod friction;
mod mesh;
mod motion;
pub mod parameters;
mod pulley;
mod required;
mod rope_over_sheaves;
pub mod spec;
mod support;
mod turbulence;
mod winch;
mod wind;

pub use anchor::Anchor;
pub use body::{Body, RequiredClearance, Solid};
pub use change::{CableChange, GuideWheelChange, PulleyChange, RobotChange, SupportChange, WinchChange};
pub use constraint::Constraint;
pub use friction::PulleyFriction;
pub use mesh::{ClosedMesh, MeshError};
pub(crate) use mesh::{from_vector, vector};
pub use motion::{OutOfPlane, Plane, PlatformMotion};
pub(crate) use pulley::Wheel;
pub use pulley::{Pulley, PulleyContact};
pub(crate) use required::stacked;
pub use required::{LoadShape, RequiredLoads, RequiredLoadsError, RequiredPayload, TwistSet};
pub use rope_over_sheaves::RopeOverSheaves;
pub use support::{DrumPlace, Support};
pub use turbulence::{MeasuredSpectrum, MeasuredSpectrumError, Turbulence, TurbulenceSpectrum};
pub use winch::{Control, DrumSide, GuideWheel, LimitOfWinch, MotorLoad, Servo, Winch, WinchLimits, WinchMode};
pub use wind::{LineLoad, Wind};

use crate::math::{Mat3, Rotation, Vec3, rotation};
use thiserror::Error;

/// A cable-driven parallel robot, as read from a robot file. SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Name of the robot.
    pub name: String,
    /// Source of the numbers.
    pub source: String,
    /// Acceleration of gravity in world axes [m/s²]; any direction, zero without gravity.
    pub gravity_w: Vec3,
    /// The moving platform.
    pub platform: Platform,
    /// Load on the platform besides its weight and the wind.
    pub load: Load,
    /// Loads that the robot has to bear in addition to all of these.
    pub required: RequiredLoads,
    /// Steady wind on cables and platform.
    pub wind: Wind,
    /// Turbulence about that wind; `None` if the file gives none.
    pub turbulence: Option<Turbulence>,
    /// Flexible supports of anchors, by name.
    pub supports: Vec<Support>,
    /// Bodies that stand in the world.
    pub obstacles: Vec<Body>,
    /// Distances that have to be kept free; `None` if the file gives none.
    pub clearance: Option<RequiredClearance>,
    /// The cables, in file order.
    pub cables: Vec<Cable>,
    /// Ropes that run over sheaves and are several cables each.
    pub ropes: Vec<RopeOverSheaves>,
    /// State given by the file: unstrained lengths or a pose.
    pub state: State,
    /// Roll, pitch, yaw that the pose of `state` was written with [degrees]; zero if it was written in another way.
    /// A rotation does not keep full turns; these angles do, for [`crate::warnings::plausibility`] alone.
    pub written_angles_deg: [f64; 3],
}

/// The moving platform.
#[derive(Debug, Clone, PartialEq)]
pub struct Platform {
    /// Mass [kg], positive.
    pub mass: f64,
    /// Inertia tensor about the centre of mass, platform axes [kg m²]; zero for a point mass. For a planar platform
    /// only the moment about the normal counts.
    pub inertia_p: Mat3,
    /// Drag coefficient times area [m²]; the wind acts at the centre of mass.
    pub drag_area: f64,
    /// Centre of mass in the platform frame [m].
    pub center_of_mass_p: Vec3,
    /// Bodies that move with the platform, in its frame; without any, the convex hull of the attachments is its body.
    pub bodies: Vec<Body>,
    /// Motions that the platform can make.
    pub motion: PlatformMotion,
    /// Viscous damping of its translation along the platform's axes, at the platform origin [N s/m].
    pub translational_damping_p: Vec3,
    /// Viscous damping of its rotation about the platform's axes [N m s].
    pub rotational_damping_p: Vec3,
}

/// Dead load on the platform: it keeps its direction in the world however the platform moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Force, world axes [N].
    pub force_w: Vec3,
    /// Moment, world axes [N m].
    pub moment_w: Vec3,
    /// Point at which the force acts, platform frame [m].
    pub point_p: Vec3,
}

/// Load that has no meaning on a platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum LoadError {
    /// Moment on a point mass.
    #[error("a point mass does not turn: leave out the moment of the load")]
    MomentOnPointMass,
    /// Point of action on a point mass.
    #[error("a point mass has no points but its origin: leave out the point of the load")]
    PointOfPointMass,
}

impl Load {
    /// Refuses load components that have no meaning for a platform with this motion.
    ///
    /// # Errors
    /// [`LoadError`].
    pub fn check(&self, motion: &PlatformMotion) -> Result<(), LoadError> {
        match motion {
            PlatformMotion::PointMass if self.moment_w.norm() > 0.0 => Err(LoadError::MomentOnPointMass),
            PlatformMotion::PointMass if self.point_p.norm() > 0.0 => Err(LoadError::PointOfPointMass),
            _ => Ok(()),
        }
    }
}

/// Material damping of a rope; it enters only the frequency of the cable (theory, section 4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Constant ratio ξ: `ω_c² = ω²(1 − 2iξ)`.
    Ratio(f64),
    /// Viscous coefficient c per length [N s/m²]: `ω_c² = ω² − iωc/m`.
    Viscous(f64),
}

/// Loss of the stretch of a rope: in vibration its axial stiffness is `EA h(ω)`, `h = 1 + iη + iωτ` for ω > 0 (theory,
/// section 4).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StretchLoss {
    /// Loss factor η of the axial stiffness, the same at every frequency.
    pub factor: f64,
    /// Damping time τ of a viscous loss in parallel with the stiffness (Kelvin and Voigt) [s].
    pub time: f64,
}

/// A rope.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the robot file.
    pub name: String,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
    /// Axial stiffness in vibration [N] if it differs; see
    /// [`Equilibrium::with_dynamic_stiffness`](crate::statics::Equilibrium::with_dynamic_stiffness).
    pub dynamic_axial_stiffness: Option<f64>,
    /// Mass per unstrained length [kg/m]; zero for a massless cable.
    pub mass_per_length: f64,
    /// Damping of the motion of the rope.
    pub damping: Damping,
    /// Loss of its stretch.
    pub stretch_loss: StretchLoss,
    /// Tension limits of every cable made of this rope.
    pub tension_limits: TensionLimits,
    /// Tension at which the rope breaks [N].
    pub breaking_load: Option<f64>,
    /// Drag coefficient times diameter [m]; `None` if the file gives no drag.
    pub drag_width: Option<f64>,
    /// Dead load per unstrained length besides its weight, world axes [N/m].
    pub load_per_length_w: Vec3,
    /// Dimensions that the file gives. No analysis uses them: they only show whether the other values are plausible.
    pub dimensions: RopeDimensions,
}

/// Dimensions of a rope as its file gives them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RopeDimensions {
    /// Cross-section that was multiplied by Young's modulus; `None` if the file gives the axial stiffness itself.
    pub section: Option<RopeSection>,
    /// Diameter for the drag of the wind [m]; `None` if the file gives no drag.
    pub drag_diameter: Option<f64>,
}

/// Cross-section of a rope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RopeSection {
    /// Full circle with this diameter [m].
    Diameter(f64),
    /// Area [m²], for wire rope mostly that of the metal.
    Area(f64),
}

impl RopeSection {
    /// Area [m²].
    pub fn area(&self) -> f64 {
        match self {
            Self::Diameter(diameter) => 0.25 * std::f64::consts::PI * diameter * diameter,
            Self::Area(area) => *area,
        }
    }
}

/// Tension limits of a cable [N]; `None` if the file gives none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TensionLimits {
    /// Minimum tension anywhere in the cable.
    pub minimum: Option<f64>,
    /// Maximum tension anywhere in the cable.
    pub maximum: Option<f64>,
}

impl TensionLimits {
    /// Limits with those of `other` where these have none.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { minimum: self.minimum.or(other.minimum), maximum: self.maximum.or(other.maximum) }
    }
}

/// Cable, from the platform to its anchor.
#[derive(Debug, Clone, PartialEq)]
pub struct Cable {
    /// Name in the robot file; unique.
    pub name: String,
    /// Rope of the cable.
    pub material: Material,
    /// End of the cable that is not on the platform.
    pub anchor: Anchor,
    /// Attachment point in the platform frame [m].
    pub attachment_p: Vec3,
    /// Tension limits of the cable; they take precedence over those of its rope.
    pub tension_limits: TensionLimits,
    /// Dead load per unstrained length besides weight and wind, from the cable or else from its rope, world axes [N/m].
    pub load_per_length_w: Vec3,
}

impl Cable {
    /// Chord of the free span at a pose, attachment to exit point, world axes [m].
    #[inline]
    pub fn chord_w(&self, pose: &Pose) -> Vec3 {
        let attachment_w = pose.point_w(&self.attachment_p);
        self.anchor.exit_w(&attachment_w) - attachment_w
    }

    /// Unstrained length of the cable at a pose if it is straight and carries no tension [m]: the chord plus the length
    /// beyond the exit point.
    #[inline]
    pub fn straight_length(&self, pose: &Pose) -> f64 {
        self.chord_w(pose).norm() + self.anchor.length_beyond(&pose.point_w(&self.attachment_p))
    }

    /// Radius of the rope [m]: half of the diameter for its drag, or that of its cross-section; zero if the file gives
    /// neither.
    pub fn radius(&self) -> f64 {
        let RopeDimensions { section, drag_diameter } = self.material.dimensions;
        let of_section = || section.map(|section| (section.area() / std::f64::consts::PI).sqrt());
        drag_diameter.map(|diameter| 0.5 * diameter).or_else(of_section).unwrap_or(0.0)
    }

    /// Tension limits: those of the cable, else those of its rope; the breaking load is the maximum if no other is
    /// given.
    pub fn limits(&self) -> TensionLimits {
        let breaking = TensionLimits { minimum: None, maximum: self.material.breaking_load };
        self.tension_limits.or(self.material.tension_limits).or(breaking)
    }
}

/// State given before an analysis.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// Unstrained lengths, one per cable in file order [m]: forward statics gives the pose.
    Lengths(Vec<f64>),
    /// Pose: inverse statics gives the lengths.
    Pose(Pose),
    /// The file gives no state; the command has to give one.
    Unknown,
}

/// Position and orientation of the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Origin of the platform frame in the world frame [m].
    pub position_w: Vec3,
    /// Rotation from platform to world axes.
    pub rot_wp: Rotation,
}

impl Pose {
    /// Pose from position [m] and roll, pitch, yaw [degrees], `R = Rz(yaw) Ry(pitch) Rx(roll)`.
    pub fn new(position_w: [f64; 3], roll_pitch_yaw_deg: [f64; 3]) -> Self {
        let [roll, pitch, yaw] = roll_pitch_yaw_deg;
        Self { position_w: Vec3::from(position_w), rot_wp: rotation::from_roll_pitch_yaw_deg(roll, pitch, yaw) }
    }

    /// Pose of a body along the line between two points: its origin halfway, its z axis from the first to the second,
    /// its x axis across z of the frame of the points, or along x if the line is along z.
    pub fn between(from: &Vec3, to: &Vec3) -> Self {
        /// Sine of the angle to z below which a line counts as parallel to it.
        const PARALLEL: f64 = 1e-9;
        let along = (to - from).normalize();
        let level = Vec3::z().cross(&along);
        let x = if level.norm() > PARALLEL { level.normalize() } else { Vec3::x() };
        let across = along.cross(&x).normalize();
        let axes = Mat3::from_columns(&[across.cross(&along), across, along]);
        Self { position_w: (from + to) * 0.5, rot_wp: rotation::from_axes(&axes) }
    }

    /// The pose after a small motion: translation [m] and rotation vector [rad], world axes.
    #[must_use]
    pub fn moved(&self, translation_w: &Vec3, turn_w: &Vec3) -> Self {
        Self { position_w: self.position_w + translation_w, rot_wp: rotation::turned(&self.rot_wp, turn_w) }
    }

    /// Point of the platform in world coordinates [m].
    pub fn point_w(&self, point_p: &Vec3) -> Vec3 {
        self.position_w + self.rot_wp * point_p
    }
}

impl Robot {
    /// True if a rope is stiffer in vibration than under a slow load.
    pub fn has_dynamic_stiffness(&self) -> bool {
        self.cables.iter().any(|cable| cable.material.dynamic_axial_stiffness.is_some())
    }

    /// True if the stretch of a rope has a loss.
    pub(crate) fn has_stretch_loss(&self) -> bool {
        self.cables.iter().any(|cable| cable.material.stretch_loss.is_some())
    }

    /// True if poses of the robot are judged by distances: its file has obstacles, bodies of the platform or
    /// `[clearance]`.
    pub fn judges_clearance(&self) -> bool {
        self.clearance.is_some() || !self.obstacles.is_empty() || !self.platform.bodies.is_empty()
    }

    /// Length at the end of a cable that is not compared with what this end is mounted on [m]
    /// ([`RequiredClearance::from_end`]).
    pub(crate) fn clearance_from_end(&self) -> f64 {
        let given = self.clearance.and_then(|clearance| clearance.from_end);
        given.unwrap_or_else(|| RequiredClearance::FROM_END * self.platform_length())
    }

    /// True if a number of the robot damps vibration: a rope that has mass, the platform, a winch or a support. Without
    /// any, all damping ratios are zero, and responses have no bound at resonances.
    pub fn is_damped(&self) -> bool {
        let of_rope = |rope: &Material| {
            let (Damping::Ratio(number) | Damping::Viscous(number)) = rope.damping;
            (number > 0.0 && rope.mass_per_length > 0.0) || rope.stretch_loss.is_some()
        };
        let of_winch = |winch: &Winch| winch.damping > 0.0 || winch.servo().is_some_and(|servo| servo.speed_gain > 0.0);
        let of_cable = |cable: &Cable| of_rope(&cable.material) || cable.anchor.winch.as_ref().is_some_and(of_winch);
        let platform = [self.platform.translational_damping_p, self.platform.rotational_damping_p];

        self.cables.iter().any(of_cable)
            || platform.iter().any(|damping| damping.norm() > 0.0)
            || self.supports.iter().any(|support| support.damping_ratio > 0.0)
    }

    /// Unit vector against gravity; z without gravity.
    pub fn up_w(&self) -> Vec3 {
        let g = self.gravity_w.norm();
        if g > 0.0 { -self.gravity_w / g } else { Vec3::z() }
    }

    /// Length ℓ that makes rotations comparable with translations [m]: the mean distance of the attachments from the
    /// platform origin; 1 for a point mass.
    ///
    /// Every norm, pivot count and tolerance on 6×6 matrices refers to `S K S`, `S = diag(1,1,1,1/ℓ,1/ℓ,1/ℓ)`.
    pub fn platform_length(&self) -> f64 {
        let n = self.cables.len() as f64;
        let mean = self.cables.iter().map(|c| c.attachment_p.norm()).sum::<f64>() / n;
        if mean > 0.0 { mean } else { 1.0 }
    }

    /// Copy of the robot with tension limits for every cable, which take precedence over those of its file.
    #[must_use]
    pub fn with_tension_limits(&self, limits: TensionLimits) -> Self {
        let mut robot = self.clone();
        for cable in &mut robot.cables {
            cable.tension_limits = limits.or(cable.tension_limits);
        }
        robot
    }

    /// Copy of the robot with another load on its platform.
    #[must_use]
    pub fn with_load(&self, load: Load) -> Self {
        let mut robot = self.clone();
        robot.load = load;
        robot
    }

    /// Copy of the robot in another wind.
    #[must_use]
    pub fn with_wind(&self, wind: Wind) -> Self {
        let mut robot = self.clone();
        robot.wind = wind;
        robot
    }

    /// Copy of the robot with a dead load per unstrained length on every cable, world axes [N/m], which replaces the
    /// load of its file.
    #[must_use]
    pub fn with_cable_load(&self, load_per_length_w: Vec3) -> Self {
        let mut robot = self.clone();
        for cable in &mut robot.cables {
            cable.load_per_length_w = load_per_length_w;
        }
        robot
    }

    /// Copy of the robot with another platform mass [kg]; inertia tensor and centre of mass stay.
    #[must_use]
    pub fn with_mass(&self, mass: f64) -> Self {
        let mut robot = self.clone();
        robot.platform.mass = mass;
        robot
    }
}
