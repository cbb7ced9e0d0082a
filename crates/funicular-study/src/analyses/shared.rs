//! Rows that several commands share.

use funicular::cable::Sag;
use funicular::dynamics::Linearisation;
use funicular::statics::Equilibrium;
use serde::Serialize;

/// Models used for a result, by the names that JSON has.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Models {
    pub static_model: &'static str,
    pub cable_model: &'static str,
    pub assembly: &'static str,
    pub in_plane_only: bool,
}

impl Models {
    pub fn of(equilibrium: &Equilibrium, linearisation: Linearisation) -> Self {
        Self {
            static_model: equilibrium.model.name(),
            cable_model: linearisation.cable_model.name(),
            assembly: linearisation.assembly.name(),
            in_plane_only: linearisation.in_plane_only,
        }
    }

    /// Description in one line.
    pub fn line(&self) -> String {
        let plane = if self.in_plane_only { ", in plane only" } else { "" };
        format!("{} statics, {} cables, {} assembly{plane}", self.static_model, self.cable_model, self.assembly)
    }
}

/// Numbers of a cable's sag for JSON. They are absent for a cable without tension. The string frequency is also absent
/// for a cable without mass.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct SagNumbers {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sag_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lambda2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub string_frequency_hz: Option<f64>,
}

impl SagNumbers {
    pub fn of(sag: &Sag) -> Self {
        let taut = sag.tension > 0.0;
        Self {
            sag_ratio: taut.then(|| sag.ratio()),
            lambda2: taut.then_some(sag.lambda2),
            string_frequency_hz: taut.then(|| sag.string_frequency_hz()).filter(|f| f.is_finite()),
        }
    }
}
