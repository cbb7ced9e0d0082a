//! Direction of change of a robot: the rate of each of its numbers with respect to one parameter.

use super::{Control, Damping, Pulley, Robot, State, Support, Winch};
use crate::math::{Mat3, Vec3};

/// Rates of change of a robot's numbers with respect to one parameter: a direction in the space of all robots with the
/// same number of cables. Derivatives of results are taken along this direction. The units are those of the robot's
/// fields divided by the unit of the parameter.
///
/// Also the gradient of a result, [`crate::gradient`]: every field is then the derivative of the result with respect to
/// this number, and [`Self::dot`] with a direction the derivative along it.
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
    /// Velocity of the air, world axes.
    pub wind_velocity_w: Vec3,
    /// Density of the air.
    pub air_density: f64,
    /// Viscous damping of the platform's translation, platform axes.
    pub translational_damping_p: Vec3,
    /// Viscous damping of the platform's rotation, platform axes.
    pub rotational_damping_p: Vec3,
    /// Position of a pose that is given, world axes.
    pub position_w: Vec3,
    /// Rotation vector by which a pose that is given turns, world axes.
    pub rotation_w: Vec3,
    /// The cables, in file order.
    pub cables: Vec<CableChange>,
    /// The flexible supports, in the order of [`Robot::supports`]; none changes beyond the end of the list.
    pub supports: Vec<SupportChange>,
}

/// Rates of change of the numbers of a flexible support.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SupportChange {
    /// Stiffness against a displacement, world axes; symmetric.
    pub stiffness_w: Mat3,
    /// Mass that moves with its anchors.
    pub mass: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// Rates of change of the numbers of one cable.
#[derive(Debug, Clone, PartialEq, Default)]
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
    /// Drag coefficient times diameter.
    pub drag_width: f64,
    /// Damping: the ratio, or the viscous damping per length, whichever the rope has.
    pub damping: f64,
    /// Pulley at the anchor.
    pub pulley: PulleyChange,
    /// Winch behind the anchor.
    pub winch: WinchChange,
    /// Guide wheels of the winch, in its order; none changes beyond the end of the list.
    pub guide_wheels: Vec<GuideWheelChange>,
}

/// Rates of change of the numbers of a guide wheel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GuideWheelChange {
    /// Length of the cable from the entry point to the wheel.
    pub distance: f64,
    /// Mass that the wheel adds at the cable.
    pub mass: f64,
}

/// Rates of change of the numbers of the pulley of one cable.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PulleyChange {
    /// Radius.
    pub radius: f64,
    /// Direction of travel at the entry point, world axes; normal to the direction, which keeps its length.
    pub entry_direction_w: Vec3,
    /// Moment of inertia of the wheel.
    pub inertia: f64,
    /// Moment of inertia of all that swivels.
    pub swivel_inertia: f64,
}

/// Rates of change of the numbers of the winch of one cable, all at the cable.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WinchChange {
    /// Length from the drum to the entry point.
    pub drum_side_length: f64,
    /// Mechanical stiffness; without effect on a rigid winch.
    pub stiffness: f64,
    /// Mass of the drum.
    pub drum_mass: f64,
    /// Mass of the motor.
    pub motor_mass: f64,
    /// Viscous damping.
    pub damping: f64,
    /// Position gain of a position control.
    pub position_gain: f64,
    /// Speed gain of a position control.
    pub speed_gain: f64,
    /// Delay of a position control.
    pub delay: f64,
}

impl PulleyChange {
    /// Sum of the products of all numbers with those of another one.
    fn dot(&self, other: &Self) -> f64 {
        self.radius * other.radius
            + self.entry_direction_w.dot(&other.entry_direction_w)
            + self.inertia * other.inertia
            + self.swivel_inertia * other.swivel_inertia
    }

    /// Changes a pulley by `step` units of the parameter.
    fn apply(&self, pulley: &mut Pulley, step: f64) {
        pulley.radius += self.radius * step;
        pulley.inertia += self.inertia * step;
        pulley.swivel_inertia += self.swivel_inertia * step;
        if self.entry_direction_w != Vec3::zeros() {
            pulley.entry_direction_w = (pulley.entry_direction_w + self.entry_direction_w * step).normalize();
        }
    }
}

impl WinchChange {
    /// Sum of the products of all numbers with those of another one.
    fn dot(&self, other: &Self) -> f64 {
        self.drum_side_length * other.drum_side_length
            + self.stiffness * other.stiffness
            + self.drum_mass * other.drum_mass
            + self.motor_mass * other.motor_mass
            + self.damping * other.damping
            + self.position_gain * other.position_gain
            + self.speed_gain * other.speed_gain
            + self.delay * other.delay
    }

    /// Changes a winch by `step` units of the parameter.
    fn apply(&self, winch: &mut Winch, step: f64) {
        winch.drum_side_length += self.drum_side_length * step;
        winch.stiffness += self.stiffness * step;
        winch.drum_mass += self.drum_mass * step;
        winch.motor_mass += self.motor_mass * step;
        winch.damping += self.damping * step;
        if let Control::Position(servo) = &mut winch.control {
            servo.position_gain += self.position_gain * step;
            servo.speed_gain += self.speed_gain * step;
            servo.delay += self.delay * step;
        }
    }
}

