//! Statement that is proved: cables with their limits, loads, and the turns of the platform.

use super::{PositionBox, sag::SagOfCable};
use crate::math::{Vec3, Vec6};
use crate::platform::{Coordinates, load_wrench};
use crate::robot::{LoadShape, PlatformMotion, Pose, Robot};
use crate::statics::{MinimumTension, StaticModel, TensionRange, required_vertices};
use thiserror::Error;

/// Largest turn about an axis [rad]: beyond it the second order is more than a tenth of the first.
const MAX_TURN: f64 = 0.2;

/// Statement about a robot: at a position, with every turn within the limits, tensions within their limits hold every
/// required load.
#[derive(Debug, Clone)]
pub struct ProofStatement {
    pub(super) coordinates: Coordinates,
    pub(super) cables: Vec<CableOfStatement>,
    /// Dead load together with each of the required loads that all others are combinations of, reduced [N].
    pub(super) loads: Vec<Vec6>,
    /// Forces of the dead load at points that turn with the platform: force, and lever arm in world axes.
    pub(super) turning: Vec<[Vec3; 2]>,
    /// Largest turn about each world axis from the orientation [rad].
    pub(super) turns: Vec3,
    /// Direction against gravity.
    pub(super) up_w: Vec3,
    /// Axes along which the platform can be moved.
    pub(super) can_move: [bool; 3],
}

/// Cable of a statement.
#[derive(Debug, Clone)]
pub(super) struct CableOfStatement {
    pub(super) name: String,
    pub(super) anchor_w: Vec3,
    /// Attachment from the platform origin, world axes [m].
    pub(super) arm_w: Vec3,
    pub(super) least: LeastTension,
    /// Maximum tension [N]; infinite without one.
    pub(super) greatest: f64,
    /// Weight and stiffness of a cable that sags.
    pub(super) sag: Option<SagOfCable>,
}

/// Minimum tension of a cable: the larger of two numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeastTension {
    /// Tension [N].
    fixed: f64,
    /// Tension over the length of the chord [N/m].
    per_length: f64,
}

impl LeastTension {
    /// Minimum tension with a chord of this length.
    pub(super) fn at(self, length: f64) -> f64 {
        self.fixed.max(self.per_length * length)
    }

    /// Tension [N], and tension over length [N/m].
    pub(super) fn numbers(self) -> [f64; 2] {
        [self.fixed, self.per_length]
    }
}

/// Statement that is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProofRefusal {
    /// Too few cables.
    #[error(
        "a proof needs as many cables as degrees of freedom: with fewer the cables do not hold every orientation; use \
         `funicular map`"
    )]
    FewCables,
    /// Cable over a pulley.
    #[error(
        "cable \"{0}\" runs over a pulley, for which no bound over a box is derived: leave out its pulley in a copy of \
         the robot file"
    )]
    Pulley(String),
    /// Flexible support.
    #[error(
        "the robot has flexible supports, for which no bound over a box is derived: leave them out in a copy of it"
    )]
    Supports,
    /// Load on a sagging cable besides its weight.
    #[error(
        "wind or a load on cable \"{0}\" besides its weight has no bound over a box: leave it out, or prove with the \
         static model `spring`, whose cables it does not load"
    )]
    LoadedCable(String),
    /// A minimum tension of zero of a sagging cable.
    #[error(
        "cable \"{0}\" sags and has the minimum tension 0 N, at which the bound of its sag is infinite: give a minimum \
         tension above zero"
    )]
    SlackCable(String),
    /// Limits that exclude each other.
    #[error("the minimum tension of cable \"{0}\" is above its maximum: exchange the two")]
    Limits(String),
    /// Loads in an ellipsoid.
    #[error(
        "a proof needs loads with corners, and an ellipsoid has none: say how it is enclosed by listing the corners of \
         a polytope around it (or inside it) as loads, or give a box"
    )]
    Ellipsoid,
    /// Wind from every direction.
    #[error(
        "required wind from every direction is a disk without corners: list the forces of a polygon around it as loads"
    )]
    RequiredWind,
    /// Too many corners.
    #[error("the required loads have too many corners: give fewer that vary by themselves")]
    ManyLoads,
    /// Turns together with loads whose change is not bounded.
    #[error(
        "with turns the required loads may not include payloads, accelerations, or listed loads away from the origin: \
         leave out the turns, or give these loads as forces and moments about the origin"
    )]
    TurningLoads,
    /// Large turns.
    #[error("a turn of {deg:.4}° is too large for the bound of a box: give at most {}°", MAX_TURN.to_degrees().floor())]
    LargeTurn {
        /// Turn [degrees].
        deg: f64,
    },
    /// Turns of a platform that does not turn that way.
    #[error("the platform does not turn about this axis: leave out the turns")]
    NoTurn,
}

