//! The first natural frequency alone, with catenary-dynamic cables, for sweeps over many poses. Nothing of this room is visible
//! outside but [`first`] with its result, and the slow way that it falls back to.
//!
//! **What is computed.** Platform and cables together are a symmetric pencil `K − ω² M` with M positive definite. Its
//! lowest eigenvalue lies between a shift at which the pencil is positive definite and any Rayleigh quotient
//! (docs/theory.md, section 9, equations (35a) to (35c)). The search narrows that interval to a billionth and proves the
//! result by the inertia of the pencil just below it.
//!
//! **Why it is fast.** The first frequency of a robot is not above the first clamped one of any of its cables. So one
//! element of modest degree serves a taut cable and a few serve a slack one, no clamped mode is needed, and one
//! factorisation per shift condenses a cable onto its platform end and one more unknown. Eight cables are worked on side
//! by side, one in each lane of a vector register. A few shifts are enough, because inverse iteration at each of them ends
//! where the next one begins, and the first ones use matrices condensed at rest, which cost little.
//!
//! | File | Step |
//! |---|---|
//! | `batched_cable` | K − ω² M of eight cables at once, condensed onto the unknowns that are kept |
//! | `batched_cable/mesh` | elements of a cable, several where it hangs nearly without tension |
//! | `batched_cable/element` | matrices of one element in each lane, and their elimination |
//! | `batched_cable/element_integrals` | integrals of hats, bubbles and Legendre polynomials; Gauss's rules |
//! | `batched_cable/node_elimination` | nodes between the elements of slack cables |
//! | `condensed_cables` | kept unknowns of all cables: as a pencil about rest, and with all unknowns |
//! | `lever_axes` | axes of the cables over the platform's motion; motions of the whole robot |
//! | `factor` | the pencil at a shift, factored, and its inertia |
//! | `search` | bracket, iterate, verify |
//! | `pencil` | the robot as a pencil; rough search, then the exact one |
//!
//! **Oracle.** [`below`] counts and separates all natural frequencies below a limit by the poles of the cables; it shares
//! neither mesh nor search with this room. tests/suite/first.rs compares both over the library, random robots and
//! slack cables to 1e-9 of the frequency, and the tests of `batched_cable` compare its stiffness with that by poles.
//!
//! **Cost.** Some tens of microseconds per pose for taut cables, more where they are slack, against twenty times that by
//! the list of all. Robots whose stiffness is not positive definite, and searches that rounding keeps from ending, are left
//! to that list.

mod batched_cable;
mod condensed_cables;
mod factor;
mod lever_axes;
mod pencil;
mod search;

use super::lowest::{LowestError, lowest};
use super::{Kind, Mode, Modes};
use crate::dynamics::{DynamicsError, Linearisation};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use pencil::RobotPencil;
use std::f64::consts::TAU;
use thiserror::Error;

/// The first natural mode of a robot.
///
/// Energies and shape are of a motion whose Rayleigh quotient is the frequency's, and contain of other modes what its
/// width of 5e-10 leaves room for: with the next frequency a part d above, at most `√(5e-10/d)` of them, and the energies
/// are off by no more than twice that; usually by less than 1e-6.
#[derive(Debug, Clone, PartialEq)]
pub struct First {
    /// Natural frequency, undamped [Hz].
    pub frequency_hz: f64,
    /// Whose vibration it is.
    pub kind: Kind,
    /// Kinetic energy of the platform over that of the robot.
    pub platform_energy_fraction: f64,
    /// Kinetic energy of each cable over that of the robot, file order.
    pub cable_energy_fractions: Vec<f64>,
    /// Motion of the platform (δp [m], δθ [rad]) about its origin, world axes; its largest scaled component is 1. Zero
    /// if the platform is at rest.
    pub shape: [f64; 6],
    /// Directions in which the equilibrium is unstable; they have no frequency.
    pub unstable_directions: usize,
    /// No natural frequency lies below by more than 5e-10 of it, and one lies not above.
    pub certified: bool,
}

