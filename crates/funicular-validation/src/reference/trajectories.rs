//! Motions along paths, computed by another program.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads trajectories.json.
pub(crate) fn trajectories() -> Result<TrajectoryReference> {
    serde_json::from_str(include_str!("../../reference/trajectories.json")).context("trajectories.json")
}

/// Content of trajectories.json.
#[derive(Deserialize)]
pub(crate) struct TrajectoryReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<MovingRobot>,
}

/// Robot of the library with limits, on the path of the source.
#[derive(Deserialize)]
pub(crate) struct MovingRobot {
    pub(crate) robot: String,
    pub(crate) tension_limits_n: [f64; 2],
    /// Factor of positions and angles of the path, and height added to it [m].
    pub(crate) scale: f64,
    pub(crate) lift_m: f64,
    pub(crate) rows: Vec<MovingRow>,
}

/// Robot at a time.
#[derive(Deserialize)]
pub(crate) struct MovingRow {
    pub(crate) t_s: f64,
    /// Position [m] and roll, pitch, yaw [degrees].
    pub(crate) pose: [f64; 6],
    pub(crate) twist: [f64; 6],
    pub(crate) acceleration: [f64; 6],
    pub(crate) lengths_m: Vec<f64>,
    pub(crate) rates_m_s: Vec<f64>,
    pub(crate) tensions_platform_n: Vec<f64>,
    pub(crate) tensions_anchor_n: Vec<f64>,
    /// Power at the anchor, positive while a cable is wound in [W].
    pub(crate) powers_w: Vec<f64>,
}
