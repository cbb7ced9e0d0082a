//! A robot beside one time of a path.

use super::Planned;
use crate::error::NoSolution;
use crate::text::significant;
use anyhow::{Result, anyhow};
use funicular::path::Side;
use funicular::trajectory::{AlongPath, InMotion};

/// Robot beside a time of a path.
pub(super) fn in_motion(along: &mut AlongPath, planned: &Planned, time: f64, side: Side) -> Result<InMotion> {
    along.at(&planned.path.beside(time, side)).map_err(|error| {
        let mut text = format!("{} s after the start of the path: {error}", significant(time, 4));
        if let Some(rounded) = &planned.rounded {
            text.push_str("; ");
            text.push_str(&rounded.advice());
        }
        if error.is_no_solution() { NoSolution(text).into() } else { anyhow!(text) }
    })
}

/// Unstrained lengths [m].
pub(super) fn lengths(motion: &InMotion) -> Vec<f64> {
    motion.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
}
