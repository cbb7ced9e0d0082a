//! Contents of identification.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads identification.json.
pub(crate) fn identification() -> Result<IdentificationReference> {
    serde_json::from_str(include_str!("../../reference/identification.json")).context("identification.json")
}

/// Content of identification.json.
#[derive(Deserialize)]
pub(crate) struct IdentificationReference {
    pub(crate) responses: MeasuredResponses,
    pub(crate) makers: ReferenceTable<PlatformOfMakers>,
}

/// Responses with noise and the values that they have.
#[derive(Deserialize)]
pub(crate) struct MeasuredResponses {
    pub(crate) source: String,
    pub(crate) from_hz: f64,
    pub(crate) step_hz: f64,
    pub(crate) input: String,
    pub(crate) input_point_m: [f64; 3],
    pub(crate) output_point_m: [f64; 3],
    pub(crate) values: Vec<TrueValue>,
    pub(crate) outputs: Vec<MeasuredOutput>,
}

/// Value of a robot file: start of the search, and the value with which the responses were made.
#[derive(Deserialize)]
pub(crate) struct TrueValue {
    pub(crate) path: String,
    pub(crate) start: f64,
    pub(crate) truth: f64,
}

#[derive(Deserialize)]
pub(crate) struct MeasuredOutput {
    pub(crate) output: String,
    pub(crate) real: Vec<f64>,
    pub(crate) imag: Vec<f64>,
}

/// Platform as its makers identified it, for a mass of 1 kg.
#[derive(Deserialize)]
pub(crate) struct PlatformOfMakers {
    pub(crate) set: String,
    pub(crate) com_m: [f64; 3],
    /// Moments xx, yy, zz about the origin.
    pub(crate) inertia_at_origin_kg_m2: [f64; 3],
}
