//! Contents of strings.json.

use super::ReferenceTable;
use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads strings.json.
pub(crate) fn strings() -> Result<StringReference> {
    serde_json::from_str(include_str!("../../reference/strings.json")).context("strings.json")
}

/// Content of strings.json.
#[derive(Deserialize)]
pub(crate) struct StringReference {
    pub(crate) strings: StringTable,
    pub(crate) cooled: CooledCable,
    pub(crate) cabledyn: ClampedTable,
}

#[derive(Deserialize)]
pub(crate) struct StringTable {
    pub(crate) rows: Vec<TautString>,
}

/// String without sag, in pounds, inches and seconds, as published.
#[derive(Deserialize)]
pub(crate) struct TautString {
    pub(crate) id: String,
    pub(crate) source: String,
    pub(crate) length_in: f64,
    pub(crate) area_in2: f64,
    pub(crate) youngs_modulus_lb_per_in2: f64,
    pub(crate) density_lb_s2_per_in4: f64,
    pub(crate) initial_strain: Option<f64>,
    pub(crate) tension_lb: Option<f64>,
    pub(crate) closed_form_hz: [f64; 3],
    pub(crate) printed_hz: [f64; 3],
    /// Relative size of the last digit of the printed frequencies, or what the source rounds before it.
    pub(crate) printed_relative: f64,
    pub(crate) closed_form_tension_lb: f64,
    pub(crate) printed_tension_lb: f64,
}

/// Straight cable between fixed ends that cools.
#[derive(Deserialize)]
pub(crate) struct CooledCable {
    pub(crate) source: String,
    pub(crate) youngs_modulus_n_per_mm2: f64,
    pub(crate) expansion_per_k: f64,
    pub(crate) area_mm2: f64,
    pub(crate) rows: Vec<CooledRow>,
}

#[derive(Deserialize)]
pub(crate) struct CooledRow {
    pub(crate) cooled_by_k: f64,
    pub(crate) tension_n: f64,
}

#[derive(Deserialize)]
pub(crate) struct ClampedTable {
    /// Source of the exact values.
    pub(crate) exact_source: String,
    #[serde(flatten)]
    pub(crate) table: ReferenceTable<ClampedCable>,
}

/// Sagging cable with held ends.
#[derive(Deserialize)]
pub(crate) struct ClampedCable {
    pub(crate) case: String,
    pub(crate) chord_m: f64,
    pub(crate) inclination_deg: f64,
    pub(crate) axial_stiffness_n: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) gravity_m_s2: f64,
    pub(crate) unstrained_length_m: f64,
    pub(crate) horizontal_force_n: f64,
    pub(crate) vertical_force_at_end_n: f64,
    pub(crate) exact_in_plane_rad_per_s: Vec<f64>,
    pub(crate) exact_out_of_plane_rad_per_s: Vec<f64>,
    pub(crate) cabledyn_in_plane_rad_per_s: Vec<f64>,
    pub(crate) cabledyn_out_of_plane_rad_per_s: Vec<f64>,
}
