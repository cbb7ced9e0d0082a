//! Contents of exact.json.

use super::independent::{Matrix, ReferenceResponse};
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads exact.json.
pub(in crate::validation) fn exact() -> Result<ExactReference> {
    serde_json::from_str(include_str!("../../../reference/exact.json")).context("exact.json")
}

/// Content of exact.json.
#[derive(Deserialize)]
pub(in crate::validation) struct ExactReference {
    #[serde(rename = "_about")]
    pub(in crate::validation) about: String,
    pub(in crate::validation) cables: Vec<ExactCable>,
    pub(in crate::validation) robots: Vec<ExactRobot>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ExactCable {
    pub(in crate::validation) id: String,
    pub(in crate::validation) start_m: [f64; 3],
    pub(in crate::validation) end_m: [f64; 3],
    pub(in crate::validation) unstrained_length_m: f64,
    pub(in crate::validation) axial_stiffness_n: f64,
    pub(in crate::validation) mass_kg_per_m: f64,
    pub(in crate::validation) gravity_m_s2: [f64; 3],
    pub(in crate::validation) clamped_in_plane_hz: Vec<f64>,
    pub(in crate::validation) clamped_out_of_plane_hz: Vec<f64>,
    pub(in crate::validation) end_stiffness: ExactStiffness,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ExactStiffness {
    pub(in crate::validation) frequency_hz: Vec<f64>,
    /// Stiffness of both ends, start first.
    pub(in crate::validation) undamped: Vec<Matrix>,
    /// Constant damping ratio of `xi_real` and `xi_imag`.
    pub(in crate::validation) xi: f64,
    pub(in crate::validation) xi_real: Vec<Matrix>,
    pub(in crate::validation) xi_imag: Vec<Matrix>,
    /// Viscous damping of `viscous_real` and `viscous_imag`.
    pub(in crate::validation) viscous_n_s_m2: f64,
    pub(in crate::validation) viscous_real: Vec<Matrix>,
    pub(in crate::validation) viscous_imag: Vec<Matrix>,
}

/// Robot of independent.json.
#[derive(Deserialize)]
pub(in crate::validation) struct ExactRobot {
    pub(in crate::validation) id: String,
    pub(in crate::validation) below_hz: f64,
    pub(in crate::validation) frequencies_hz: Vec<f64>,
    pub(in crate::validation) frf: ExactFrf,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ExactFrf {
    pub(in crate::validation) frequency_hz: Vec<f64>,
    #[serde(flatten)]
    pub(in crate::validation) response: ReferenceResponse,
}
