//! Winch of a cable: drum, shaft and motor with its control, and the cable between drum and entry point.
//!
//! All numbers refer to motion of the cable at the drum: an inertia J about the drum's axis counts as the mass J/R², a
//! torsional stiffness k as k/R², R being the radius of the drum. A motor behind a gear of the ratio i turns i times as
//! fast as the drum, so that its inertia counts i² times.

mod limits;

pub use limits::{LimitOfWinch, MotorLoad, WinchLimits};

use std::f64::consts::TAU;

/// Winch.
#[derive(Debug, Clone, PartialEq)]
pub struct Winch {
    /// Name in the robot file.
    pub name: String,
    /// Radius of the drum [m]; `None` if no number of the file refers to the drum's axis. Torque and speed of the motor
    /// follow from it; stiffness, masses, damping and gains refer to the cable already.
    pub drum_radius: Option<f64>,
    /// Turns of the motor per turn of the drum; `motor_mass` includes it already.
    pub gear_ratio: f64,
    /// Efficiency of the gear: the part of the power that leaves it, in either direction. It acts on the motor's torque
    /// and power alone.
    pub gear_efficiency: f64,
    /// Length of the cable from the drum to the entry point [m], guide wheels included.
    pub drum_side_length: f64,
    /// Vibration of the cable between drum and exit point.
    pub drum_side: DrumSide,
    /// Guide wheels between entry point and drum, the nearest to the entry point first.
    pub guide_wheels: Vec<GuideWheel>,
    /// Mechanical stiffness of shaft, gear and drum at the cable [N/m]; infinite for a rigid winch.
    pub stiffness: f64,
    /// Mass that the drum adds at the cable [kg].
    pub drum_mass: f64,
    /// Mass that the motor adds at the cable, behind the gear [kg].
    pub motor_mass: f64,
    /// Viscous damping of motor and bearings at the cable [N s/m].
    pub damping: f64,
    /// Control of the motor.
    pub control: Control,
    /// Limits of winch and motor, which judge motions and never change an equilibrium.
    pub limits: WinchLimits,
}

/// Wheel with inertia that guides the cable between entry point and drum. It changes vibration alone: at rest the
/// lengths around guide wheels are part of the drum side.
#[derive(Debug, Clone, PartialEq)]
pub struct GuideWheel {
    /// Name in the robot file.
    pub name: String,
    /// Length of the cable from the entry point to the wheel [m].
    pub distance: f64,
    /// Mass that the wheel adds at the cable [kg].
    pub mass: f64,
}

/// Model of the cable between drum and exit point in vibration. At rest there is no difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DrumSide {
    /// Spring without mass.
    #[default]
    Massless,
    /// Elastic rod: the mass of the cable moves along the cable, with its axial waves.
    Rod,
}

/// Control of the motor of a winch.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Control {
    /// The motor holds its angle exactly.
    #[default]
    Ideal,
    /// A controller holds the angle.
    Position(Servo),
    /// The torque of the motor is constant.
    Torque,
}

/// Position control of a motor: the force `(K_p + iω K_d) e^{−iωτ}` at the cable per error of the drum's position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// Gain K_p at the cable [N/m].
    pub position_gain: f64,
    /// Gain K_d at the cable [N s/m].
    pub speed_gain: f64,
    /// Slow integral action, which leaves no error at rest. Without it the winch yields at rest by the tension over
    /// K_p.
    pub integral: bool,
    /// Delay τ of the loop [s].
    pub delay: f64,
}

impl Servo {
    /// Servo that moves a mass [kg] with a bandwidth [Hz] and a damping ratio: `K_p = M ω_b²`, `K_d = 2 ζ M ω_b`.
    pub fn of_bandwidth(mass: f64, bandwidth_hz: f64, damping_ratio: f64, integral: bool, delay: f64) -> Self {
        let omega = bandwidth_hz * TAU;
        Self { position_gain: mass * omega * omega, speed_gain: 2.0 * damping_ratio * mass * omega, integral, delay }
    }
}

