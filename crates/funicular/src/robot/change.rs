//! Direction of change of a robot: the rate of each of its numbers with respect to one parameter.

use super::{Cable, Control, Damping, GuideWheel, Pulley, Robot, State, Support, Winch};
use crate::math::{Mat3, Vec3};

/// Product of one rate with another one; vectors and tensors have their own.
trait Dot {
    fn dot(&self, other: &Self) -> f64;
}

impl Dot for f64 {
    fn dot(&self, other: &Self) -> f64 {
        self * other
    }
}

impl<T: Dot> Dot for Vec<T> {
    fn dot(&self, other: &Self) -> f64 {
        self.iter().zip(other).map(|(own, other)| own.dot(other)).sum()
    }
}

/// Sum of rates with multiples of other ones.
trait Sum {
    fn add(&mut self, factor: f64, other: &Self);
}

impl Sum for f64 {
    fn add(&mut self, factor: f64, other: &Self) {
        *self += factor * other;
    }
}

impl Sum for Vec3 {
    fn add(&mut self, factor: f64, other: &Self) {
        *self += factor * other;
    }
}

impl Sum for Mat3 {
    fn add(&mut self, factor: f64, other: &Self) {
        *self += factor * other;
    }
}

impl<T: Sum + Clone + Default> Sum for Vec<T> {
    fn add(&mut self, factor: f64, other: &Self) {
        self.resize(self.len().max(other.len()), T::default());
        self.iter_mut().zip(other).for_each(|(own, other)| own.add(factor, other));
    }
}

