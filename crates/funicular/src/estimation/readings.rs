//! Readings of all sensors at one time.

use crate::control_loop::MAX_CABLES;

/// Readings of one time; a reading that is not there is NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorReadings {
    /// Unstrained lengths from attachments to drums by the encoders [m].
    pub lengths: [f64; MAX_CABLES],
    /// Tensions at drums or anchors [N].
    pub tensions: [f64; MAX_CABLES],
    /// Direction in which each cable leaves its anchor: azimuth about z from x, and elevation [rad].
    pub angles: [[f64; 2]; MAX_CABLES],
    /// Angular velocity in platform axes [rad/s].
    pub gyroscope: [f64; 3],
    /// Specific force in platform axes [m/s²]: at rest minus gravity.
    pub accelerometer: [f64; 3],
    /// Position of the tracked point in the world [m].
    pub tracker: [f64; 3],
}

impl Default for SensorReadings {
    fn default() -> Self {
        Self {
            lengths: [f64::NAN; MAX_CABLES],
            tensions: [f64::NAN; MAX_CABLES],
            angles: [[f64::NAN; 2]; MAX_CABLES],
            gyroscope: [f64::NAN; 3],
            accelerometer: [f64::NAN; 3],
            tracker: [f64::NAN; 3],
        }
    }
}

/// Kind of sensor, whose readings of one time are one group of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SensorGroup {
    /// Load cells.
    Tensions,
    /// Directions of the cables at their anchors.
    Angles,
    /// Gyroscope.
    Gyroscope,
    /// Accelerometer, as direction of gravity.
    Accelerometer,
    /// Tracked point.
    Tracker,
}

impl SensorGroup {
    /// All groups in the order of their updates.
    pub const ALL: [Self; 5] = [Self::Tensions, Self::Angles, Self::Gyroscope, Self::Accelerometer, Self::Tracker];

    /// Place in lists over all groups.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name in plain words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tensions => "load cells",
            Self::Angles => "cable angles",
            Self::Gyroscope => "gyroscope",
            Self::Accelerometer => "accelerometer",
            Self::Tracker => "tracker",
        }
    }
}