/// Why there is no first frequency to give.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FirstError {
    /// The robot cannot be linearised with catenary-dynamic cables.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// Nothing vibrates: the platform is unstable in every direction.
    #[error("no natural frequency below {below_hz:.3e} Hz: the equilibrium is unstable in {directions} directions")]
    None {
        /// Searched up to here [Hz].
        below_hz: f64,
        /// Directions that are not opposed.
        directions: usize,
    },
}

/// The lowest natural frequency of a robot with catenary-dynamic cables, undamped, and its mode.
///
/// The same as the first of [`below`] with [`Linearisation::default`], some twenty times faster, more where cables are
/// slack. Robots whose stiffness is not positive definite, and searches that rounding keeps from ending, go through
/// [`lowest_by_count`].
///
/// # Errors
/// [`FirstError`]: a cable without tension or without a shape, or nothing that vibrates.
///
/// # Example
/// ```
/// # use funicular::{modes, robot::{Pose, Robot}, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let pose = Pose::new([0.5, 0.1, 0.6], [0.0, 1.0, 0.0]);
/// let rest = statics::inverse(&robot, &pose, StaticModel::Catenary)?;
/// let first = modes::first(&robot, &rest)?;
/// assert!(first.certified && (first.frequency_hz - 1.145_088).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, section 9, equations (35a) to (35c).
pub fn first(robot: &Robot, equilibrium: &Equilibrium) -> Result<First, FirstError> {
    if let Some(found) = RobotPencil::new(robot, equilibrium).and_then(|mut pencil| pencil.first()) {
        return Ok(found);
    }
    lowest_by_count(robot, equilibrium)
}

/// As [`first`], by counting and separating all natural frequencies below a limit that is raised until there is one: the
/// slow way, which knows every robot.
///
/// # Errors
/// As [`first`].
pub fn lowest_by_count(robot: &Robot, equilibrium: &Equilibrium) -> Result<First, FirstError> {
    let (_, found) = lowest(robot, equilibrium, Linearisation::default(), 1, MAX_HZ).map_err(|error| match error {
        LowestError::Dynamics(error) => FirstError::Dynamics(error),
        LowestError::TooFew { unstable_directions, highest_hz, .. } => {
            FirstError::None { below_hz: highest_hz, directions: unstable_directions }
        }
    })?;
    let Modes { modes, unstable_directions, below_hz, certified, .. } = found;
    match modes.into_iter().next() {
        Some(mode) => Ok(First::of_mode(mode, unstable_directions, certified)),
        None => Err(FirstError::None { below_hz, directions: unstable_directions }),
    }
}

/// Limit of the search [Hz]: far above the sound of any rope.
const MAX_HZ: f64 = 1e8;

impl First {
    fn of_mode(mode: Mode, unstable_directions: usize, certified: bool) -> Self {
        let Mode { frequency_hz, kind, platform_energy_fraction, cable_energy_fractions, shape, .. } = mode;
        Self {
            frequency_hz,
            kind,
            platform_energy_fraction,
            cable_energy_fractions,
            shape,
            unstable_directions,
            certified,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Pose;
    use crate::statics::{self, StaticModel};

    #[test]
    fn usual_poses_taut_or_slack_never_need_the_slow_way() {
        let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        let mut poses = [0; 2];
        for i in 0..5 {
            for j in 0..5 {
                for k in 0..5 {
                    let [x, y, z] = [(i, 0.5), (j, 0.25), (k, 0.4)].map(|(at, step)| (f64::from(at) - 2.0) * step);
                    let pose = Pose::new([x, y, z + 1.0], [0.5, -0.5, 1.0]);
                    let Ok(rest) = statics::inverse(&robot, &pose, StaticModel::Catenary) else { continue };
                    let catenaries = rest.cables.iter().map(|state| &state.hanging.as_ref().unwrap().catenary);
                    let slackness = catenaries.map(|c| c.weight() / c.horizontal_force()).fold(0.0, f64::max);
                    // Beyond, loops hang down far below the robot.
                    if slackness < 1000.0 {
                        poses[usize::from(slackness > 3.0)] += 1;
                        let found = RobotPencil::new(&robot, &rest).and_then(|mut pencil| pencil.first());
                        assert!(found.is_some(), "{x}, {y}, {z}");
                    }
                }
            }
        }
        assert!(poses.iter().all(|count| *count > 25), "{poses:?}");
    }
}
