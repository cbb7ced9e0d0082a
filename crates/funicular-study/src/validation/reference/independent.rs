//! Contents of independent.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads independent.json.
pub(in crate::validation) fn independent() -> Result<IndependentReference> {
    serde_json::from_str(include_str!("../../../reference/independent.json")).context("independent.json")
}

/// Content of independent.json.
#[derive(Deserialize)]
pub(in crate::validation) struct IndependentReference {
    #[serde(rename = "_about")]
    pub(in crate::validation) about: String,
    pub(in crate::validation) cases: Vec<IndependentRobot>,
}

pub(in crate::validation) type Matrix = [[f64; 6]; 6];

#[derive(Deserialize)]
pub(in crate::validation) struct IndependentRobot {
    pub(in crate::validation) id: String,
    pub(in crate::validation) toml: String,
    pub(in crate::validation) equilibrium: Equilibrium,
    pub(in crate::validation) spring: SpringEquilibrium,
    pub(in crate::validation) static_tangent_consistent: Matrix,
    pub(in crate::validation) static_tangent_paper: Matrix,
    pub(in crate::validation) closed_form_at_hz: f64,
    pub(in crate::validation) closed_form_consistent_undamped: Matrix,
    pub(in crate::validation) closed_form_paper_undamped: Matrix,
    pub(in crate::validation) closed_form_consistent_in_plane_only_undamped: Matrix,
    pub(in crate::validation) closed_form_consistent_damped: ComplexMatrix,
    pub(in crate::validation) modes: ModeList,
    pub(in crate::validation) modes_in_plane_only: ModeList,
    pub(in crate::validation) frf: ReferenceFrf,
    pub(in crate::validation) frf_offset: ReferenceFrfOffset,
}

#[derive(Deserialize)]
pub(in crate::validation) struct Equilibrium {
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) quaternion_wxyz: [f64; 4],
    pub(in crate::validation) cables: Vec<ReferenceCable>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ReferenceCable {
    pub(in crate::validation) tension_platform_n: f64,
    pub(in crate::validation) tension_anchor_n: f64,
    pub(in crate::validation) chord_m: f64,
    pub(in crate::validation) sag_ratio: f64,
    pub(in crate::validation) lambda2: f64,
    pub(in crate::validation) force_on_platform_n: [f64; 3],
}

#[derive(Deserialize)]
pub(in crate::validation) struct SpringEquilibrium {
    pub(in crate::validation) position_m: [f64; 3],
    pub(in crate::validation) tension_n: Vec<f64>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ComplexMatrix {
    pub(in crate::validation) real: Matrix,
    pub(in crate::validation) imag: Matrix,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ModeList {
    pub(in crate::validation) below_hz: f64,
    pub(in crate::validation) frequencies_hz: Vec<f64>,
    /// Frequencies of modes with the platform at rest, and the number of such modes at each.
    pub(in crate::validation) platform_at_rest: Vec<(f64, f64)>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ReferenceResponse {
    pub(in crate::validation) real: Vec<f64>,
    pub(in crate::validation) imag: Vec<f64>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ReferenceFrf {
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) ay: ReferenceResponse,
    pub(in crate::validation) az: ReferenceResponse,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ReferenceFrfOffset {
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) input_direction_w: [f64; 3],
    pub(in crate::validation) input_point_p: [f64; 3],
    pub(in crate::validation) output_direction_w: [f64; 3],
    pub(in crate::validation) output_point_p: [f64; 3],
    #[serde(flatten)]
    pub(in crate::validation) response: ReferenceResponse,
}
