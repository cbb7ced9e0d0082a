//! Lowest natural frequencies of a robot at equilibrium.

use super::options::Options;
use super::points::Point;
use super::status::Status;
use funicular::cable_motion::WeightedMotions;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::modes::damped::{DampedMode, damped_modes};
use funicular::modes::tracking::Tracked;
use funicular::modes::{self, Kind, LowestError, Mode, Modes, PlatformModeError, TooMany};
use funicular::robot::Robot;
use funicular::statics::{Equilibrium, Stability};

/// Lowest modes of a point, ascending, with their motions for mode tracking.
#[derive(Debug, Clone, PartialEq)]
pub struct PointModes {
    /// Modes.
    pub modes: Vec<Mode>,
    /// Motions of the modes, in the same order.
    pub tracked: Vec<Tracked>,
}

/// Lowest `count` modes of a point, with the frequencies of the quantity `frequencies:N` and with the motions that are
/// [tracked](modes::tracking::track) from point to point.
///
/// # Errors
/// The reason why there are no modes, as in the row of a sweep.
pub fn lowest_modes(point: &Point, count: usize, options: &Options) -> Result<PointModes, String> {
    let (robot, state) = point.robot.as_ref().map_err(Clone::clone)?;
    let rest = point.solve(robot, state, options).map_err(|error| error.to_string())?.equilibrium;
    if let Some(status) = Status::of_infeasible(robot, &rest) {
        return Err(status.reason);
    }
    let (robot, rest) = rest.with_dynamic_stiffness(robot);
    let found = search(&robot, &rest, options.linearisation, count, options.highest_hz);
    let (dynamics, modes, _) = found.map_err(|status| status.reason)?;
    let weighted = WeightedMotions::new(&robot, &rest, &dynamics).map_err(|error| error.to_string())?;
    let tracked = modes.iter().map(|mode| weighted.of(mode)).collect();
    Ok(PointModes { modes, tracked })
}

/// Lowest modes: frequency [Hz] and kind, ascending.
pub(super) struct Lowest {
    pub(super) modes: Vec<(f64, Kind)>,
    pub(super) certified: bool,
}

