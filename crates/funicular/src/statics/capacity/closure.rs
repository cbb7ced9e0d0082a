//! Wrench closure: whether tensions of straight cables without a maximum could balance every load.

use crate::math::Vec6;
use crate::platform::{Coordinates, StraightCable};
use crate::robot::{Pose, Robot};
use crate::statics::free_motion::SpannedWrenches;
use crate::statics::tension::balanced_pull;

/// Tension factor above which it is no rounding; positive factors of poses at a boundary fall without a gap.
const POSITIVE: f64 = 1e-9;

/// Wrench closure of a pose; it depends on the directions of the cables alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrenchClosure {
    /// Number of independent wrenches of the cables.
    pub rank: usize,
    /// Degrees of freedom of the platform.
    pub dof: usize,
    /// Tension factor: largest ratio of the minimum to the maximum tension with which the cables balance each other
    /// without a load, from 0 to 1; rounding counts as 0.
    pub tension_factor: f64,
}

impl WrenchClosure {
    /// True if the cables could balance every load with tensions that are high enough.
    pub fn is_closed(&self) -> bool {
        self.rank == self.dof && self.tension_factor > 0.0
    }
}

/// Wrench closure at a pose, with straight cables. Sag does not change it: the forces of sagging cables approach those
/// of straight ones as the tensions grow.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics};
/// let robot = Robot::from_toml(funicular_robots::IPANEMA2)?;
/// let closure = statics::wrench_closure(&robot, &Pose::new([0.0, 0.0, 1.0], [0.0; 3]));
/// assert!(closure.is_closed() && closure.rank == 6 && closure.tension_factor > 0.29);
/// // A suspended robot needs its weight.
/// let suspended = Robot::from_toml(funicular_robots::COGIRO)?;
/// assert!(!statics::wrench_closure(&suspended, &Pose::new([0.0, 0.0, 1.5], [0.0; 3])).is_closed());
/// # Ok::<(), funicular::robot::spec::SpecError>(())
/// ```
///
/// # References
/// docs/theory.md, equation (40f).
pub fn wrench_closure(robot: &Robot, pose: &Pose) -> WrenchClosure {
    let coordinates = Coordinates::of(robot);
    let dof = coordinates.count();
    let straight = robot.cables.iter().map(|cable| StraightCable::at(cable, pose));
    let has_no_length = |cable: &StraightCable| cable.chord_w.norm() == 0.0;
    let columns: Vec<Vec6> = straight
        .map(|cable| if has_no_length(&cable) { Vec6::zeros() } else { cable.unit_wrench(&coordinates) })
        .collect();
    let rank = SpannedWrenches::of(&columns, dof).spanned.len();
    let factor = balanced_pull(&columns, dof);
    WrenchClosure { rank, dof, tension_factor: if factor > POSITIVE { factor } else { 0.0 } }
}
