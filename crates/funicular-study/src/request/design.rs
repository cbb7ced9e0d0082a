//! Request of `design`: values of the robot file to be chosen, and what they have to achieve.

use super::parts::{Model, RobotText, State, Tensions};
use crate::names::DesignGoal;
use serde::{Deserialize, Serialize};

/// Request of `design`: values of the robot file with which the robot is best at several poses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Values to choose.
    pub change: Vec<ChangeValue>,
    /// Goal of the design.
    #[serde(default, with = "crate::names")]
    pub goal: DesignGoal,
    /// Poses: position [m] and roll, pitch, yaw [degrees]; default the pose of the state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poses: Option<Vec<[f64; 6]>>,
    /// Weights of the poses, for their mean instead of the worst pose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// Minimum of the first natural frequency at every pose [Hz].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_frequency_hz: Option<f64>,
    /// Minimum of the minimum stiffness at every pose [N/m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_stiffness_n_per_m: Option<f64>,
    /// Band without natural frequencies: first and last frequency [Hz].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avoid_hz: Option<[f64; 2]>,
    /// Maximum number of iterations.
    #[serde(default = "fifty")]
    pub max_iterations: usize,
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

/// Value of the robot file to choose, with its bounds.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangeValue {
    /// Path of the value; `*` stands for every name, and a vector without a component for all its components.
    pub path: String,
    /// Minimum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Maximum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// Largest change to both sides, instead of minimum and maximum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plus_minus: Option<f64>,
}

fn fifty() -> usize {
    50
}
