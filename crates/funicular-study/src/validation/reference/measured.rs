//! Contents of measured.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads measured.json.
pub(in crate::validation) fn measured() -> Result<MeasuredReference> {
    serde_json::from_str(include_str!("../../../reference/measured.json")).context("measured.json")
}

/// Content of measured.json.
#[derive(Deserialize)]
pub(in crate::validation) struct MeasuredReference {
    pub(in crate::validation) grab: ReferenceTable<MeasuredPose>,
}

/// Pose of a robot with measured natural frequencies.
#[derive(Deserialize)]
pub(in crate::validation) struct MeasuredPose {
    pub(in crate::validation) experiment: usize,
    pub(in crate::validation) cables: usize,
    pub(in crate::validation) position_m: [f64; 3],
    /// Angles of the rotation Rx(a) Ry(b) Rz(c).
    pub(in crate::validation) angles_xyz_rad: [f64; 3],
    pub(in crate::validation) lengths_m: Vec<f64>,
    /// Frequencies of the source's model, ascending.
    pub(in crate::validation) model_hz: Vec<f64>,
    /// Frequencies for fixed points instead of the pulleys, by a separate program, ascending.
    pub(in crate::validation) fixed_points_hz: Vec<f64>,
    /// Measured frequencies; `None` where no peak was found.
    pub(in crate::validation) measured_hz: Vec<Option<f64>>,
}
