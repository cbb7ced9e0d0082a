//! Contents of load_factors.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads load_factors.json.
pub(crate) fn load_factors() -> Result<LoadFactorReference> {
    serde_json::from_str(include_str!("../../reference/load_factors.json")).context("load_factors.json")
}

/// Content of load_factors.json.
#[derive(Deserialize)]
pub(crate) struct LoadFactorReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<LoadedRobot>,
}

/// Robot of the library with limits and a required box of loads.
#[derive(Deserialize)]
pub(crate) struct LoadedRobot {
    pub(crate) id: String,
    pub(crate) robot: String,
    pub(crate) static_model: String,
    pub(crate) tension_limits_n: [f64; 2],
    /// Half widths of force and moment.
    pub(crate) required_box_n_nm: [f64; 6],
    pub(crate) mass_kg_per_m: Option<f64>,
    pub(crate) rows: Vec<LoadedPose>,
}

/// Measures of a pose: position [m] and roll, pitch, yaw [degrees].
#[derive(Deserialize)]
pub(crate) struct LoadedPose {
    pub(crate) pose: [f64; 6],
    pub(crate) tension_factor: Option<f64>,
    pub(crate) closure: Option<bool>,
    /// Absent if the dead load is not held.
    pub(crate) load_factor: Option<f64>,
}
