//! Requests about the robot file and the robot at rest.

use super::parts::{Model, Pose, RobotText, State, Tensions};
use serde::{Deserialize, Serialize};

/// Request of `check`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckRequest {
    /// Robot file.
    pub robot: RobotText,
}

/// Request of `parameters`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParametersRequest {
    /// Robot file.
    pub robot: RobotText,
}

/// Request of `statics`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticsRequest {
    /// Robot file.
    pub robot: RobotText,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Search for all equilibria of the unstrained lengths.
    #[serde(default)]
    pub all: bool,
    /// Interval in which friction of pulleys leaves pose and tensions.
    #[serde(default)]
    pub friction_interval: bool,
}

/// Request of `stiffness`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StiffnessRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Frequency [Hz]; at 0 the tangent of the static model unless a cable model is named.
    #[serde(default)]
    pub at_hz: f64,
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

/// Request of `payload`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PayloadRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Centre of mass of the payload, platform frame [m]. Default: that of the platform.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_center_m: Option<[f64; 3]>,
    /// State and loads.
    #[serde(flatten)]
    pub state: State,
    /// Rule and limits of tensions. The rule only chooses the lengths of a pose that are held; the payload is the
    /// extreme one of all tensions within the limits.
    #[serde(flatten)]
    pub tensions: Tensions,
}

/// Request of `pose-error`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PoseErrorRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Platform masses: first [kg], last [kg], number of them in equal steps.
    pub mass_kg: (f64, f64, usize),
    /// Unstrained lengths [m], one per cable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lengths_m: Option<Vec<f64>>,
    /// Pose whose unstrained lengths are held: those with which the robot of the file rests there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// Rule and limits of the tensions at this pose.
    #[serde(flatten)]
    pub tensions: Tensions,
    /// Maximum distance between spring pose and catenary pose at which springs are good enough [mm].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_mm: Option<f64>,
}
