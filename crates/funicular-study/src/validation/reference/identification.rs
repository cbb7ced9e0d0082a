//! Contents of identification.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads identification.json.
pub(in crate::validation) fn identification() -> Result<IdentificationReference> {
    serde_json::from_str(include_str!("../../../reference/identification.json")).context("identification.json")
}

/// Content of identification.json.
#[derive(Deserialize)]
pub(in crate::validation) struct IdentificationReference {
    pub(in crate::validation) responses: MeasuredResponses,
    pub(in crate::validation) makers: ReferenceTable<PlatformOfMakers>,
}

/// Responses with noise and the values that they have.
#[derive(Deserialize)]
pub(in crate::validation) struct MeasuredResponses {
    pub(in crate::validation) source: String,
    pub(in crate::validation) from_hz: f64,
    pub(in crate::validation) step_hz: f64,
    pub(in crate::validation) input: String,
    pub(in crate::validation) input_point_m: [f64; 3],
    pub(in crate::validation) output_point_m: [f64; 3],
    pub(in crate::validation) values: Vec<TrueValue>,
    pub(in crate::validation) outputs: Vec<MeasuredOutput>,
}

/// Value of a robot file: start of the search, and the value with which the responses were made.
#[derive(Deserialize)]
pub(in crate::validation) struct TrueValue {
    pub(in crate::validation) path: String,
    pub(in crate::validation) start: f64,
    pub(in crate::validation) truth: f64,
}

#[derive(Deserialize)]
pub(in crate::validation) struct MeasuredOutput {
    pub(in crate::validation) output: String,
    pub(in crate::validation) real: Vec<f64>,
    pub(in crate::validation) imag: Vec<f64>,
}

/// Platform as its makers identified it, for a mass of 1 kg.
#[derive(Deserialize)]
pub(in crate::validation) struct PlatformOfMakers {
    pub(in crate::validation) set: String,
    pub(in crate::validation) com_m: [f64; 3],
    /// Moments xx, yy, zz about the origin.
    pub(in crate::validation) inertia_at_origin_kg_m2: [f64; 3],
}
