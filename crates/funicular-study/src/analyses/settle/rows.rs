//! Rows of numbers over the time of a command, and numbers of the equilibria on the way.

use super::super::timed_rows::{MAX_SAMPLES, count_of_steps, in_steps};
use crate::error::NoSolution;
use anyhow::{Result, anyhow, bail};
use funicular::statics::{Equilibrium, StaticsError};

/// Times in equal steps from 0 to the end of a command, the last of which may be shorter [s].
///
/// # Errors
/// Too many samples.
pub(super) fn sample_times(end: f64, step: f64) -> Result<impl Iterator<Item = f64>> {
    let count = count_of_steps(end, step);
    if count > MAX_SAMPLES {
        bail!(
            "⟪sample_time_s⟫ {step} gives {count} samples of the lengths, and at most {MAX_SAMPLES} are computed: give \
             a longer time"
        );
    }
    Ok(in_steps(end, step))
}

/// Row between two rows, at a part of the way from the first to the second.
pub(super) fn mixed(from: &[f64], to: &[f64], part: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| from * (1.0 - part) + to * part).collect()
}

/// Tension of each cable at the platform [N].
pub(super) fn tensions(of: &Equilibrium) -> Vec<f64> {
    of.cables.iter().map(|cable| cable.tension_platform).collect()
}

/// Unstrained length of each cable [m].
pub(super) fn unstrained(of: &Equilibrium) -> Vec<f64> {
    of.cables.iter().map(|cable| cable.unstrained_length).collect()
}

/// Error with a text of its own that keeps its exit code.
pub(super) fn no_solution_or_input(error: &StaticsError, text: String) -> anyhow::Error {
    if error.is_no_solution() { NoSolution(text).into() } else { anyhow!(text) }
}
