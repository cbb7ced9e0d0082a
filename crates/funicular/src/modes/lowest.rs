//! Lowest natural modes without a limit that has to be known beforehand: the limit is raised until the wanted modes lie
//! below it.

use super::{MAX_MODES, Modes, TooMany, below, check_count};
use crate::cable::{CableModel, Sag};
use crate::dynamics::{Dynamics, DynamicsError, Linearisation};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use std::f64::consts::TAU;
use thiserror::Error;

/// Reason for which there are not as many natural frequencies as requested.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LowestError {
    /// The robot cannot be linearised.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// The count below the highest frequency is smaller than the requested number.
    #[error("fewer than {requested} natural frequencies are below {highest_hz} Hz: raise the limit of the search")]
    TooFew {
        /// Number requested.
        requested: usize,
        /// Number found below the limit.
        found: usize,
        /// Limit of the search [Hz].
        highest_hz: f64,
        /// Number of unstable directions of the linearised robot; they are counted, but have no frequency.
        unstable_directions: usize,
    },
}

/// Reason for which there is no first mode of the platform.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlatformModeError {
    /// The robot cannot be linearised.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// No mode below the highest frequency moves the platform enough.
    #[error(
        "no mode below {highest_hz} Hz has at least {} % of its kinetic energy in the platform: raise the limit of the \
         search, or require a smaller share",
        100.0 * .share
    )]
    NoPlatformMode {
        /// Required fraction of the kinetic energy.
        share: f64,
        /// Limit of the search [Hz].
        highest_hz: f64,
    },
    /// Too many modes below the limit that the search has reached.
    #[error(transparent)]
    TooMany(#[from] TooMany),
}

/// Goal of a search for the lowest modes below a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Number of natural frequencies.
    Count(usize),
    /// A mode with at least this fraction of its kinetic energy in the platform.
    PlatformShare(f64),
}

impl Wanted {
    /// False if the count alone, which is much faster than the list, shows that the wanted modes are not below a limit.
    /// The count includes unstable directions; only the list distinguishes them.
    fn is_possible(self, dynamics: &Dynamics, limit_hz: f64) -> bool {
        match self {
            Self::Count(count) => dynamics.modes_below(limit_hz * TAU) >= count,
            Self::PlatformShare(_) => true,
        }
    }

    fn is_in(self, list: &Modes) -> bool {
        match self {
            Self::Count(count) => list.count_below >= count + list.unstable_directions,
            Self::PlatformShare(share) => list.first_platform(share).is_some(),
        }
    }
}

/// Result of a search for the lowest modes.
#[derive(Debug, Clone)]
pub struct Search {
    /// Linearisation at the last limit.
    pub dynamics: Dynamics,
    /// All modes below the last limit.
    pub modes: Modes,
    /// True if the wanted modes are among them; false if even the highest limit is too low.
    pub complete: bool,
}

/// Searches the lowest modes: raises a limit [Hz] until the wanted modes lie below it. `next_hz` is the limit after a
/// limit, `None` after the highest one. `dynamics_at` linearises the robot for all frequencies below a limit; it may
/// refuse a limit below which there are too many modes.
///
/// # Errors
/// The error of `dynamics_at`.
pub fn until<E>(
    wanted: Wanted,
    first_hz: f64,
    next_hz: impl Fn(f64) -> Option<f64>,
    dynamics_at: impl Fn(f64) -> Result<Dynamics, E>,
) -> Result<Search, E> {
    let mut limit = first_hz;
    loop {
        let dynamics = dynamics_at(limit)?;
        match next_hz(limit) {
            Some(next) if !wanted.is_possible(&dynamics, limit) => limit = next,
            next => {
                let modes = below(&dynamics, limit);
                let complete = wanted.is_in(&modes);
                match next {
                    Some(next) if !complete => limit = next,
                    _ => return Ok(Search { dynamics, modes, complete }),
                }
            }
        }
    }
}

/// Limit after a limit [Hz]: twice as high, but at most `highest_hz`.
pub fn doubled(highest_hz: f64) -> impl Fn(f64) -> Option<f64> {
    move |limit| (limit < highest_hz).then(|| (2.0 * limit).min(highest_hz))
}

