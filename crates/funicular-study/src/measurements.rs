//! Measured responses, natural frequencies and time histories as plain data, and the accuracy of measurements that
//! state none.

use serde::{Deserialize, Serialize};

/// Standard deviation of each coordinate of a measured position that has none [m].
pub const POSITION_STD_M: f64 = 1e-3;
/// Standard deviation of a measured rotation about each axis that has none [degrees].
pub const ROTATION_STD_DEG: f64 = 0.1;
/// Standard deviation of measured lengths that have none [m].
pub const LENGTH_STD_M: f64 = 1e-3;
/// Standard deviation of measured tensions that have none, relative to the maximum tension.
pub const TENSION_STD: f64 = 0.01;

/// Measured frequency response: output per input at each frequency, e^{+iωt}.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredResponse {
    /// Name in messages, tables and figures.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Input signal, as `fz`.
    pub input: String,
    /// Point where the force acts, platform frame [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_point_m: Option<[f64; 3]>,
    /// Output signal, as `ay`.
    pub output: String,
    /// Point whose motion is measured, platform frame [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_point_m: Option<[f64; 3]>,
    /// Frequencies [Hz].
    pub frequency_hz: Vec<f64>,
    /// Real parts, in the SI unit of the output per input.
    pub real: Vec<f64>,
    /// Imaginary parts.
    pub imag: Vec<f64>,
    /// Standard deviations of the magnitude of the complex noise, √(E|n|²); each part has its half of the variance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std: Option<Vec<f64>>,
}

/// Measured time history: readings of sensors at common times.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredHistory {
    /// Name in messages and tables.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Times [s], ascending.
    pub time_s: Vec<f64>,
    /// Sensors.
    pub channels: Vec<MeasuredChannel>,
}

/// Readings of a sensor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredChannel {
    /// Name in messages and tables.
    pub name: String,
    /// Signal that the sensor measures, as `az`; absent if it is none of the robot's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Point where the sensor is, platform frame [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output_point_m: Option<[f64; 3]>,
    /// Readings, one per time, in the SI unit of the signal.
    pub values: Vec<f64>,
    /// Standard deviation of the noise, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std: Option<f64>,
}

/// Measured natural frequency.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredFrequency {
    /// Natural frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<f64>,
    /// Standard deviation of the damping ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_std: Option<f64>,
    /// Standard deviation of the frequency [Hz].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std_hz: Option<f64>,
    /// Weight: the variance is divided by it; 0 leaves the frequency out of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f64>,
    /// Number of the mode in the ascending list of the model, from 1, or any name. A frequency without a number is
    /// assigned to the nearest modes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

impl MeasuredFrequency {
    /// Number of the mode in the ascending list, from 1, if the label is one.
    pub fn number(&self) -> Option<usize> {
        self.label.as_ref()?.trim().parse().ok().filter(|number| *number > 0)
    }
}
