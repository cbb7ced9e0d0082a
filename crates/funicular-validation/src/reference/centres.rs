//! Contents of centres.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Reads centres.json.
pub(crate) fn centres() -> Result<ReferenceTable<CentreRow>> {
    serde_json::from_str(include_str!("../../reference/centres.json")).context("centres.json")
}

/// Reads centre_lengths.json.
pub(crate) fn centre_lengths() -> Result<ReferenceTable<LengthsAtCentre>> {
    serde_json::from_str(include_str!("../../reference/centre_lengths.json")).context("centre_lengths.json")
}

/// Unstrained lengths of CoGiRo by the centre of the tensions at a position.
#[derive(Deserialize)]
pub(crate) struct LengthsAtCentre {
    pub(crate) position_m: [f64; 3],
    pub(crate) unstrained_length_m: Vec<f64>,
}

/// Centre of the tensions of a robot of the library at a pose.
#[derive(Deserialize)]
pub(crate) struct CentreRow {
    pub(crate) robot: String,
    /// Position [m] and roll, pitch, yaw [degrees].
    pub(crate) pose: [f64; 6],
    pub(crate) minimum_tension_n: Option<f64>,
    pub(crate) maximum_tension_n: Option<f64>,
    pub(crate) mass_kg: Option<f64>,
    /// Force and moment about the origin of the platform, world axes.
    pub(crate) load_n_nm: Option<[f64; 6]>,
    /// Tensions parallel to the chords and their limits.
    pub(crate) tau_n: Vec<f64>,
    pub(crate) lower_n: Vec<f64>,
    pub(crate) upper_n: Vec<f64>,
    pub(crate) unstrained_length_m: Vec<f64>,
    pub(crate) tension_platform_n: Vec<f64>,
    /// Derivatives of the unstrained lengths by numbers of the robot and of the pose.
    #[serde(default)]
    pub(crate) length_by: BTreeMap<String, Vec<f64>>,
}
