//! Requests about vibration.

use super::parts::{
    FrequencyRange, Model, OneOrSeveral, ResponsePoints, ResponseRange, RobotText, State, Tensions, Terms,
    platform_share,
};
use crate::names::ModelForm;
use serde::{Deserialize, Serialize};

/// Request of `modes`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModesRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz]. Default: slightly above the lowest ones, of which
    /// [`LOWEST`](crate::frequency_range::LOWEST) are shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below_hz: Option<f64>,
    /// Input of the response to which the modes contribute; needs an output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Output of that response; needs an input.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output: Option<String>,
    /// Points of that response.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// Number of points along every cable whose displacements in each mode are listed, ends included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stations: Option<usize>,
    /// Minimum fraction of the kinetic energy in the platform for the first mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Compute the damped mode of every undamped mode; otherwise damping ratios are of first order in the damping.
    #[serde(default = "enabled")]
    pub damped: bool,
    /// Cables that are rigid in length: the motions that they leave free.
    #[serde(default)]
    pub rigid_cables: bool,
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

/// Request of `frf`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrfRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Frequencies.
    #[serde(flatten)]
    pub range: ResponseRange,
    /// Add frequencies until every peak has its height and the drawn curve is accurate; so it is without a number of
    /// frequencies.
    #[serde(default)]
    pub adaptive: bool,
    /// Input signal, as `fz`, `cable:3@0.5:fz`, `length:3` or `base-x`, or a list of input signals.
    #[serde(default = "default_input")]
    pub input: OneOrSeveral,
    /// Output signal, as `ay`, `cable:3@0.5:az` or `tension:3`, or a list of output signals.
    #[serde(default = "default_output")]
    pub output: OneOrSeveral,
    /// Points of the platform.
    #[serde(flatten)]
    pub signal_points: ResponsePoints,
    /// Minimum height of a peak above the valleys beside it [dB].
    #[serde(default = "one")]
    pub prominence_db: f64,
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

/// Request of `compare`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompareRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Upper limit of the frequencies [Hz].
    pub below_hz: f64,
    /// Compare the modes of the platform alone.
    #[serde(default)]
    pub platform: bool,
    /// Minimum fraction of the kinetic energy in the platform for a mode of the platform.
    #[serde(default = "platform_share")]
    pub platform_share: f64,
    /// Maximum relative difference of frequency for a model that is good enough.
    #[serde(default = "one_per_cent")]
    pub tolerance: f64,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Terms of the stiffness.
    #[serde(flatten)]
    pub terms: Terms,
}

/// Request of `cable`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CableRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Name of the cable.
    pub name: String,
    /// Frequencies.
    #[serde(flatten)]
    pub range: FrequencyRange,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Cable model.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "crate::names::optional")]
    pub cable_model: Option<funicular::cable::CableModel>,
    /// Leave out the out-of-plane stiffness of the cable.
    #[serde(default)]
    pub in_plane_only: bool,
    /// Winches in vibration.
    #[serde(default, with = "crate::names")]
    pub winches: funicular::robot::WinchMode,
}

/// Request of `reduce`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReduceRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Highest frequency that the model is for [Hz].
    pub below_hz: f64,
    /// Input signals; an empty list stands for all forces and moments on the platform.
    #[serde(default)]
    pub input: Vec<String>,
    /// Output signals; an empty list stands for all displacements and rotations of the platform.
    #[serde(default)]
    pub output: Vec<String>,
    /// Points of the platform.
    #[serde(flatten)]
    pub points: ResponsePoints,
    /// Form of the model.
    #[serde(default, with = "crate::names")]
    pub form: ModelForm,
    /// Maximum number of states of a state space, instead of a tolerance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<usize>,
    /// Maximum error of a response relative to its peak (0.01 if neither tolerance nor order is given); for the
    /// second-order form the maximum relative error due to omitted modes (0.001).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Frequency at which viscous damping reproduces constant damping ratios [Hz].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_at_hz: Option<f64>,
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

/// Input of a response that names none: a vertical force on the platform.
pub const DEFAULT_INPUT: &str = "fz";

/// Output of a response that names none: the vertical acceleration of the platform, which sensors measure.
pub const DEFAULT_OUTPUT: &str = "az";

fn default_input() -> OneOrSeveral {
    OneOrSeveral::One(DEFAULT_INPUT.to_owned())
}

fn default_output() -> OneOrSeveral {
    OneOrSeveral::One(DEFAULT_OUTPUT.to_owned())
}

impl FrfRequest {
    /// True if frequencies are added until every peak has its height.
    pub fn is_adaptive(&self) -> bool {
        self.adaptive || self.range.points.is_none()
    }
}

fn one() -> f64 {
    1.0
}

fn enabled() -> bool {
    true
}

fn one_per_cent() -> f64 {
    funicular::compare::TOLERANCE
}