/// Lowest `count` natural frequencies that are not above `highest_hz`. A single frequency with the cable model
/// `catenary-dynamic` has its own faster method, [`modes::first`].
pub(super) fn lowest(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<Lowest, Status> {
    let (robot, rest) = rest.with_dynamic_stiffness(robot);
    let (robot, rest) = (&*robot, &*rest);
    refuse_unstable(rest)?;
    if count == 1 && linearisation == Linearisation::default() {
        let first = modes::first(robot, rest).map_err(|error| Status::new("no-frequency", &error))?;
        if first.frequency_hz > highest_hz {
            let too_few = LowestError::TooFew { requested: count, found: 0, highest_hz, unstable_directions: 0 };
            return Err(Status::new("no-frequency", &too_few));
        }
        return Ok(Lowest { modes: vec![(first.frequency_hz, first.kind)], certified: first.certified });
    }
    let (_, modes, certified) = search(robot, rest, linearisation, count, highest_hz)?;
    Ok(Lowest { modes: modes.iter().map(|mode| (mode.frequency_hz, mode.kind)).collect(), certified })
}

/// Lowest natural frequency of a mode with at least the fraction `share` of its kinetic energy in the platform, and
/// true if the list up to it is certified.
pub(super) fn first_platform(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    share: f64,
    highest_hz: f64,
) -> Result<(f64, bool), Status> {
    let (_, found, first) = up_to_platform(robot, rest, linearisation, share, highest_hz)?;
    Ok((found.modes[first].frequency_hz, found.certified))
}

/// Damped partner of the mode of [`first_platform`], and true if a count proves its list.
pub(super) fn damped_platform(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    share: f64,
    highest_hz: f64,
) -> Result<(DampedMode, bool), Status> {
    let (dynamics, found, first) = up_to_platform(robot, rest, linearisation, share, highest_hz)?;
    let damped = damped_modes(&dynamics, &found);
    Ok((damped.modes[first], damped.certified))
}

/// Linearised robot with its modes up to the first of the platform, and the index of that mode.
fn up_to_platform(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    share: f64,
    highest_hz: f64,
) -> Result<(Dynamics, Modes, usize), Status> {
    let (robot, rest) = rest.with_dynamic_stiffness(robot);
    let (robot, rest) = (&*robot, &*rest);
    refuse_unstable(rest)?;
    let found = modes::lowest_with_platform(robot, rest, linearisation, share, highest_hz);
    let (dynamics, found) = found.map_err(|error| Status::new("no-frequency", &no_platform_mode(&error, share)))?;
    let first = found.first_platform(share);
    let first = first.ok_or_else(|| Status::new("no-frequency", "no mode of the platform was found"))?;
    Ok((dynamics, found, first))
}

/// Reason for which no mode of the platform was found. Nobody has chosen the limit that a search reaches by itself.
pub fn no_platform_mode(error: &PlatformModeError, share: f64) -> String {
    let PlatformModeError::TooMany(TooMany { count, below_hz, max }) = error else { return error.to_string() };
    format!(
        "no mode of the platform was found: of the natural frequencies below {} Hz, none has at least {} % of its \
         kinetic energy in the platform, and below {below_hz:.4} Hz there are {count}, more than the {max} that are \
         computed. The cables vibrate far below the platform here, as they do with low tensions; require a smaller \
         share, or use a cable model without vibrations of the cables, as `spring`",
        // The limit is doubled from search to search.
        format_args!("{:.4}", 0.5 * below_hz),
        100.0 * share,
    )
}

/// Lowest `count` modes, the linearised robot, and true if the modes are certified.
fn search(
    robot: &Robot,
    rest: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<(Dynamics, Vec<Mode>, bool), Status> {
    refuse_unstable(rest)?;
    let found = modes::lowest(robot, rest, linearisation, count, highest_hz);
    let (dynamics, mut found) = found.map_err(|error| Status::new("no-frequency", &error))?;
    found.modes.truncate(count);
    let certified = found.certified && found.modes.len() == count;
    Ok((dynamics, found.modes, certified))
}

fn refuse_unstable(rest: &Equilibrium) -> Result<(), Status> {
    if let Stability::Unstable { directions, .. } = rest.stability {
        let word = if rest.stability.is_indifferent() { "indifferent" } else { "not stable" };
        let reason = format!("the equilibrium is {word} ({directions} directions): it has no first frequency");
        return Err(Status::new("unstable", &reason));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::modes::tracking::track;
    use funicular::robot::State;
    use funicular::statics::{self, StaticModel};
    use std::borrow::Cow;

    #[test]
    fn a_search_that_finds_cable_modes_alone_says_so() {
        let error = PlatformModeError::TooMany(TooMany { count: 20_817, below_hz: 64.0, max: 20_000 });
        let reason = no_platform_mode(&error, 0.5);
        assert!(
            reason.starts_with("no mode of the platform was found: of the natural frequencies below 32.0000 Hz"),
            "{reason}"
        );
        assert!(
            reason.contains("there are 20817, more than the 20000 that are computed. The cables vibrate"),
            "{reason}"
        );

        // No mode has all of its energy in the platform.
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let State::Lengths(lengths) = &robot.state else { unreachable!() };
        let rest = statics::forward(&robot, lengths, StaticModel::Catenary, None).unwrap();
        let status = first_platform(&robot, &rest, Linearisation::default(), 1.0, 10.0).unwrap_err();
        assert_eq!(status.code, "no-frequency");
        assert!(status.reason.starts_with("no mode below 10 Hz has at least 100 % of its"), "{}", status.reason);
    }

    #[test]
    fn modes_of_a_growing_payload_veer_in_fine_steps_and_cross_in_coarse_ones() {
        const MODES: usize = 12;
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let options = Options::default();

        let followed = |count: u32| -> Vec<Vec<usize>> {
            let step = |i: u32| {
                let heavy = robot.with_mass(10.55 + (86.35 - 10.55) * f64::from(i) / f64::from(count - 1));
                let state = heavy.state.clone();
                let point =
                    Point { coordinates: Vec::new(), robot: Ok((Cow::Owned(heavy), Cow::Owned(state))), holder: None };
                let found = lowest_modes(&point, MODES, &options).unwrap();
                assert!(found.modes.len() == MODES && found.tracked.len() == MODES);
                found.tracked
            };
            track(&(0..count).map(step).collect::<Vec<_>>())
        };

        // The curves of a robot without symmetry come near each other and never meet.
        let fine = followed(800);
        assert!(fine.iter().all(|of| of.iter().copied().eq(0..MODES)), "{:?}", fine.last());

        // The motions cross where the frequencies only come near each other.
        let coarse = followed(8);
        let crossed = coarse.iter().filter(|of| of.windows(2).any(|pair| pair[0] > pair[1])).count();
        assert!(crossed >= 3, "{coarse:?}");
    }
}
