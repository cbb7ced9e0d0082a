//! Contents of gradients.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads gradients.json.
pub(in crate::validation) fn gradients() -> Result<GradientReference> {
    serde_json::from_str(include_str!("../../../reference/gradients.json")).context("gradients.json")
}

/// Content of gradients.json.
#[derive(Deserialize)]
pub(in crate::validation) struct GradientReference {
    pub(in crate::validation) source: String,
    pub(in crate::validation) robots: Vec<GradientRobot>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct GradientRobot {
    pub(in crate::validation) id: String,
    pub(in crate::validation) toml: String,
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) lengths_held: Vec<GradientRow>,
    pub(in crate::validation) pose_held: Vec<GradientRow>,
}

/// Derivatives of all results by one number of the robot.
#[derive(Deserialize)]
pub(in crate::validation) struct GradientRow {
    pub(in crate::validation) path: String,
    /// Translation and rotation vector, with the lengths held.
    pub(in crate::validation) pose: Option<Vec<f64>>,
    /// Unstrained lengths, with the pose held.
    pub(in crate::validation) lengths: Option<Vec<f64>>,
    pub(in crate::validation) tension_platform: Vec<f64>,
    pub(in crate::validation) tension_anchor: Vec<f64>,
    pub(in crate::validation) frequency_hz: Vec<f64>,
}
