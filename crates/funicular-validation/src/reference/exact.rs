//! Contents of exact.json.

use super::independent::{Matrix, ReferenceResponse};
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads exact.json.
pub(crate) fn exact() -> Result<ExactReference> {
    serde_json::from_str(include_str!("../../reference/exact.json")).context("exact.json")
}

/// Content of exact.json.
#[derive(Deserialize)]
pub(crate) struct ExactReference {
    #[serde(rename = "_about")]
    pub(crate) about: String,
    pub(crate) cables: Vec<ExactCable>,
    pub(crate) robots: Vec<ExactRobot>,
}

#[derive(Deserialize)]
pub(crate) struct ExactCable {
    pub(crate) id: String,
    pub(crate) start_m: [f64; 3],
    pub(crate) end_m: [f64; 3],
    pub(crate) unstrained_length_m: f64,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) gravity_m_s2: [f64; 3],
    pub(crate) clamped_in_plane_hz: Vec<f64>,
    pub(crate) clamped_out_of_plane_hz: Vec<f64>,
    pub(crate) end_stiffness: ExactStiffness,
}

#[derive(Deserialize)]
pub(crate) struct ExactStiffness {
    pub(crate) frequency_hz: Vec<f64>,
    /// Stiffness of both ends, start first.
    pub(crate) undamped: Vec<Matrix>,
    /// Constant damping ratio of `xi_real` and `xi_imag`.
    pub(crate) xi: f64,
    pub(crate) xi_real: Vec<Matrix>,
    pub(crate) xi_imag: Vec<Matrix>,
    /// Viscous damping of `viscous_real` and `viscous_imag`.
    pub(crate) viscous_n_s_m2: f64,
    pub(crate) viscous_real: Vec<Matrix>,
    pub(crate) viscous_imag: Vec<Matrix>,
}

/// Robot of independent.json.
#[derive(Deserialize)]
pub(crate) struct ExactRobot {
    pub(crate) id: String,
    pub(crate) below_hz: f64,
    pub(crate) frequencies_hz: Vec<f64>,
    pub(crate) frf: ExactFrf,
}

#[derive(Deserialize)]
pub(crate) struct ExactFrf {
    pub(crate) frequency_hz: Vec<f64>,
    #[serde(flatten)]
    pub(crate) response: ReferenceResponse,
}
