//! Contents of sway.json.

use super::ChangedRobot;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads sway.json.
pub(crate) fn sway() -> Result<SwayReference> {
    serde_json::from_str(include_str!("../../reference/sway.json")).context("sway.json")
}

/// Content of sway.json.
#[derive(Deserialize)]
pub(crate) struct SwayReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<SwayingRobot>,
}

/// Free motion of the platform origin of a robot.
#[derive(Deserialize)]
pub(crate) struct SwayingRobot {
    pub(crate) id: String,
    #[serde(flatten)]
    pub(crate) changed: ChangedRobot,
    pub(crate) eta: f64,
    pub(crate) xi: f64,
    pub(crate) below_hz: f64,
    pub(crate) release: AfterRelease,
    pub(crate) stop: AfterStop,
    pub(crate) shaped: AfterShapedMove,
    pub(crate) relative_accuracy: f64,
}

#[derive(Deserialize)]
pub(crate) struct AfterRelease {
    pub(crate) force_n: [f64; 3],
    pub(crate) static_deflection_m: [f64; 3],
    pub(crate) amplitudes_m: Vec<f64>,
    pub(crate) position_at_1s_m: [f64; 3],
    pub(crate) settle: Vec<SettlingTimes>,
}

#[derive(Deserialize)]
pub(crate) struct AfterStop {
    pub(crate) rates_m_s: Vec<f64>,
    pub(crate) durations_s: Vec<f64>,
    pub(crate) amplitudes_m: Vec<f64>,
    pub(crate) sum_m: f64,
    pub(crate) position_1s_after_m: [f64; 3],
    /// Counted from the start of the stop.
    pub(crate) settle: Vec<SettlingTimes>,
}

/// Times from which on the point is within a tolerance: by the sum of all amplitudes, and exactly.
#[derive(Deserialize)]
pub(crate) struct SettlingTimes {
    pub(crate) tolerance_m: f64,
    pub(crate) bound_s: f64,
    pub(crate) exact_s: f64,
}

#[derive(Deserialize)]
pub(crate) struct AfterShapedMove {
    pub(crate) change_m: Vec<f64>,
    pub(crate) durations_s: Vec<f64>,
    pub(crate) amplitudes_m: Vec<f64>,
    pub(crate) tolerance_m: f64,
    pub(crate) shapers: Vec<ShapedSum>,
}

/// Sum of all amplitudes at the end, and times of settling from the end without the shaper.
#[derive(Deserialize)]
pub(crate) struct ShapedSum {
    pub(crate) shaper: String,
    pub(crate) modes_hz: Vec<f64>,
    pub(crate) sum_m: f64,
    pub(crate) bound_s: f64,
    pub(crate) exact_s: f64,
}
