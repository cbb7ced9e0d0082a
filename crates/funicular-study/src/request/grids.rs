//! Requests over many poses or values of the robot file, and about their files.

use super::parts::{Axis, EachPoint, RobotText};
use serde::{Deserialize, Serialize};

/// Request of `map`: quantities over poses, from a grid or a list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Axes of the grid, each once. An axis that is left out keeps the value of the state.
    #[serde(default)]
    pub grid: Vec<Axis>,
    /// List of poses instead of a grid: position [m] and roll, pitch, yaw [degrees].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poses: Option<Vec<[f64; 6]>>,
    /// Quantities and options of every point.
    #[serde(flatten)]
    pub point: EachPoint,
}

/// Request of `sweep`: quantities over all combinations of values of the robot file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepRequest {
    /// Robot file.
    pub robot: RobotText,
    /// Values of the robot file that vary, each an axis named by its path. The first axis runs fastest.
    pub vary: Vec<Axis>,
    /// Quantities and options of every point.
    #[serde(flatten)]
    pub point: EachPoint,
}

/// Request of `merge`; only a front end with a disk can run it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MergeRequest {
    /// Paths of the parts.
    pub parts: Vec<String>,
}

/// Request of `plot`; only a front end with a disk can run it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlotRequest {
    /// Path of the file of a map or sweep.
    pub file: String,
}
