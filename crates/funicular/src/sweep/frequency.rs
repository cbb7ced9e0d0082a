//! The lowest natural frequencies of a robot at rest, how many are asked.

use super::status::Status;
use super::{Options, Point, row};
use crate::cable::{CableModel, Sag};
use crate::cable_motion::WeightedMotions;
use crate::dynamics::{Dynamics, Linearisation};
use crate::modes::{self, Kind, Mode, track::Tracked};
use crate::robot::Robot;
use crate::statics::{Equilibrium, Stability};
use std::f64::consts::TAU;

/// The lowest modes of a point, ascending, and each as tracking takes it.
#[derive(Debug, Clone, PartialEq)]
pub struct PointModes {
    /// The modes.
    pub modes: Vec<Mode>,
    /// Their motions, in the same order.
    pub tracked: Vec<Tracked>,
}

/// The lowest `count` modes of a point: those whose frequencies the quantity [`Frequencies`](super::Quantity::Frequencies)
/// gives, with their motions, to be [tracked](modes::track::branches) from point to point.
///
/// # Errors
/// The reason why there are none, as a row has it.
pub fn lowest_modes(point: &Point, count: usize, options: &Options) -> Result<PointModes, String> {
    let (robot, state) = point.robot.as_ref().map_err(Clone::clone)?;
    let (rest, _) = row::at_rest(robot, state, options).map_err(|error| error.to_string())?;
    if let Some(status) = Status::refusing(robot, &rest) {
        return Err(status.reason);
    }
    let found = search(robot, &rest, options.linearisation, count, options.highest_hz);
    let (dynamics, modes, _) = found.map_err(|status| status.reason)?;
    let weighted = WeightedMotions::new(robot, &rest, &dynamics).map_err(|error| error.to_string())?;
    let tracked = modes.iter().map(|mode| weighted.of(mode)).collect();
    Ok(PointModes { modes, tracked })
}

/// The lowest modes: frequency [Hz] and kind, ascending.
pub(super) struct Lowest {
    pub(super) modes: Vec<(f64, Kind)>,
    pub(super) certified: bool,
}

/// The lowest `count` natural frequencies that are not above `highest_hz`. The first alone of exact cables has its own way, [`modes::first`].
pub(super) fn lowest(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<Lowest, Status> {
    refuse_unstable(rest)?;
    if count == 1 && linearisation == Linearisation::default() {
        let first = modes::first(robot, rest).map_err(|error| Status::new("no-frequency", &error))?;
        if first.frequency_hz > highest_hz {
            return Err(too_few(count, highest_hz));
        }
        return Ok(Lowest { modes: vec![(first.frequency_hz, first.kind)], certified: first.certified });
    }
    let (_, modes, certified) = search(robot, rest, linearisation, count, highest_hz)?;
    Ok(Lowest { modes: modes.iter().map(|mode| (mode.frequency_hz, mode.kind)).collect(), certified })
}

/// The same with whole modes and what they are modes of, and whether they are certified.
///
/// The limit of the search starts where the first frequency is likely and is doubled until the count says that there are
/// enough below it.
fn search(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<(Dynamics, Vec<Mode>, bool), Status> {
    refuse_unstable(rest)?;
    let none = |reason: String| Status::new("no-frequency", &reason);
    let mut limit = first_limit(robot, rest, linearisation.cable_model).min(highest_hz);
    loop {
        let dynamics = Dynamics::about(robot, rest, linearisation, limit).map_err(|error| none(error.to_string()))?;
        if dynamics.modes_below(limit * TAU) >= count {
            let mut found = modes::below(&dynamics, limit);
            found.modes.truncate(count);
            let certified = found.certified && found.modes.len() == count;
            return Ok((dynamics, found.modes, certified));
        }
        if limit >= highest_hz {
            return Err(too_few(count, highest_hz));
        }
        limit = (2.0 * limit).min(highest_hz);
    }
}

fn refuse_unstable(rest: &Equilibrium) -> Result<(), Status> {
    if let Stability::Unstable { directions, .. } = rest.stability {
        let reason = format!("the equilibrium is not stable ({directions} directions): it has no first frequency");
        return Err(Status::new("unstable", &reason));
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modes::track::branches;
    use std::borrow::Cow;

    #[test]
    fn modes_of_a_growing_payload_veer_in_fine_steps_and_cross_in_coarse_ones() {
        const MODES: usize = 12;
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let options = Options::default();
        let followed = |count: u32| -> Vec<Vec<usize>> {
            let step = |i: u32| {
                let heavy = robot.with_mass(10.55 + (86.35 - 10.55) * f64::from(i) / f64::from(count - 1));
                let state = heavy.state.clone();
                let point = Point { coordinates: Vec::new(), robot: Ok((Cow::Owned(heavy), Cow::Owned(state))) };
                let found = lowest_modes(&point, MODES, &options).unwrap();
                assert!(found.modes.len() == MODES && found.tracked.len() == MODES);
                found.tracked
            };
            branches(&(0..count).map(step).collect::<Vec<_>>())
        };
        // A robot without symmetry: its curves come near each other and never meet, however many there are.
        let fine = followed(800);
        assert!(fine.iter().all(|of| of.iter().copied().eq(0..MODES)), "{:?}", fine.last());
        // The motions cross what the frequencies only come near to.
        let coarse = followed(8);
        let crossed = coarse.iter().filter(|of| of.windows(2).any(|pair| pair[0] > pair[1])).count();
        assert!(crossed >= 3, "{coarse:?}");
    }
}
