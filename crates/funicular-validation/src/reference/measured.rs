//! Contents of measured.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads measured.json.
pub(crate) fn measured() -> Result<MeasuredReference> {
    serde_json::from_str(include_str!("../../reference/measured.json")).context("measured.json")
}

/// Content of measured.json.
#[derive(Deserialize)]
pub(crate) struct MeasuredReference {
    pub(crate) grab: ReferenceTable<MeasuredPose>,
}

/// Pose of a robot with measured natural frequencies.
#[derive(Deserialize)]
pub(crate) struct MeasuredPose {
    pub(crate) experiment: usize,
    pub(crate) cables: usize,
    pub(crate) position_m: [f64; 3],
    /// Angles of the rotation Rx(a) Ry(b) Rz(c).
    pub(crate) angles_xyz_rad: [f64; 3],
    pub(crate) lengths_m: Vec<f64>,
    /// Frequencies of the source's model, ascending.
    pub(crate) model_hz: Vec<f64>,
    /// Frequencies for fixed points instead of the pulleys, by a separate program, ascending.
    pub(crate) fixed_points_hz: Vec<f64>,
    /// Measured frequencies; `None` where no peak was found.
    pub(crate) measured_hz: Vec<Option<f64>>,
    /// Frequencies that a separate fit finds in the same records; `None` where it is not trusted.
    pub(crate) refitted_hz: Vec<Option<f64>>,
}