/// Declares the rates of change of the numbers of a part of the robot. After the arrow stands the place of the number
/// in the part; without a place, the number changes in a way of its own.
macro_rules! numbers {
    (
        $(#[$about_part:meta])*
        pub struct $Change:ident of $Part:ty {
            $($(#[$about:meta])* $rate:ident: $Rate:ty $(=> $($place:ident).+)?,)*
        }
    ) => {
        $(#[$about_part])*
        pub struct $Change {
            $($(#[$about])* pub $rate: $Rate,)*
        }

        impl Dot for $Change {
            fn dot(&self, other: &Self) -> f64 {
                0.0 $(+ self.$rate.dot(&other.$rate))*
            }
        }

        impl Sum for $Change {
            fn add(&mut self, factor: f64, other: &Self) {
                $(self.$rate.add(factor, &other.$rate);)*
            }
        }

        impl $Change {
            /// Adds `step` units of the parameter to the numbers that have a place.
            fn add_to(&self, part: &mut $Part, step: f64) {
                $($(part.$($place).+ += self.$rate * step;)?)*
            }
        }
    };
}

numbers! {
    /// Rates of change of a robot's numbers with respect to one parameter: a direction in the space of all robots with
    /// the same number of cables. Derivatives of results are taken along this direction. The units are those of the
    /// robot's fields divided by the unit of the parameter.
    ///
    /// Also the gradient of a result, [`crate::gradient`]: every field is then the derivative of the result with
    /// respect to this number, and [`Self::dot`] with a direction the derivative along it.
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
    #[derive(Debug, Clone, PartialEq, Default)]
    pub struct RobotChange of Robot {
        /// Acceleration of gravity, world axes.
        gravity_w: Vec3 => gravity_w,
        /// Mass of the platform.
        mass: f64 => platform.mass,
        /// Inertia tensor about the centre of mass, platform axes; symmetric.
        inertia_p: Mat3 => platform.inertia_p,
        /// Centre of mass, platform frame.
        center_of_mass_p: Vec3 => platform.center_of_mass_p,
        /// Drag area of the platform.
        drag_area: f64 => platform.drag_area,
        /// Force of the load, world axes.
        force_w: Vec3 => load.force_w,
        /// Moment of the load, world axes.
        moment_w: Vec3 => load.moment_w,
        /// Point of the load, platform frame.
        point_p: Vec3 => load.point_p,
        /// Velocity of the air, world axes.
        wind_velocity_w: Vec3 => wind.velocity_w,
        /// Density of the air.
        air_density: f64 => wind.air_density,
        /// Viscous damping of the platform's translation, platform axes.
        translational_damping_p: Vec3 => platform.translational_damping_p,
        /// Viscous damping of the platform's rotation, platform axes.
        rotational_damping_p: Vec3 => platform.rotational_damping_p,
        /// Position of a pose that is given, world axes.
        position_w: Vec3,
        /// Rotation vector by which a pose that is given turns, world axes.
        rotation_w: Vec3,
        /// The cables, in file order.
        cables: Vec<CableChange>,
        /// The flexible supports, in the order of [`Robot::supports`]; none changes beyond the end of the list.
        supports: Vec<SupportChange>,
    }
}

numbers! {
    /// Rates of change of the numbers of a flexible support.
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct SupportChange of Support {
        /// Stiffness against a displacement, world axes; symmetric.
        stiffness_w: Mat3 => stiffness_w,
        /// Mass that moves with its anchors.
        mass: f64 => mass,
        /// Damping ratio.
        damping_ratio: f64 => damping_ratio,
    }
}

numbers! {
    /// Rates of change of the numbers of one cable.
    #[derive(Debug, Clone, PartialEq, Default)]
    pub struct CableChange of Cable {
        /// Point of the anchor, world axes.
        anchor_w: Vec3 => anchor.point_w,
        /// Attachment, platform frame.
        attachment_p: Vec3 => attachment_p,
        /// Unstrained length.
        unstrained_length: f64,
        /// Axial stiffness EA.
        axial_stiffness: f64 => material.axial_stiffness,
        /// Mass per unstrained length.
        mass_per_length: f64 => material.mass_per_length,
        /// Dead load per unstrained length besides the weight, world axes.
        load_per_length_w: Vec3 => load_per_length_w,
        /// Drag coefficient times diameter.
        drag_width: f64,
        /// Damping: the ratio, or the viscous damping per length, whichever the rope has.
        damping: f64,
        /// Loss factor of the stretch.
        loss_factor: f64 => material.stretch_loss.factor,
        /// Damping time of the stretch.
        damping_time: f64 => material.stretch_loss.time,
        /// Pulley at the anchor.
        pulley: PulleyChange,
        /// Winch behind the anchor.
        winch: WinchChange,
        /// Guide wheels of the winch, in its order; none changes beyond the end of the list.
        guide_wheels: Vec<GuideWheelChange>,
    }
}

numbers! {
    /// Rates of change of the numbers of a guide wheel.
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct GuideWheelChange of GuideWheel {
        /// Length of the cable from the entry point to the wheel.
        distance: f64 => distance,
        /// Mass that the wheel adds at the cable.
        mass: f64 => mass,
    }
}

numbers! {
    /// Rates of change of the numbers of the pulley of one cable.
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct PulleyChange of Pulley {
        /// Radius.
        radius: f64 => radius,
        /// Direction of travel at the entry point, world axes; normal to the direction, which keeps its length.
        entry_direction_w: Vec3,
        /// Moment of inertia of the wheel.
        inertia: f64 => inertia,
        /// Moment of inertia of all that swivels.
        swivel_inertia: f64 => swivel_inertia,
    }
}

numbers! {
    /// Rates of change of the numbers of the winch of one cable, all at the cable.
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct WinchChange of Winch {
        /// Length from the drum to the entry point.
        drum_side_length: f64 => drum_side_length,
        /// Mechanical stiffness; without effect on a rigid winch.
        stiffness: f64 => stiffness,
        /// Mass of the drum.
        drum_mass: f64 => drum_mass,
        /// Mass of the motor.
        motor_mass: f64 => motor_mass,
        /// Viscous damping.
        damping: f64 => damping,
        /// Position gain of a position control.
        position_gain: f64,
        /// Speed gain of a position control.
        speed_gain: f64,
        /// Delay of a position control.
        delay: f64,
    }
}

impl PulleyChange {
    /// Changes a pulley by `step` units of the parameter.
    fn apply(&self, pulley: &mut Pulley, step: f64) {
        self.add_to(pulley, step);
        if self.entry_direction_w != Vec3::zeros() {
            pulley.entry_direction_w = (pulley.entry_direction_w + self.entry_direction_w * step).normalize();
        }
    }
}

impl WinchChange {
    /// Changes a winch by `step` units of the parameter.
    fn apply(&self, winch: &mut Winch, step: f64) {
        self.add_to(winch, step);
        if let Control::Position(servo) = &mut winch.control {
            servo.position_gain += self.position_gain * step;
            servo.speed_gain += self.speed_gain * step;
            servo.delay += self.delay * step;
        }
    }
}

impl CableChange {
    /// Changes a cable, apart from its unstrained length, by `step` units of the parameter.
    fn apply(&self, cable: &mut Cable, step: f64) {
        self.add_to(cable, step);
        if self.drag_width != 0.0 {
            *cable.material.drag_width.get_or_insert(0.0) += self.drag_width * step;
        }
        let (Damping::Ratio(value) | Damping::Viscous(value)) = &mut cable.material.damping;
        *value += self.damping * step;

        if let Some(pulley) = &mut cable.anchor.pulley {
            self.pulley.apply(pulley, step);
        }
        if let Some(winch) = &mut cable.anchor.winch {
            self.winch.apply(winch, step);
            for (wheel, change) in winch.guide_wheels.iter_mut().zip(&self.guide_wheels) {
                change.add_to(wheel, step);
            }
        }
    }
}

impl RobotChange {
    /// Zero change of a robot with this number of cables.
    pub fn none(cables: usize) -> Self {
        Self { cables: vec![CableChange::default(); cables], ..Self::default() }
    }

    /// Unit change of the platform mass; inertia tensor and centre of mass stay.
    pub fn of_mass(robot: &Robot) -> Self {
        Self { mass: 1.0, ..Self::none(robot.cables.len()) }
    }

    /// Sum of the products of all numbers with those of another one: the derivative of a result along a direction, if
    /// one of the two is the gradient of the result. Both have the same number of cables.
    pub fn dot(&self, other: &Self) -> f64 {
        Dot::dot(self, other)
    }

    /// Adds the rates of another change: the gradient of a sum is the sum of the gradients.
    pub fn add(&mut self, other: &Self) {
        self.add_scaled(1.0, other);
    }

    /// Adds a multiple of the rates of another change: several numbers that move together.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        Sum::add(self, factor, other);
    }
}

impl Robot {
    /// Copy of the robot after `step` units of the parameter. Unstrained lengths change if the state gives lengths, the
    /// pose changes if the state gives a pose. The result is not checked: a mass can become negative.
    #[must_use]
    pub fn changed(&self, change: &RobotChange, step: f64) -> Self {
        let mut robot = self.clone();
        change.add_to(&mut robot, step);
        for (cable, change) in robot.cables.iter_mut().zip(&change.cables) {
            change.apply(cable, step);
        }
        for (support, change) in robot.supports.iter_mut().zip(&change.supports) {
            change.add_to(support, step);
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