/// All natural modes below a limit that the search chooses: as low as possible, with at least `count` modes below it,
/// and at most `highest_hz`.
///
/// The first limit lies near the expected first frequency. It is doubled until the count confirms enough modes below
/// it.
///
/// # Errors
/// [`LowestError`]: a cable has no stiffness in the model, or there are fewer modes than requested below `highest_hz`.
///
/// # Example
/// ```
/// # use funicular::{dynamics::Linearisation, modes, robot::{Pose, Robot}, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let rest = statics::inverse(&robot, &Pose::new([0.5, 0.1, 0.6], [0.0, 1.0, 0.0]), StaticModel::Catenary)?;
/// let (_, found) = modes::lowest(&robot, &rest, Linearisation::default(), 3, 1000.0)?;
/// assert!(found.certified && found.modes.len() >= 3 && found.below_hz < 10.0);
/// assert!((found.modes[0].frequency_hz - 1.145_088).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lowest(
    robot: &Robot,
    equilibrium: &Equilibrium,
    linearisation: Linearisation,
    count: usize,
    highest_hz: f64,
) -> Result<(Dynamics, Modes), LowestError> {
    let first = first_limit(robot, equilibrium, linearisation.cable_model).min(highest_hz);
    let dynamics_at = |limit| Dynamics::about(robot, equilibrium, linearisation, limit);
    let Search { dynamics, modes, complete } = until(Wanted::Count(count), first, doubled(highest_hz), dynamics_at)?;
    if complete {
        return Ok((dynamics, modes));
    }
    let (found, unstable_directions) = (modes.modes.len(), modes.unstable_directions);
    Err(LowestError::TooFew { requested: count, found, highest_hz, unstable_directions })
}

/// All natural modes below a limit that the search chooses, at most `highest_hz`, with at least one mode that has the
/// fraction `share` of its kinetic energy in the platform: [`Modes::first_platform`] gives its index.
///
/// The limit is doubled until the list, which the count confirms, has such a mode. So no mode of the platform is
/// missed, however many cable modes lie below it.
///
/// # Errors
/// [`PlatformModeError`]: a cable has no stiffness in the model, no such mode is below `highest_hz`, or more modes than
/// a list may have are below it.
///
/// # Example
/// ```
/// # use funicular::{dynamics::Linearisation, modes, robot::{Pose, Robot}, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let rest = statics::inverse(&robot, &Pose::new([0.0, 0.0, 1.5], [0.0; 3]), StaticModel::Catenary)?;
/// let (_, found) = modes::lowest_with_platform(&robot, &rest, Linearisation::default(), 0.5, 1000.0)?;
/// let first = found.first_platform(0.5).expect("the search has found it");
/// assert!(found.certified && first > 0); // modes of the cables come first
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn lowest_with_platform(
    robot: &Robot,
    equilibrium: &Equilibrium,
    linearisation: Linearisation,
    share: f64,
    highest_hz: f64,
) -> Result<(Dynamics, Modes), PlatformModeError> {
    let first = first_limit(robot, equilibrium, linearisation.cable_model).min(highest_hz);
    let wanted = Wanted::PlatformShare(share);
    let found = until(wanted, first, doubled(highest_hz), |limit| -> Result<_, PlatformModeError> {
        let dynamics = Dynamics::about(robot, equilibrium, linearisation, limit)?;
        check_count(&dynamics, limit, MAX_MODES)?;
        Ok(dynamics)
    })?;
    if found.complete {
        Ok((found.dynamics, found.modes))
    } else {
        Err(PlatformModeError::NoPlatformMode { share, highest_hz })
    }
}

/// First limit of the search [Hz]: slightly above the lowest frequency of a cable between fixed ends, which is above
/// the first frequency of the robot.
fn first_limit(robot: &Robot, equilibrium: &Equilibrium, model: CableModel) -> f64 {
    /// Factor on the string frequency, which is the cable's first frequency out of plane to second order of the sag.
    const ABOVE: f64 = 1.05;
    let cables = equilibrium.cables.iter().enumerate();
    let strings = cables.map(|(i, state)| Sag::of(robot, i, state).string_frequency_hz());
    let lowest = strings.filter(|hz| hz.is_finite() && *hz > 0.0).fold(f64::INFINITY, f64::min);
    if model.is_dynamic() && lowest.is_finite() { ABOVE * lowest } else { 1.0 }
}
