//! The lowest natural frequencies of a robot at rest, how many are asked.

use super::status::Status;
use crate::cable::{CableModel, Sag};
use crate::dynamics::{Dynamics, Linearisation};
use crate::modes::{self, Kind};
use crate::robot::Robot;
use crate::statics::{Equilibrium, Stability};
use std::f64::consts::TAU;

/// The lowest modes: frequency [Hz] and kind, ascending.
pub(super) struct Lowest {
    pub(super) modes: Vec<(f64, Kind)>,
    pub(super) certified: bool,
}

/// The lowest `count` natural frequencies that are not above `highest_hz`.
///
/// The first alone of exact cables has its own way, [`modes::first`]. Else the limit of the search starts where the first frequency is likely and is doubled until the count says that there are
/// enough below it.
pub(super) fn lowest(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<Lowest, Status> {
    if let Stability::Unstable { directions, .. } = rest.stability {
        let reason = format!("the equilibrium is not stable ({directions} directions): it has no first frequency");
        return Err(Status::new("unstable", &reason));
    }
    let none = |reason: String| Status::new("no-frequency", &reason);
    if count == 1 && linearisation == Linearisation::default() {
        let first = modes::first(robot, rest).map_err(|error| none(error.to_string()))?;
        if first.frequency_hz > highest_hz {
            return Err(too_few(count, highest_hz));
        }
        return Ok(Lowest { modes: vec![(first.frequency_hz, first.kind)], certified: first.certified });
    }
    let mut limit = first_limit(robot, rest, linearisation.cable_model).min(highest_hz);
    loop {
        let dynamics = Dynamics::about(robot, rest, linearisation, limit).map_err(|error| none(error.to_string()))?;
        if dynamics.modes_below(limit * TAU) >= count {
            let mut found = modes::below(&dynamics, limit);
            found.modes.truncate(count);
            let modes: Vec<_> = found.modes.iter().map(|mode| (mode.frequency_hz, mode.kind)).collect();
            let certified = found.certified && modes.len() == count;
            return Ok(Lowest { modes, certified });
        }
        if limit >= highest_hz {
            return Err(too_few(count, highest_hz));
        }
        limit = (2.0 * limit).min(highest_hz);
    }
}

fn too_few(count: usize, highest_hz: f64) -> Status {
    let reason =
        format!("fewer than {count} natural frequencies are below {highest_hz} Hz: raise the limit of the search");
    Status::new("no-frequency", &reason)
}

/// Where to begin: a little above the lowest frequency of a cable between fixed ends, which is above the first of the robot.
fn first_limit(robot: &Robot, rest: &Equilibrium, model: CableModel) -> f64 {
    /// A cable's first frequency out of plane is that of a string, to the sag's second order.
    const ABOVE: f64 = 1.05;
    let strings = rest.cables.iter().enumerate().map(|(i, state)| Sag::of(robot, i, state).string_frequency_hz());
    let lowest = strings.filter(|hz| hz.is_finite() && *hz > 0.0).fold(f64::INFINITY, f64::min);
    if model.is_dynamic() && lowest.is_finite() { ABOVE * lowest } else { 1.0 }
}
