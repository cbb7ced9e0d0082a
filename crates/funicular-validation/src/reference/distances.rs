//! Contents of distances.json.

use anyhow::{Context, Result};
use serde::Deserialize;

/// Reads distances.json.
pub(crate) fn distances() -> Result<DistanceReference> {
    serde_json::from_str(include_str!("../../reference/distances.json")).context("distances.json")
}

/// Content of distances.json.
#[derive(Deserialize)]
pub(crate) struct DistanceReference {
    pub(crate) source: String,
    pub(crate) robots: Vec<MeasuredPairs>,
}

/// Robot of the library with limits.
#[derive(Deserialize)]
pub(crate) struct MeasuredPairs {
    pub(crate) id: String,
    pub(crate) robot: String,
    pub(crate) tension_limits_n: [f64; 2],
    pub(crate) rows: Vec<PairsAtPose>,
}

/// Distances of all pairs of cables at a pose: position [m] and roll, pitch, yaw [degrees].
#[derive(Deserialize)]
pub(crate) struct PairsAtPose {
    pub(crate) pose: [f64; 6],
    /// Numbers of both cables, from 1; distances of the straight and of the sagging cables [m].
    pub(crate) pairs: Vec<(usize, usize, f64, f64)>,
}
