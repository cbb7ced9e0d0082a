//! Contents of damped.json.

use super::independent::ReferenceResponse;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Reads damped.json.
pub(in crate::validation) fn damped() -> Result<Damped> {
    serde_json::from_str(include_str!("../../../reference/damped.json")).context("damped.json")
}

/// Content of damped.json.
#[derive(Deserialize)]
pub(in crate::validation) struct Damped {
    #[serde(rename = "_about")]
    pub(in crate::validation) about: String,
    #[serde(rename = "damped_modes")]
    pub(in crate::validation) robots: Vec<DampedRobot>,
    pub(in crate::validation) point_frf: Vec<PointRobot>,
    pub(in crate::validation) shapes: Vec<ShapesOfRobot>,
}

/// Robot of independent.json with other damping.
#[derive(Deserialize)]
pub(in crate::validation) struct DampedRobot {
    pub(in crate::validation) case: String,
    pub(in crate::validation) robot: String,
    pub(in crate::validation) cable_damping: BTreeMap<String, RopeDamping>,
    pub(in crate::validation) platform_damping: Option<PlatformDamping>,
    pub(in crate::validation) below_hz: f64,
    pub(in crate::validation) modes: Vec<DampedFrequency>,
}

#[derive(Deserialize)]
#[serde(untagged)]
pub(in crate::validation) enum RopeDamping {
    Ratio { damping_ratio: f64 },
    Viscous { viscous_damping_n_s_m2: f64 },
}

#[derive(Deserialize)]
pub(in crate::validation) struct PlatformDamping {
    pub(in crate::validation) translation_n_s_m: [f64; 3],
    pub(in crate::validation) rotation_n_m_s_rad: [f64; 3],
}

#[derive(Deserialize)]
pub(in crate::validation) struct DampedFrequency {
    pub(in crate::validation) re_hz: f64,
    pub(in crate::validation) im_hz: f64,
}

/// Responses between points of cables and platform.
#[derive(Deserialize)]
pub(in crate::validation) struct PointRobot {
    pub(in crate::validation) robot: String,
    pub(in crate::validation) frequency_hz: Vec<f64>,
    pub(in crate::validation) pairs: Vec<PointPair>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct PointPair {
    pub(in crate::validation) force: ReferencePoint,
    pub(in crate::validation) displacement: ReferencePoint,
    #[serde(flatten)]
    pub(in crate::validation) response: ReferenceResponse,
}

/// Point on a cable, or the origin of the platform.
#[derive(Deserialize)]
pub(in crate::validation) struct ReferencePoint {
    pub(in crate::validation) cable: Option<String>,
    #[serde(default)]
    pub(in crate::validation) fraction: f64,
    pub(in crate::validation) direction_world: [f64; 3],
}

/// Some undamped modes of a robot of independent.json.
#[derive(Deserialize)]
pub(in crate::validation) struct ShapesOfRobot {
    pub(in crate::validation) robot: String,
    pub(in crate::validation) below_hz: f64,
    /// Fractions of the cables' lengths from the platform.
    pub(in crate::validation) fractions: Vec<f64>,
    pub(in crate::validation) modes: Vec<ModeShape>,
}

#[derive(Deserialize)]
pub(in crate::validation) struct ModeShape {
    /// Index in the list of modes, from 0.
    pub(in crate::validation) index: usize,
    pub(in crate::validation) frequency_hz: f64,
    pub(in crate::validation) relative_gap_to_neighbour: f64,
    pub(in crate::validation) platform_at_rest: bool,
    /// Modal mass; `None` if the platform is at rest, because the shape then has no amplitude of the platform as its
    /// scale.
    pub(in crate::validation) modal_mass_kg: Option<f64>,
    /// Fractions of the platform and of every cable by its name.
    pub(in crate::validation) kinetic_energy_fraction: BTreeMap<String, f64>,
    /// World components at each of the `fractions`, for unit modal mass.
    pub(in crate::validation) cable_displacement_m: BTreeMap<String, Vec<[f64; 3]>>,
}
