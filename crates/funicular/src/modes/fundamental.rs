//! First natural frequency alone, with catenary-dynamic cables, for sweeps over many poses. Only [`first`] with its
//! result is visible outside, and [`lowest_by_count`], the slow method to which it falls back.
//!
//! **Problem.** Platform and cables together are a symmetric pencil `K − ω² M` with M positive definite. Its lowest
//! eigenvalue lies between a shift at which the pencil is positive definite and any Rayleigh quotient (docs/theory.md,
//! section 9, equations (35a) to (35c)). The search narrows that interval to a relative width of 1e-9 and proves the
//! result by the inertia of the pencil just below it.
//!
//! **Speed.** The first frequency of a robot is not above the first clamped frequency of any of its cables. So one
//! element of modest degree is enough for a taut cable, and a few elements for a slack one. No clamped mode is needed.
//! One factorisation per shift condenses a cable onto its platform end and one more unknown. Eight cables are computed
//! side by side, one in each lane of a vector register. A few shifts are enough, because inverse iteration at one shift
//! gives the next one. The first shifts use matrices condensed at ω = 0, which cost little.
//!
//! | File | Step |
//! |---|---|
//! | `batched_cable` | K − ω² M of eight cables at once, condensed onto the unknowns that are kept |
//! | `batched_cable/mesh` | elements of a cable; several if it hangs nearly without tension |
//! | `batched_cable/element` | matrices of one element in each lane, and their elimination |
//! | `batched_cable/element_integrals` | integrals of hats, bubbles and Legendre polynomials; Gauss's rules |
//! | `batched_cable/node_elimination` | nodes between the elements of slack cables |
//! | `batched_cable/end_elimination` | far ends that move, with the drives behind them |
//! | `condensed_cables` | kept unknowns of all cables: as a pencil about one frequency, and with all unknowns |
//! | `lever_axes` | axes of the cables over the platform's motion; motions of the robot |
//! | `factor` | factorisation of the pencil at a shift, and its inertia |
//! | `search` | bracket, iterate, verify |
//! | `pencil` | the robot as a pencil; rough search, then search with all unknowns |
//!
//! **Oracle.** [`below`](super::below) counts and separates all natural frequencies below a limit by the poles of the
//! cables; it shares neither mesh nor search with this module. tests/suite/modes/fundamental.rs compares both over the
//! library, random robots and slack cables to 1e-9 of the frequency. The tests of `batched_cable` compare its stiffness
//! with the stiffness by poles.
//!
//! **Drives.** The motions of pulleys and winches are unknowns of their cable. They are eliminated after those of the
//! span, cable by cable, because each cable has few of them; one is kept if it carries the cable's lowest clamped mode.
//!
//! **Cost.** Tens of microseconds per pose for taut cables, twice as much with drives, more for slack ones; the list of
//! all modes takes ten to twenty times as long. Robots whose stiffness is not positive definite, and searches that
//! rounding keeps from ending, use that list.

mod batched_cable;
mod condensed_cables;
mod factor;
mod lever_axes;
mod pencil;
mod search;
mod stages;

use super::lowest::{LowestError, lowest};
use super::{Kind, Mode, Modes};
use crate::dynamics::{DynamicsError, Linearisation};
use crate::robot::Robot;
use crate::statics::Equilibrium;
use pencil::RobotPencil;
use thiserror::Error;

/// First natural mode of a robot.
///
/// Energies and shape belong to a motion whose Rayleigh quotient has a relative error of at most 5e-10 and that may
/// contain other modes. If the next frequency is higher by the relative distance d, their contribution is at most
/// `√(5e-10/d)`, and the energies are wrong by at most twice that, usually by less than 1e-6.
#[derive(Debug, Clone, PartialEq)]
pub struct First {
    /// Natural frequency, undamped [Hz].
    pub frequency_hz: f64,
    /// Kind of the mode: vibration of the platform, of the cables, or of both.
    pub kind: Kind,
    /// Fraction of the kinetic energy that the platform has.
    pub platform_energy_fraction: f64,
    /// Fraction of the kinetic energy that each cable has, in the order of the file, without its drive.
    pub cable_energy_fractions: Vec<f64>,
    /// Fraction of the kinetic energy that the drive of each cable has: wheel, swivel, drum and motor. Empty if no
    /// drive has inertia.
    pub drive_energy_fractions: Vec<f64>,
    /// Motion of the platform (δp [m], δθ [rad]) about its origin, world axes; its largest scaled component is 1. Zero
    /// if the platform is at rest.
    pub shape: [f64; 6],
    /// Number of unstable directions of the equilibrium; they have no frequency.
    pub unstable_directions: usize,
    /// True if it is proved that the first natural frequency is at most this frequency and lower by at most 5e-10 of
    /// it.
    pub certified: bool,
}

