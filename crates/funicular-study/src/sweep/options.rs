//! Options of the evaluation of every point of a map or sweep.

use crate::request::MAX_HZ;
use funicular::dynamics::Linearisation;
use funicular::math::Vec3;
use funicular::modes::PLATFORM_SHARE;
use funicular::statics::{StaticModel, TensionRule};

/// Options of the evaluation of every point.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Static model of the cables.
    pub static_model: StaticModel,
    /// Rule for the tensions at a pose, for robots with more cables than degrees of freedom.
    pub tension_rule: TensionRule,
    /// Linearisation for natural frequencies.
    pub linearisation: Linearisation,
    /// Upper limit of the search for natural frequencies [Hz].
    pub highest_hz: f64,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    pub platform_share: f64,
    /// Centre of mass of the payload, platform frame [m]; `None` for that of the platform.
    pub payload_center_p: Option<Vec3>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            static_model: StaticModel::default(),
            tension_rule: TensionRule::default(),
            linearisation: Linearisation::default(),
            highest_hz: MAX_HZ,
            platform_share: PLATFORM_SHARE,
            payload_center_p: None,
        }
    }
}
