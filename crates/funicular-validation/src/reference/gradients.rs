//! Contents of gradients.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads gradients.json.
pub(crate) fn gradients() -> Result<GradientReference> {
    serde_json::from_str(include_str!("../../reference/gradients.json")).context("gradients.json")
}

/// Content of gradients.json.
#[derive(Deserialize)]
pub(crate) struct GradientReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<GradientRobot>,
}

#[derive(Deserialize)]
pub(crate) struct GradientRobot {
    pub(crate) id: String,
    pub(crate) toml: String,
    pub(crate) position_m: [f64; 3],
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) lengths_held: Vec<GradientRow>,
    pub(crate) pose_held: Vec<GradientRow>,
}

/// Derivatives of all results by one number of the robot.
#[derive(Deserialize)]
pub(crate) struct GradientRow {
    pub(crate) path: String,
    /// Translation and rotation vector, with the lengths held.
    pub(crate) pose: Option<Vec<f64>>,
    /// Unstrained lengths, with the pose held.
    pub(crate) lengths: Option<Vec<f64>>,
    pub(crate) tension_platform: Vec<f64>,
    pub(crate) tension_anchor: Vec<f64>,
    pub(crate) frequency_hz: Vec<f64>,
}
