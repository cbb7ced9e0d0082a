//! Noise of the sensors, prior knowledge and process noise.

use crate::math::Vec3;

/// Standard deviations of single readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// Length of a cable by its encoder [m].
    pub length: f64,
    /// Tension at the drum or anchor [N].
    pub tension: f64,
    /// Direction of a cable at its anchor [rad].
    pub angle: f64,
    /// Angular velocity [rad/s].
    pub gyroscope: f64,
    /// Specific force [m/s²].
    pub accelerometer: f64,
    /// Coordinate of the tracked point [m].
    pub tracker: f64,
}

impl Default for SensorNoise {
    fn default() -> Self {
        Self { length: 2e-5, tension: 3.0, angle: 1e-3, gyroscope: 2e-3, accelerometer: 0.03, tracker: 1e-3 }
    }
}

/// Standard deviations of what is known before the first reading; all means are zero except that of the payload.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatePriors {
    /// Payload beyond the platform of the file [kg], with its deviation.
    pub payload: [f64; 2],
    /// First moment of the payload about the platform origin [kg m].
    pub first_moment: f64,
    /// External force besides the loads of the file [N].
    pub force: f64,
    /// External moment [N m].
    pub moment: f64,
    /// Offset of each length [m].
    pub offset: f64,
    /// Bias of each tension [N].
    pub tension_bias: f64,
    /// Bias of the accelerometer [m/s²].
    pub accelerometer_bias: f64,
    /// Bias of the gyroscope [rad/s].
    pub gyroscope_bias: f64,
    /// Velocity at the start [m/s].
    pub velocity: f64,
    /// Angular velocity at the start [rad/s].
    pub angular_velocity: f64,
}

impl Default for StatePriors {
    fn default() -> Self {
        Self {
            payload: [0.0, 20.0],
            first_moment: 2.0,
            force: 3.0,
            moment: 0.5,
            offset: 1e-3,
            tension_bias: 5.0,
            accelerometer_bias: 0.02,
            gyroscope_bias: 2e-3,
            velocity: 2e-3,
            angular_velocity: 2e-3,
        }
    }
}

/// Noise of what changes with time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessNoise {
    /// Correlation time of the external wrench [s]; its deviation is that of the prior.
    pub wrench_time: f64,
    /// Spectral density of the white force on the platform, from vibrations of ropes [N² s].
    pub force: f64,
    /// Spectral density of the white moment [N² m² s].
    pub moment: f64,
    /// Random walk of the payload [kg²/s] and of its first moment [kg² m²/s].
    pub payload: [f64; 2],
    /// Random walk of each offset [m²/s].
    pub offset: f64,
    /// Coefficient of friction between rope and tension sensor: the bias of a tension wanders by 2 μ T in one
    /// centimetre of travel.
    pub friction: f64,
}

impl Default for ProcessNoise {
    fn default() -> Self {
        Self { wrench_time: 1.0, force: 0.02, moment: 0.005, payload: [1e-6, 1e-8], offset: 0.0, friction: 0.0 }
    }
}

/// Everything that an estimator has to be told besides the robot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EstimationSettings {
    /// Noise of the sensors.
    pub noise: SensorNoise,
    /// Knowledge before the first reading.
    pub priors: StatePriors,
    /// Noise of what changes.
    pub process: ProcessNoise,
    /// Place of the inertial unit in the platform frame [m]; its axes are those of the platform.
    pub inertial_unit_p: Vec3,
    /// Tracked point in the platform frame [m].
    pub tracked_point_p: Vec3,
}
