//! The robot at rest as files of other programs; docs/export.md says what each file holds.

pub(crate) mod chain;
pub(crate) mod moordyn;
pub(crate) mod opensees;
pub(crate) mod vtk;

use crate::errors;
use crate::state::AtRest;
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::{self, Modes};

/// Most modes that a file takes: each is a field of the whole robot, or a row of a table.
const MOST_MODES: usize = 500;

/// All modes of exact cables below a frequency [Hz].
fn modes_below(at_rest: &AtRest, below_hz: f64) -> Result<(Dynamics, Modes)> {
    let linearisation = Linearisation { cable_model: CableModel::Exact, ..Linearisation::default() };
    let dynamics = Dynamics::about(&at_rest.robot, &at_rest.equilibrium, linearisation, below_hz)?;
    modes::check_count(&dynamics, below_hz, MOST_MODES)?;
    let found = modes::below(&dynamics, below_hz);
    if let Some(doubt) = found.doubt() {
        errors::warn(&doubt);
    }
    Ok((dynamics, found))
}

/// The first natural frequencies of exact cables [Hz], and no more of them than there are below a limit.
fn first_frequencies(at_rest: &AtRest, most: usize) -> Result<Vec<f64>> {
    // A robot has fewer modes than wanted only if its cables are massless; those that it has are not far up.
    const HIGHEST_HZ: f64 = 1e4;
    let mut below_hz = 0.125;
    loop {
        let (_, found) = modes_below(at_rest, below_hz)?;
        if found.modes.len() >= most || below_hz >= HIGHEST_HZ {
            return Ok(found.modes.iter().take(most).map(|mode| mode.frequency_hz).collect());
        }
        below_hz *= 2.0;
    }
}

/// A text of the user on one line, for titles and comments.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
