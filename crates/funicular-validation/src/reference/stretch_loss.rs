//! Contents of stretch_loss.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads stretch_loss.json.
pub(crate) fn stretch_loss() -> Result<StretchLossReference> {
    serde_json::from_str(include_str!("../../reference/stretch_loss.json")).context("stretch_loss.json")
}

/// Content of stretch_loss.json.
#[derive(Deserialize)]
pub(crate) struct StretchLossReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<LossyRobot>,
    pub(crate) ropes: Vec<LossyRope>,
}

/// Robot of the library with numbers that differ from its file.
#[derive(Deserialize)]
pub(crate) struct ChangedRobot {
    pub(crate) robot: String,
    pub(crate) axial_stiffness_n: Option<f64>,
    pub(crate) mass_kg_per_m: Option<f64>,
    pub(crate) platform_mass_kg: Option<f64>,
    pub(crate) unstrained_length_m: Option<Vec<f64>>,
}

/// Modes of a robot with loss of the stretch.
#[derive(Deserialize)]
pub(crate) struct LossyRobot {
    pub(crate) id: String,
    #[serde(flatten)]
    pub(crate) changed: ChangedRobot,
    pub(crate) eta: f64,
    pub(crate) tau_s: f64,
    pub(crate) xi: f64,
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) stretching_share: Vec<f64>,
    pub(crate) share_per_cable_mode_1: Vec<f64>,
    pub(crate) zeta_eta: Vec<f64>,
    pub(crate) frequency_eta_hz: Vec<f64>,
    pub(crate) zeta_eta_xi: Vec<f64>,
    pub(crate) zeta_kelvin_voigt: Vec<f64>,
    pub(crate) frequency_kelvin_voigt_hz: Vec<f64>,
    pub(crate) relative_accuracy: f64,
}

/// Stiffness of the platform end of one rope at a frequency: real and imaginary parts, world axes.
#[derive(Deserialize)]
pub(crate) struct LossyRope {
    pub(crate) id: String,
    #[serde(flatten)]
    pub(crate) changed: ChangedRobot,
    pub(crate) cable: usize,
    pub(crate) frequency_hz: f64,
    pub(crate) eta: f64,
    pub(crate) xi: f64,
    pub(crate) tau_s: f64,
    pub(crate) k_eta_xi: [[[f64; 3]; 3]; 2],
    pub(crate) k_kelvin_voigt_no_xi: [[[f64; 3]; 3]; 2],
    pub(crate) k_static_eta: [[[f64; 3]; 3]; 2],
}
