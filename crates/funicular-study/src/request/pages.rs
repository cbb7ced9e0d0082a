//! Requests of pages, and of the comparison with published numbers.

use super::parts::{Model, ResponsePoints, RobotText, State, Tensions, platform_share};
use serde::{Deserialize, Serialize};

/// Request of `report`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz].
    #[serde(default = "twenty")]
    pub below_hz: f64,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Force or moment of the response. Default: `fz`, or `fx` if the platform cannot move along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Motion of the response. Default: `az`, or `ax` if the platform cannot move along z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of the platform.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Linearisation.
    #[serde(flatten)]
    pub model: Model,
}

/// Request of `live`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LiveRequest {
    /// Robot file.
    pub robot: RobotText,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Linearisation.
    #[serde(flatten)]
    pub model: Model,
}

/// Request of `paper`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PaperRequest {}

/// Request of `validate`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ValidateRequest {}

fn twenty() -> f64 {
    20.0
}