impl ProofStatement {
    /// Statement about a robot with the orientation of a pose, and turns up to these about the world axes [rad].
    ///
    /// # Errors
    /// [`ProofRefusal`]: a robot or loads for which no bound is derived.
    pub fn of(robot: &Robot, pose: &Pose, model: StaticModel, turns: Vec3) -> Result<Self, ProofRefusal> {
        let coordinates = Coordinates::of(robot);
        refuse(robot, &coordinates, &turns)?;
        let with_weight = model == StaticModel::Catenary && robot.gravity_w.norm() > 0.0;
        let cables =
            (0..robot.cables.len()).map(|i| cable_of(robot, i, pose, with_weight)).collect::<Result<Vec<_>, _>>()?;

        // The dead load, and the corners of the required ones.
        let dead = load_wrench(robot, pose);
        let load_force = robot.load.force_w;
        let at_center = Vec3::new(dead[0], dead[1], dead[2]) - load_force;
        let turning = vec![
            [at_center, pose.rot_wp * robot.platform.center_of_mass_p],
            [load_force, pose.rot_wp * robot.load.point_p],
        ];
        let loads = required_vertices(robot, pose).ok_or(ProofRefusal::ManyLoads)?;
        let can_move = match &robot.platform.motion {
            PlatformMotion::Planar(plane) => {
                let normal = plane.normal_w();
                [0, 1, 2].map(|k| normal[k].abs() < 1.0)
            }
            _ => [true; 3],
        };
        Ok(Self { coordinates, cables, loads, turning, turns, up_w: robot.up_w(), can_move })
    }

    /// Number of loads of which all required ones are combinations.
    pub fn load_count(&self) -> usize {
        self.loads.len()
    }

    /// Box without a width along axes on which the platform cannot move.
    #[must_use]
    pub fn within_motion(&self, region: &PositionBox) -> PositionBox {
        let mut region = *region;
        for k in (0..3).filter(|k| !self.can_move[*k]) {
            let middle = region.center()[k];
            (region.lower[k], region.upper[k]) = (middle, middle);
        }
        region
    }

    /// Statement with other anchors, in the order of the cables, world axes [m].
    #[must_use]
    pub fn with_anchors(mut self, anchors_w: &[Vec3]) -> Self {
        for (cable, anchor_w) in self.cables.iter_mut().zip(anchors_w) {
            cable.anchor_w = *anchor_w;
        }
        self
    }
}

/// Refuses robots and loads for which no bound is derived.
fn refuse(robot: &Robot, coordinates: &Coordinates, turns: &Vec3) -> Result<(), ProofRefusal> {
    if robot.cables.len() < coordinates.count() {
        return Err(ProofRefusal::FewCables);
    }
    if !robot.supports.is_empty() {
        return Err(ProofRefusal::Supports);
    }
    let required = &robot.required;
    if required.shape == LoadShape::Ellipsoid && (required.force_w + required.moment_w).norm() > 0.0 {
        return Err(ProofRefusal::Ellipsoid);
    }
    if required.wind_speed > 0.0 {
        return Err(ProofRefusal::RequiredWind);
    }
    if turns.norm() > 0.0 {
        let turns_freely = match &robot.platform.motion {
            PlatformMotion::Rigid => true,
            PlatformMotion::PointMass => false,
            PlatformMotion::Planar(plane) => turns.cross(&plane.normal_w()).norm() < 1e-12 * turns.norm(),
        };
        if !turns_freely {
            return Err(ProofRefusal::NoTurn);
        }
        if turns.norm() > MAX_TURN {
            return Err(ProofRefusal::LargeTurn { deg: turns.norm().to_degrees() });
        }
        let moves = required.acceleration_w.norm() + required.angular_acceleration_w.norm() > 0.0;
        if moves || required.payload.max_mass > 0.0 || required.listed.iter().any(|of| of.point_p.norm() > 0.0) {
            return Err(ProofRefusal::TurningLoads);
        }
    }
    Ok(())
}

fn cable_of(robot: &Robot, i: usize, pose: &Pose, with_weight: bool) -> Result<CableOfStatement, ProofRefusal> {
    let cable = &robot.cables[i];
    let name = || cable.name.clone();
    if cable.anchor.pulley.is_some() {
        return Err(ProofRefusal::Pulley(name()));
    }
    let weight = cable.material.mass_per_length * robot.gravity_w.norm();
    let sag =
        (with_weight && weight > 0.0).then_some(SagOfCable { weight, axial_stiffness: cable.material.axial_stiffness });
    if with_weight {
        let windy = robot.wind.velocity_w.norm() > 0.0 && cable.material.drag_width.is_some_and(|width| width > 0.0);
        if windy || cable.load_per_length_w.norm() > 0.0 {
            return Err(ProofRefusal::LoadedCable(name()));
        }
    }
    let chord_w = cable.chord_w(pose);
    let greatest = TensionRange::of(robot, i, &chord_w).maximum;
    let of_platform = robot.platform.mass * robot.gravity_w.norm();
    let least = match MinimumTension::of(robot, i, &chord_w) {
        MinimumTension::Given(fixed) => LeastTension { fixed, per_length: 0.0 },
        MinimumTension::OfCable { .. } | MinimumTension::OfPlatform { .. } => {
            let [cables, platform] = MinimumTension::DEFAULT_FACTORS;
            LeastTension { fixed: platform * of_platform, per_length: cables * weight }
        }
    };
    if least.fixed > greatest {
        return Err(ProofRefusal::Limits(name()));
    }
    if sag.is_some() && least.at(1.0) <= 0.0 {
        return Err(ProofRefusal::SlackCable(name()));
    }
    let anchor_w = cable.anchor.reference_w();
    let arm_w = pose.rot_wp * cable.attachment_p;
    Ok(CableOfStatement { name: name(), anchor_w, arm_w, least, greatest, sag })
}
