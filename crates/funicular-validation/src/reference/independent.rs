//! Contents of independent.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads independent.json.
pub(crate) fn independent() -> Result<IndependentReference> {
    serde_json::from_str(include_str!("../../reference/independent.json")).context("independent.json")
}

/// Content of independent.json.
#[derive(Deserialize)]
pub(crate) struct IndependentReference {
    #[serde(rename = "_about")]
    pub(crate) about: String,
    pub(crate) cases: Vec<IndependentRobot>,
}

pub(crate) type Matrix = [[f64; 6]; 6];

#[derive(Deserialize)]
pub(crate) struct IndependentRobot {
    pub(crate) id: String,
    pub(crate) toml: String,
    pub(crate) equilibrium: Equilibrium,
    pub(crate) spring: SpringEquilibrium,
    pub(crate) static_tangent_consistent: Matrix,
    pub(crate) static_tangent_paper: Matrix,
    pub(crate) closed_form_at_hz: f64,
    pub(crate) closed_form_consistent_undamped: Matrix,
    pub(crate) closed_form_paper_undamped: Matrix,
    pub(crate) closed_form_consistent_in_plane_only_undamped: Matrix,
    pub(crate) closed_form_consistent_damped: ComplexMatrix,
    pub(crate) modes: ModeList,
    pub(crate) modes_in_plane_only: ModeList,
    pub(crate) frf: ReferenceFrf,
    pub(crate) frf_offset: ReferenceFrfOffset,
}

#[derive(Deserialize)]
pub(crate) struct Equilibrium {
    pub(crate) position_m: [f64; 3],
    pub(crate) quaternion_wxyz: [f64; 4],
    pub(crate) cables: Vec<ReferenceCable>,
}

#[derive(Deserialize)]
pub(crate) struct ReferenceCable {
    pub(crate) tension_platform_n: f64,
    pub(crate) tension_anchor_n: f64,
    pub(crate) chord_m: f64,
    pub(crate) sag_ratio: f64,
    pub(crate) lambda2: f64,
    pub(crate) force_on_platform_n: [f64; 3],
}

#[derive(Deserialize)]
pub(crate) struct SpringEquilibrium {
    pub(crate) position_m: [f64; 3],
    pub(crate) tension_n: Vec<f64>,
}

#[derive(Deserialize)]
pub(crate) struct ComplexMatrix {
    pub(crate) real: Matrix,
    pub(crate) imag: Matrix,
}

#[derive(Deserialize)]
pub(crate) struct ModeList {
    pub(crate) below_hz: f64,
    pub(crate) frequencies_hz: Vec<f64>,
    /// Frequencies of modes with the platform at rest, and the number of such modes at each.
    pub(crate) platform_at_rest: Vec<(f64, f64)>,
}

#[derive(Deserialize)]
pub(crate) struct ReferenceResponse {
    pub(crate) real: Vec<f64>,
    pub(crate) imag: Vec<f64>,
}

#[derive(Deserialize)]
pub(crate) struct ReferenceFrf {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) ay: ReferenceResponse,
    pub(crate) az: ReferenceResponse,
}

#[derive(Deserialize)]
pub(crate) struct ReferenceFrfOffset {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) input_direction_w: [f64; 3],
    pub(crate) input_point_p: [f64; 3],
    pub(crate) output_direction_w: [f64; 3],
    pub(crate) output_point_p: [f64; 3],
    #[serde(flatten)]
    pub(crate) response: ReferenceResponse,
}
