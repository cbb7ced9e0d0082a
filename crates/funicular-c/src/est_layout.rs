//! Structs of the estimator, member by member. Members are only ever appended.

use crate::layout::{Sized32, zero_by_default};

/// `fn_est_settings`: noise of the sensors, knowledge before the first reading, places on the platform.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct EstSettings {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Zero.
    pub reserved: u32,
    /// Standard deviation of a length between its readings [m].
    pub length_std_m: f64,
    /// Standard deviation of a tension [N].
    pub tension_std_n: f64,
    /// Standard deviation of the direction of a cable [rad].
    pub cable_angle_std_rad: f64,
    /// Standard deviation of the gyroscope [rad/s].
    pub gyroscope_std_rad_s: f64,
    /// Standard deviation of the accelerometer [m/s²].
    pub accelerometer_std_m_s2: f64,
    /// Standard deviation of each coordinate of the tracked point [m].
    pub tracker_std_m: f64,
    /// Payload beyond the platform of the file [kg].
    pub payload_kg: f64,
    /// Standard deviation of the payload [kg].
    pub payload_std_kg: f64,
    /// Standard deviation of its first moment [kg m].
    pub first_moment_std_kg_m: f64,
    /// Standard deviation of an external force [N].
    pub force_std_n: f64,
    /// Standard deviation of an external moment [N m].
    pub moment_std_n_m: f64,
    /// Time in which external force and moment change [s].
    pub force_time_s: f64,
    /// Standard deviation of the constant error of each length [m].
    pub offset_std_m: f64,
    /// Standard deviation of the constant error of each tension [N].
    pub tension_bias_std_n: f64,
    /// Coefficient of friction between rope and load cell.
    pub friction: f64,
    /// False alarms of the tests of the load cells per hour.
    pub false_alarms_per_hour: f64,
    /// Place of the inertial unit, platform frame [m].
    pub inertial_unit_m: [f64; 3],
    /// Tracked point, platform frame [m].
    pub tracked_point_m: [f64; 3],
}

/// `fn_est_readings`: readings of one time. An array that is null was not read at this time.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct EstReadings {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Number of values of each array per cable.
    pub cables: u32,
    /// Unstrained lengths by the encoders [m].
    pub length_m: *const f64,
    /// Tensions at drums or anchors [N].
    pub tension_n: *const f64,
    /// Azimuths at which cables leave their anchors [rad].
    pub azimuth_rad: *const f64,
    /// Elevations [rad].
    pub elevation_rad: *const f64,
    /// Angular velocity, platform axes [rad/s], three numbers.
    pub gyroscope_rad_s: *const f64,
    /// Specific force, platform axes [m/s²], three numbers.
    pub accelerometer_m_s2: *const f64,
    /// Tracked point in the world [m], three numbers.
    pub tracker_m: *const f64,
    /// Places of each array without a reading, one bit each; what stands there is not looked at.
    pub length_missing: u32,
    /// Missing tensions.
    pub tension_missing: u32,
    /// Missing azimuths.
    pub azimuth_missing: u32,
    /// Missing elevations.
    pub elevation_missing: u32,
    /// Missing axes of the gyroscope.
    pub gyroscope_missing: u32,
    /// Missing axes of the accelerometer.
    pub accelerometer_missing: u32,
    /// Missing coordinates of the tracked point.
    pub tracker_missing: u32,
    /// Zero.
    pub reserved: u32,
}

/// `fn_est_result`: state at the last time.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct EstResult {
    /// Size of the caller's struct in bytes.
    pub struct_size: u32,
    /// Number of values for which each array has room.
    pub cables: u32,
    /// One if the readings of the last half second fit their stated noise; otherwise all deviations are infinite.
    pub is_trusted: i32,
    /// One while the platform vibrates.
    pub rings: i32,
    /// Alarm of the last update, `FN_EST_…`; zero for none.
    pub alarm: i32,
    /// Cable of the alarm; −1 for none.
    pub alarm_cable: i32,
    /// Time since the start [s].
    pub time_s: f64,
    /// Position of the platform's origin [m].
    pub position_m: [f64; 3],
    /// Rotation from platform to world axes.
    pub quaternion_wxyz: [f64; 4],
    /// Deviation of the position [m].
    pub position_std_m: [f64; 3],
    /// Deviation of small turns about the world's axes [rad].
    pub rotation_std_rad: [f64; 3],
    /// Velocity of the origin [m/s].
    pub velocity_m_s: [f64; 3],
    /// Deviation of the velocity [m/s].
    pub velocity_std_m_s: [f64; 3],
    /// Angular velocity, world axes [rad/s].
    pub angular_velocity_rad_s: [f64; 3],
    /// Deviation of the angular velocity [rad/s].
    pub angular_velocity_std_rad_s: [f64; 3],
    /// External force besides the loads of the file, world axes [N].
    pub force_n: [f64; 3],
    /// Deviation of the force [N].
    pub force_std_n: [f64; 3],
    /// External moment about the origin, world axes [N m].
    pub moment_n_m: [f64; 3],
    /// Deviation of the moment [N m].
    pub moment_std_n_m: [f64; 3],
    /// Payload beyond the platform of the file [kg].
    pub payload_kg: f64,
    /// Deviation of the payload [kg].
    pub payload_std_kg: f64,
    /// First moment of the payload about the origin, platform axes [kg m].
    pub first_moment_kg_m: [f64; 3],
    /// Deviation of the first moment [kg m].
    pub first_moment_std_kg_m: [f64; 3],
    /// Tensions at drums or anchors [N].
    pub tension_n: *mut f64,
    /// Deviations of the tensions [N].
    pub tension_std_n: *mut f64,
    /// True lengths minus readings [m].
    pub offset_m: *mut f64,
    /// Deviations of these offsets [m].
    pub offset_std_m: *mut f64,
    /// Constant errors of the load cells [N].
    pub tension_bias_n: *mut f64,
    /// Deviations of these errors [N].
    pub tension_bias_std_n: *mut f64,
    /// Probability class: 1 slack, 0 taut, −1 unknown.
    pub slack: *mut f64,
}

/// `fn_est_fault`: one explanation of an alarm.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct EstFault {
    /// Kind, `FN_EST_…`.
    pub kind: i32,
    /// Cable; −1 for none.
    pub cable: i32,
    /// Slip [m], step of a load cell [N], payload [kg], force along z [N].
    pub size: f64,
    /// Deviation of the size.
    pub std: f64,
    /// Minus twice the logarithm of the likelihood, from the best.
    pub worse_by: f64,
}

zero_by_default! { EstReadings EstResult }

// SAFETY: integers and numbers only; the size comes first.
unsafe impl Sized32 for EstSettings {
    const LEAST: usize = size_of::<Self>();
}
// SAFETY: integers, numbers and pointers only; the size comes first.
unsafe impl Sized32 for EstReadings {
    const LEAST: usize = size_of::<Self>();
}
// SAFETY: the same.
unsafe impl Sized32 for EstResult {
    const LEAST: usize = std::mem::offset_of!(Self, tension_n);
}
