//! Direction of change of a robot: the rate of each of its numbers with respect to one parameter.

use super::{Robot, State};
use crate::math::{Mat3, Vec3};

/// Rates of change of a robot's numbers with respect to one parameter: a direction in the space of all robots with the
/// same number of cables. Derivatives of results are taken along this direction. The units are those of the robot's
/// fields divided by the unit of the parameter.
///
/// # Example
/// ```
/// use funicular::robot::{Robot, RobotChange};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let heavier = robot.changed(&RobotChange::of_mass(&robot), 2.0);
/// assert_eq!(heavier.platform.mass, robot.platform.mass + 2.0); // kg
/// # Ok::<(), funicular::robot::spec::SpecError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RobotChange {
    /// Acceleration of gravity, world axes.
    pub gravity_w: Vec3,
    /// Mass of the platform.
    pub mass: f64,
    /// Inertia tensor about the centre of mass, platform axes; symmetric.
    pub inertia_p: Mat3,
    /// Centre of mass, platform frame.
    pub center_of_mass_p: Vec3,
    /// Drag area of the platform.
    pub drag_area: f64,
    /// Force of the load, world axes.
    pub force_w: Vec3,
    /// Moment of the load, world axes.
    pub moment_w: Vec3,
    /// Point of the load, platform frame.
    pub point_p: Vec3,
    /// The cables, in file order.
    pub cables: Vec<CableChange>,
}

/// Rates of change of the numbers of one cable.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CableChange {
    /// Point of the anchor, world axes.
    pub anchor_w: Vec3,
    /// Attachment, platform frame.
    pub attachment_p: Vec3,
    /// Unstrained length.
    pub unstrained_length: f64,
    /// Axial stiffness EA.
    pub axial_stiffness: f64,
    /// Mass per unstrained length.
    pub mass_per_length: f64,
    /// Dead load per unstrained length besides the weight, world axes.
    pub load_per_length_w: Vec3,
}

impl RobotChange {
    /// Zero change of a robot with this number of cables.
    pub fn none(cables: usize) -> Self {
        Self {
            gravity_w: Vec3::zeros(),
            mass: 0.0,
            inertia_p: Mat3::zeros(),
            center_of_mass_p: Vec3::zeros(),
            drag_area: 0.0,
            force_w: Vec3::zeros(),
            moment_w: Vec3::zeros(),
            point_p: Vec3::zeros(),
            cables: vec![CableChange::default(); cables],
        }
    }

    /// Unit change of the platform mass; inertia tensor and centre of mass stay.
    pub fn of_mass(robot: &Robot) -> Self {
        Self { mass: 1.0, ..Self::none(robot.cables.len()) }
    }
}

impl Robot {
    /// This robot after `step` units of the parameter. Unstrained lengths change if the robot's state gives them. The
    /// result is not checked: a mass can become negative.
    #[must_use]
    pub fn changed(&self, change: &RobotChange, step: f64) -> Self {
        let mut robot = self.clone();
        robot.gravity_w += change.gravity_w * step;
        robot.platform.mass += change.mass * step;
        robot.platform.inertia_p += change.inertia_p * step;
        robot.platform.center_of_mass_p += change.center_of_mass_p * step;
        robot.platform.drag_area += change.drag_area * step;
        robot.load.force_w += change.force_w * step;
        robot.load.moment_w += change.moment_w * step;
        robot.load.point_p += change.point_p * step;

        for (cable, change) in robot.cables.iter_mut().zip(&change.cables) {
            cable.anchor.point_w += change.anchor_w * step;
            cable.attachment_p += change.attachment_p * step;
            cable.material.axial_stiffness += change.axial_stiffness * step;
            cable.material.mass_per_length += change.mass_per_length * step;
            cable.load_per_length_w += change.load_per_length_w * step;
        }

        if let State::Lengths(lengths) = &mut robot.state {
            for (length, change) in lengths.iter_mut().zip(&change.cables) {
                *length += change.unstrained_length * step;
            }
        }
        robot
    }
}
