//! Contents of stretch_loss.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads stretch_loss.json.
pub(in crate::validation) fn stretch_loss() -> Result<StretchLossReference> {
    serde_json::from_str(include_str!("../../../reference/stretch_loss.json")).context("stretch_loss.json")
}

/// Content of stretch_loss.json.
#[derive(Deserialize)]
pub(in crate::validation) struct StretchLossReference {
    pub(in crate::validation) source: String,
    pub(in crate::validation) robots: Vec<LossyRobot>,
    pub(in crate::validation) ropes: Vec<LossyRope>,
}

/// Robot of the library with numbers that differ from its file.
#[derive(Deserialize)]
pub(in crate::validation) struct ChangedRobot {
    pub(in crate::validation) robot: String,
    pub(in crate::validation) axial_stiffness_n: Option<f64>,
    pub(in crate::validation) mass_kg_per_m: Option<f64>,
    pub(in crate::validation) platform_mass_kg: Option<f64>,
    pub(in crate::validation) unstrained_length_m: Option<Vec<f64>>,
}

/// Modes of a robot with loss of the stretch.
#[derive(Deserialize)]
pub(in crate::validation) struct LossyRobot {
    pub(in crate::validation) id: String,
    #[serde(flatten)]
    pub(in crate::validation) changed: ChangedRobot,
    pub(in crate::validation) eta: f64,
    pub(in crate::validation) tau_s: f64,
    pub(in crate::validation) xi: f64,
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) stretching_share: Vec<f64>,
    pub(in crate::validation) share_per_cable_mode_1: Vec<f64>,
    pub(in crate::validation) zeta_eta: Vec<f64>,
    pub(in crate::validation) frequency_eta_hz: Vec<f64>,
    pub(in crate::validation) zeta_eta_xi: Vec<f64>,
    pub(in crate::validation) zeta_kelvin_voigt: Vec<f64>,
    pub(in crate::validation) frequency_kelvin_voigt_hz: Vec<f64>,
    pub(in crate::validation) relative_accuracy: f64,
}

/// Stiffness of the platform end of one rope at a frequency: real and imaginary parts, world axes.
#[derive(Deserialize)]
pub(in crate::validation) struct LossyRope {
    pub(in crate::validation) id: String,
    #[serde(flatten)]
    pub(in crate::validation) changed: ChangedRobot,
    pub(in crate::validation) cable: usize,
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) eta: f64,
    pub(in crate::validation) xi: f64,
    pub(in crate::validation) tau_s: f64,
    pub(in crate::validation) k_eta_xi: [[[f64; 3]; 3]; 2],
    pub(in crate::validation) k_kelvin_voigt_no_xi: [[[f64; 3]; 3]; 2],
    pub(in crate::validation) k_static_eta: [[[f64; 3]; 3]; 2],
}
