//! Request of derivatives.

use super::parts::{Model, ResponsePoints, RobotText, State, Tensions};
use crate::names::Per;
use funicular::gradient::Hold;
use serde::{Deserialize, Serialize};

/// Request of `gradient`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GradientRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Groups of results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`.
    #[serde(default = "frequencies")]
    pub of: Vec<String>,
    /// Paths of the numbers of the robot file, in which `*` stands for any key; without any all numbers.
    #[serde(default)]
    pub by: Vec<String>,
    /// Quantity that is held while a number changes.
    #[serde(default, with = "crate::names")]
    pub hold: Hold,
    /// Unit of the derivatives.
    #[serde(default, with = "crate::names")]
    pub per: Per,
    /// Tolerances of numbers, as `PATH=VALUE` or `PATH=PERCENT%`; numbers without one have the usual tolerance.
    #[serde(default)]
    pub tolerances: Vec<String>,
    /// Upper limit of the frequencies [Hz]; for frequencies and damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below_hz: Option<f64>,
    /// Frequency of the response [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_hz: Option<f64>,
    /// Input of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Output of the response.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of the response.
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

/// Results that are differentiated if a request names none.
pub fn frequencies() -> Vec<String> {
    vec!["frequencies".to_owned()]
}
