//! Contents of damped.json.

use super::independent::ReferenceResponse;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Reads damped.json.
pub(crate) fn damped() -> Result<Damped> {
    serde_json::from_str(include_str!("../../reference/damped.json")).context("damped.json")
}

/// Content of damped.json.
#[derive(Deserialize)]
pub(crate) struct Damped {
    #[serde(rename = "_about")]
    pub(crate) about: String,
    #[serde(rename = "damped_modes")]
    pub(crate) robots: Vec<DampedRobot>,
    pub(crate) point_frf: Vec<PointRobot>,
    pub(crate) shapes: Vec<ShapesOfRobot>,
}

/// Robot of independent.json with other damping.
#[derive(Deserialize)]
pub(crate) struct DampedRobot {
    pub(crate) case: String,
    pub(crate) robot: String,
    pub(crate) cable_damping: BTreeMap<String, RopeDamping>,
    pub(crate) platform_damping: Option<PlatformDamping>,
    pub(crate) below_hz: f64,
    pub(crate) modes: Vec<DampedFrequency>,
}

#[derive(Deserialize)]
#[serde(untagged)]
pub(crate) enum RopeDamping {
    Ratio { damping_ratio: f64 },
    Viscous { viscous_damping_n_s_m2: f64 },
}

#[derive(Deserialize)]
pub(crate) struct PlatformDamping {
    pub(crate) translation_n_s_m: [f64; 3],
    pub(crate) rotation_n_m_s_rad: [f64; 3],
}

#[derive(Deserialize)]
pub(crate) struct DampedFrequency {
    pub(crate) re_hz: f64,
    pub(crate) im_hz: f64,
}

/// Responses between points of cables and platform.
#[derive(Deserialize)]
pub(crate) struct PointRobot {
    pub(crate) robot: String,
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) pairs: Vec<PointPair>,
}

#[derive(Deserialize)]
pub(crate) struct PointPair {
    pub(crate) force: ReferencePoint,
    pub(crate) displacement: ReferencePoint,
    #[serde(flatten)]
    pub(crate) response: ReferenceResponse,
}

/// Point on a cable, or the origin of the platform.
#[derive(Deserialize)]
pub(crate) struct ReferencePoint {
    pub(crate) cable: Option<String>,
    #[serde(default)]
    pub(crate) fraction: f64,
    pub(crate) direction_world: [f64; 3],
}

/// Some undamped modes of a robot of independent.json.
#[derive(Deserialize)]
pub(crate) struct ShapesOfRobot {
    pub(crate) robot: String,
    pub(crate) below_hz: f64,
    /// Fractions of the cables' lengths from the platform.
    pub(crate) fractions: Vec<f64>,
    pub(crate) modes: Vec<ModeShape>,
}

#[derive(Deserialize)]
pub(crate) struct ModeShape {
    /// Index in the list of modes, from 0.
    pub(crate) index: usize,
    pub(crate) frequency_hz: f64,
    pub(crate) relative_gap_to_neighbour: f64,
    pub(crate) platform_at_rest: bool,
    /// Modal mass; `None` if the platform is at rest, because the shape then has no amplitude of the platform as its
    /// scale.
    pub(crate) modal_mass_kg: Option<f64>,
    /// Fractions of the platform and of every cable by its name.
    pub(crate) kinetic_energy_fraction: BTreeMap<String, f64>,
    /// World components at each of the `fractions`, for unit modal mass.
    pub(crate) cable_displacement_m: BTreeMap<String, Vec<[f64; 3]>>,
}
