//! reference/time_histories.json: large motion in time, computed by two methods.

use anyhow::{Context, Result};
use serde::Deserialize;

#[derive(Deserialize)]
pub(crate) struct HistoryReference {
    pub(crate) about: String,
    pub(crate) cases: Vec<HistoryCase>,
}

#[derive(Deserialize)]
pub(crate) struct HistoryCase {
    pub(crate) id: String,
    pub(crate) about: String,
    pub(crate) gravity_m_s2: [f64; 3],
    pub(crate) platform: HistoryPlatform,
    pub(crate) cables: Vec<HistoryCable>,
    pub(crate) tau_s: f64,
    pub(crate) cv_n_s_m2: f64,
    pub(crate) length_ramps: Option<LengthRamps>,
    pub(crate) samples: Vec<HistorySample>,
    pub(crate) slack: Option<FirstSlack>,
}

#[derive(Deserialize)]
pub(crate) struct HistoryPlatform {
    pub(crate) mass_before_kg: f64,
    pub(crate) mass_after_kg: f64,
    pub(crate) inertia_kg_m2: [[f64; 3]; 3],
}

#[derive(Deserialize)]
pub(crate) struct HistoryCable {
    pub(crate) anchor_m: [f64; 3],
    pub(crate) attachment_m: [f64; 3],
    pub(crate) axial_stiffness_n: f64,
    pub(crate) mass_kg_per_m: f64,
    pub(crate) unstrained_length_m: f64,
}

/// Changes of length, one row for each cable: beginning, end [s] and change [m].
#[derive(Deserialize)]
pub(crate) struct LengthRamps {
    pub(crate) t0_t1_dl: Vec<[f64; 3]>,
}

#[derive(Deserialize)]
pub(crate) struct HistorySample {
    pub(crate) t_s: f64,
    pub(crate) position_m: [f64; 3],
    pub(crate) tension_platform_n: Vec<f64>,
    pub(crate) bound_position_m: f64,
    pub(crate) bound_tension_n: Vec<f64>,
}

#[derive(Deserialize)]
pub(crate) struct FirstSlack {
    pub(crate) first_below_half_newton_s: Vec<f64>,
    pub(crate) first_slack_bound_s: f64,
}

pub(crate) fn histories() -> Result<HistoryReference> {
    serde_json::from_str(include_str!("../../reference/time_histories.json")).context("reference/time_histories.json")
}
