//! Limits of a winch and its motor, and how much of each a motion uses.

/// Limits of a winch and its motor. They hold in both directions.
#[derive(Debug, Clone, PartialEq)]
pub struct WinchLimits {
    /// Largest speed of the cable at the drum [m/s]; infinite without a limit.
    pub speed: f64,
    /// Largest acceleration of the cable at the drum [m/s²]; infinite without a limit.
    pub acceleration: f64,
    /// Largest torque of the motor at its own shaft [N m]; infinite without a limit.
    pub torque: f64,
    /// Largest mechanical power of the motor while it drives [W]; infinite without a limit.
    pub power: f64,
    /// Largest mechanical power that the motor takes while it brakes [W]; infinite without a limit.
    pub brake_power: f64,
    /// Corners of the torque–speed curve of the motor at its own shaft, speed [rad/s] and torque [N m]. The speeds rise
    /// from zero, the curve is straight between corners, and beyond the last one there is no torque. Empty without a
    /// curve.
    pub torque_speed: Vec<[f64; 2]>,
}

/// Limit of a winch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitOfWinch {
    /// Speed of the cable.
    Speed,
    /// Acceleration of the cable.
    Acceleration,
    /// Torque of the motor, also by its torque–speed curve.
    Torque,
    /// Power of the motor that drives.
    Power,
    /// Power of the motor that brakes.
    BrakePower,
}

impl LimitOfWinch {
    /// All limits.
    pub const ALL: [Self; 5] = [Self::Speed, Self::Acceleration, Self::Torque, Self::Power, Self::BrakePower];

    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::Torque => "torque",
            Self::Power => "power",
            Self::BrakePower => "brake-power",
        }
    }
}

/// State of the motor of a winch at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorLoad {
    /// Speed of the motor [rad/s], positive while it winds cable in; `None` without a radius of the drum.
    pub speed: Option<f64>,
    /// Torque of the motor at its own shaft [N m], positive in the direction that winds cable in; `None` without a
    /// radius of the drum.
    pub torque: Option<f64>,
    /// Mechanical power of the motor [W], positive while it drives, negative while it brakes.
    pub power: f64,
}

impl Default for WinchLimits {
    fn default() -> Self {
        Self::NONE
    }
}

impl WinchLimits {
    /// Winch without limits.
    pub const NONE: Self = Self {
        speed: f64::INFINITY,
        acceleration: f64::INFINITY,
        torque: f64::INFINITY,
        power: f64::INFINITY,
        brake_power: f64::INFINITY,
        torque_speed: Vec::new(),
    };

    /// Largest torque at a speed of the motor [rad/s] of either sign: the smaller of the limit of torque and the
    /// torque–speed curve [N m].
    pub fn torque_at(&self, motor_speed: f64) -> f64 {
        let speed = motor_speed.abs();
        let piece = self.torque_speed.windows(2).find(|piece| speed <= piece[1][0]);
        let by_curve = match (piece, self.torque_speed.last()) {
            (Some(&[[from, at_from], [to, at_to]]), _) => at_from + (at_to - at_from) * (speed - from) / (to - from),
            (_, Some(&[last, torque])) if speed <= last => torque,
            (_, Some(_)) => 0.0,
            (_, None) => f64::INFINITY,
        };
        self.torque.min(by_curve)
    }

    /// Parts of the limits that a motion uses, each used ÷ allowed and above 1 beyond the limit: speed and acceleration
    /// of the cable at the drum, and what the motor does meanwhile. A limit that is not given is not used.
    ///
    /// The part is infinite where nothing is allowed: a torque beyond the end of the torque–speed curve.
    pub fn use_of(&self, cable_speed: f64, cable_acceleration: f64, motor: &MotorLoad) -> [(LimitOfWinch, f64); 5] {
        // Without a radius of the drum there is neither a torque nor a limit of it.
        let (motor_speed, torque) = (motor.speed.unwrap_or(0.0), motor.torque.unwrap_or(0.0));
        let part = |of: LimitOfWinch| match of {
            LimitOfWinch::Speed => part_of(cable_speed.abs(), self.speed),
            LimitOfWinch::Acceleration => part_of(cable_acceleration.abs(), self.acceleration),
            LimitOfWinch::Torque => part_of(torque.abs(), self.torque_at(motor_speed)),
            LimitOfWinch::Power => part_of(motor.power.max(0.0), self.power),
            LimitOfWinch::BrakePower => part_of((-motor.power).max(0.0), self.brake_power),
        };
        LimitOfWinch::ALL.map(|of| (of, part(of)))
    }
}

/// Used part of what is allowed. Nothing used is no part, also where nothing is allowed.
fn part_of(used: f64, allowed: f64) -> f64 {
    if used == 0.0 { 0.0 } else { used / allowed }
}