impl GuideWheelChange {
    fn product((own, other): (&Self, &Self)) -> f64 {
        own.distance * other.distance + own.mass * other.mass
    }
}

impl SupportChange {
    fn product((own, other): (&Self, &Self)) -> f64 {
        own.stiffness_w.dot(&other.stiffness_w) + own.mass * other.mass + own.damping_ratio * other.damping_ratio
    }

    /// Changes a support by `step` units of the parameter.
    fn apply(&self, support: &mut Support, step: f64) {
        support.stiffness_w += self.stiffness_w * step;
        support.mass += self.mass * step;
        support.damping_ratio += self.damping_ratio * step;
    }
}

impl CableChange {
    /// Sum of the products of all numbers with those of another one.
    fn dot(&self, other: &Self) -> f64 {
        self.anchor_w.dot(&other.anchor_w)
            + self.attachment_p.dot(&other.attachment_p)
            + self.unstrained_length * other.unstrained_length
            + self.axial_stiffness * other.axial_stiffness
            + self.mass_per_length * other.mass_per_length
            + self.load_per_length_w.dot(&other.load_per_length_w)
            + self.drag_width * other.drag_width
            + self.damping * other.damping
            + self.pulley.dot(&other.pulley)
            + self.winch.dot(&other.winch)
            + self.guide_wheels.iter().zip(&other.guide_wheels).map(GuideWheelChange::product).sum::<f64>()
    }
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
            wind_velocity_w: Vec3::zeros(),
            air_density: 0.0,
            translational_damping_p: Vec3::zeros(),
            rotational_damping_p: Vec3::zeros(),
            position_w: Vec3::zeros(),
            rotation_w: Vec3::zeros(),
            cables: vec![CableChange::default(); cables],
            supports: Vec::new(),
        }
    }

    /// Unit change of the platform mass; inertia tensor and centre of mass stay.
    pub fn of_mass(robot: &Robot) -> Self {
        Self { mass: 1.0, ..Self::none(robot.cables.len()) }
    }

    /// Sum of the products of all numbers with those of another one: the derivative of a result along a direction, if
    /// one of the two is the gradient of the result. Both have the same number of cables.
    pub fn dot(&self, other: &Self) -> f64 {
        let cables: f64 = self.cables.iter().zip(&other.cables).map(|(own, other)| own.dot(other)).sum();
        let supports: f64 = self.supports.iter().zip(&other.supports).map(SupportChange::product).sum();
        self.gravity_w.dot(&other.gravity_w)
            + self.mass * other.mass
            + self.inertia_p.dot(&other.inertia_p)
            + self.center_of_mass_p.dot(&other.center_of_mass_p)
            + self.drag_area * other.drag_area
            + self.force_w.dot(&other.force_w)
            + self.moment_w.dot(&other.moment_w)
            + self.point_p.dot(&other.point_p)
            + self.wind_velocity_w.dot(&other.wind_velocity_w)
            + self.air_density * other.air_density
            + self.translational_damping_p.dot(&other.translational_damping_p)
            + self.rotational_damping_p.dot(&other.rotational_damping_p)
            + self.position_w.dot(&other.position_w)
            + self.rotation_w.dot(&other.rotation_w)
            + cables
            + supports
    }
}

impl Robot {
    /// Copy of the robot after `step` units of the parameter. Unstrained lengths change if the state gives lengths, the
    /// pose changes if the state gives a pose. The result is not checked: a mass can become negative.
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
        robot.wind.velocity_w += change.wind_velocity_w * step;
        robot.wind.air_density += change.air_density * step;
        robot.platform.translational_damping_p += change.translational_damping_p * step;
        robot.platform.rotational_damping_p += change.rotational_damping_p * step;

        for (cable, change) in robot.cables.iter_mut().zip(&change.cables) {
            cable.anchor.point_w += change.anchor_w * step;
            cable.attachment_p += change.attachment_p * step;
            cable.material.axial_stiffness += change.axial_stiffness * step;
            cable.material.mass_per_length += change.mass_per_length * step;
            cable.load_per_length_w += change.load_per_length_w * step;
            if change.drag_width != 0.0 {
                *cable.material.drag_width.get_or_insert(0.0) += change.drag_width * step;
            }
            let (Damping::Ratio(value) | Damping::Viscous(value)) = &mut cable.material.damping;
            *value += change.damping * step;
            if let Some(pulley) = &mut cable.anchor.pulley {
                change.pulley.apply(pulley, step);
            }
            if let Some(winch) = &mut cable.anchor.winch {
                change.winch.apply(winch, step);
                for (wheel, change) in winch.guide_wheels.iter_mut().zip(&change.guide_wheels) {
                    wheel.distance += change.distance * step;
                    wheel.mass += change.mass * step;
                }
            }
        }

        for (support, change) in robot.supports.iter_mut().zip(&change.supports) {
            change.apply(support, step);
        }

        match &mut robot.state {
            State::Lengths(lengths) => {
                for (length, change) in lengths.iter_mut().zip(&change.cables) {
                    *length += change.unstrained_length * step;
                }
            }
            State::Pose(pose) => {
                *pose = pose.moved(&(change.position_w * step), &(change.rotation_w * step));
            }
            State::Unknown => {}
        }
        robot
    }
}