/// Winches in vibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WinchMode {
    /// Winches as the robot file describes them.
    #[default]
    AsGiven,
    /// Motors held at their angle, as with an infinitely fast control.
    Clamped,
    /// Motors with constant torque.
    Torque,
    /// Cables that stick to their pulleys: no part behind the pulley moves.
    Stuck,
}

impl WinchMode {
    /// All modes.
    pub const ALL: [Self; 4] = [Self::AsGiven, Self::Clamped, Self::Torque, Self::Stuck];

    /// Name in requests and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsGiven => "as-given",
            Self::Clamped => "clamped",
            Self::Torque => "torque",
            Self::Stuck => "stuck",
        }
    }
}

impl Winch {
    /// Rigid winch without inertia, whose motor holds its angle.
    pub fn rigid(name: &str, drum_side_length: f64) -> Self {
        Self {
            name: name.to_owned(),
            drum_radius: None,
            gear_ratio: 1.0,
            gear_efficiency: 1.0,
            drum_side_length,
            drum_side: DrumSide::Massless,
            guide_wheels: Vec::new(),
            stiffness: f64::INFINITY,
            drum_mass: 0.0,
            motor_mass: 0.0,
            damping: 0.0,
            control: Control::Ideal,
            limits: WinchLimits::NONE,
        }
    }

    /// State of the motor while the cable moves: tension at the drum [N], speed and acceleration of the cable at the
    /// drum [m/s, m/s²], positive while it pays out.
    ///
    /// Behind the gear, tension, inertia of the drum and damping ask for the force `F = T + M_D u̇ + d u` at the cable,
    /// u being the speed at which the cable is wound in. A motor that drives (F u > 0) gives F/η, one that brakes
    /// receives F η. At rest the friction of the gear may help or hinder, so that a whole range of forces holds the
    /// cable; the result is the one in its middle, F, as without friction. The inertia of the motor is in front of the
    /// gear.
    ///
    /// # Example
    /// ```
    /// use funicular::robot::Winch;
    ///
    /// let rigid = Winch::rigid("drum", 0.0);
    /// let winch = Winch { drum_radius: Some(0.1), gear_ratio: 5.0, gear_efficiency: 0.8, ..rigid };
    /// let motor = winch.motor(400.0, -2.0, 0.0); // winds in 2 m/s
    /// assert!((motor.power - 1000.0).abs() < 1e-9); // W
    /// assert!((motor.torque.unwrap() - 10.0).abs() < 1e-12); // N m
    /// assert!((motor.speed.unwrap() - 100.0).abs() < 1e-12); // rad/s
    /// ```
    pub fn motor(&self, tension: f64, speed: f64, acceleration: f64) -> MotorLoad {
        let (inwards, inwards_rate) = (-speed, -acceleration);
        let behind_gear = tension + self.drum_mass * inwards_rate + self.damping * inwards;
        let power_behind_gear = behind_gear * inwards;

        let by_gear = if power_behind_gear > 0.0 {
            1.0 / self.gear_efficiency
        } else if power_behind_gear < 0.0 {
            self.gear_efficiency
        } else {
            1.0
        };
        let force = behind_gear * by_gear + self.motor_mass * inwards_rate;

        // Cable per angle of the motor.
        let lever = self.drum_radius.map(|radius| radius / self.gear_ratio);
        MotorLoad {
            speed: lever.map(|lever| inwards / lever),
            torque: lever.map(|lever| force * lever),
            power: force * inwards,
        }
    }

    /// Position control of the motor, if it has one.
    pub(crate) fn servo(&self) -> Option<Servo> {
        if let Control::Position(servo) = self.control { Some(servo) } else { None }
    }

    /// Length by which the winch pays out cable per tension at rest [m/N]: that of its mechanical stiffness, and that
    /// of a control without integral action.
    pub fn compliance(&self) -> f64 {
        let by_control = match self.control {
            Control::Position(servo) if !servo.integral => 1.0 / servo.position_gain,
            Control::Position(_) | Control::Ideal | Control::Torque => 0.0,
        };
        1.0 / self.stiffness + by_control
    }
}