/// Reason for which there is no first frequency.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FirstError {
    /// The robot cannot be linearised with catenary-dynamic cables.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// Nothing vibrates: the platform is unstable in every direction.
    #[error("no natural frequency below {below_hz:.3e} Hz: the equilibrium is unstable in {directions} directions")]
    None {
        /// Limit of the search [Hz].
        below_hz: f64,
        /// Number of unstable directions.
        directions: usize,
    },
}

/// Lowest natural frequency of a robot with catenary-dynamic cables, undamped, and its mode.
///
/// The result equals the first mode of [`below`](super::below) with [`Linearisation::default`], but is about twenty
/// times faster, and more with slack cables. Robots whose stiffness is not positive definite, and searches that
/// rounding keeps from ending, use [`lowest_by_count`].
///
/// # Errors
/// [`FirstError`]: a cable has no tension or does not hang, or nothing vibrates.
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
    // Flexible supports and ropes over sheaves couple the cables, which the pencil condenses one by one. Two
    // stiffnesses are refused below.
    let is_plain = !robot.has_supports() && !robot.has_running_ropes() && !robot.has_dynamic_stiffness();
    let pencil = if is_plain { RobotPencil::new(robot, equilibrium) } else { None };
    if let Some(found) = pencil.and_then(stages::first) {
        return Ok(found);
    }
    lowest_by_count(robot, equilibrium)
}

/// Lowest natural frequency and mode like [`first`], by a slower method for every robot: it counts and separates all
/// natural frequencies below a limit, which it raises until there is one.
///
/// # Errors
/// [`FirstError`], as for [`first`].
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

/// Maximum limit of the search [Hz]: far above the first frequency of any rope.
const MAX_HZ: f64 = 1e8;

impl First {
    fn of_mode(mode: Mode, unstable_directions: usize, certified: bool) -> Self {
        let Mode {
            frequency_hz,
            kind,
            platform_energy_fraction,
            cable_energy_fractions,
            drive_energy_fractions,
            shape,
            ..
        } = mode;
        Self {
            frequency_hz,
            kind,
            platform_energy_fraction,
            cable_energy_fractions,
            drive_energy_fractions,
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
                        let found = RobotPencil::new(&robot, &rest).and_then(stages::first);
                        assert!(found.is_some(), "{x}, {y}, {z}");
                    }
                }
            }
        }
        assert!(poses.iter().all(|count| *count > 25), "{poses:?}");
    }

    /// Held motors without inertia, a servo, constant torque, and a shaft with a drum that moves by itself.
    #[test]
    fn usual_drives_never_need_the_slow_way() {
        let motors = [
            ("", 0.0),
            ("control = \"position\"\nbandwidth_hz = 5\n", 5e-4),
            ("control = \"torque\"\n", 5e-4),
            ("stiffness_n_per_m = 5e5\ndrum_inertia_kg_m2 = 20.0\n", 5e-4),
        ];

        for (motor, inertia) in motors {
            let text = funicular_robots::COGIRO_WINCHES
                .replacen("gear_ratio = 3\n", &format!("gear_ratio = 3\n{motor}"), 1)
                .replacen("radius_m = 0.05\n", &format!("radius_m = 0.05\ninertia_kg_m2 = {inertia}\n"), 1)
                .replacen("radius_m = 0.05\n", &format!("radius_m = 0.05\nswivel_inertia_kg_m2 = {inertia}\n"), 1);
            let robot = Robot::from_toml(&text).unwrap();
            let mut poses = 0;
            for (x, y, z) in [(0.0, 0.0, 1.5), (3.0, 2.0, 1.0), (-4.0, 2.5, 2.5), (5.0, -3.0, 0.5), (0.5, 3.0, 3.0)] {
                let pose = Pose::new([x, y, z], [0.0, 2.0, -4.0]);
                let Ok(rest) = statics::inverse(&robot, &pose, StaticModel::Catenary) else { continue };
                poses += 1;
                let found = RobotPencil::new(&robot, &rest).and_then(stages::first);
                assert!(found.is_some(), "{motor} {x}, {y}, {z}");
            }
            assert!(poses >= 4, "{poses}");
        }
    }
}
