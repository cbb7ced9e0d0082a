//! Equilibrium of a robot at its state, given by lengths or by a pose.

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::forward::forward;
use super::inverse::determinate;
use super::model::StaticModel;
use super::nearest_pose::nearest_equilibrium;
use super::tension::{TensionRule, distribute_tensions};
use crate::robot::{Pose, Robot, State};
use std::cmp::Ordering;

/// Equilibrium of a robot, with the way it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Equilibrium.
    pub equilibrium: Equilibrium,
    /// Requested pose, and its distance [m] by [`pose_distance`](super::pose_distance), if fewer cables than degrees of
    /// freedom can hold only a pose near it.
    pub requested_pose: Option<(Pose, f64)>,
    /// Rule by which the tensions were chosen, if there was a choice.
    pub rule: Option<TensionRule>,
    /// Pose whose unstrained lengths are held, if another robot was at rest there; see [`solve_held_at`].
    pub held_pose: Option<Pose>,
}

/// Equilibrium at [`Robot::state`] by [`solve_at`]. A given rule must have a choice.
///
/// # Errors
/// [`StaticsError`]; among them [`StaticsError::NoState`] for a robot without state and
/// [`StaticsError::NothingToChoose`] for a rule without a choice.
///
/// # Example
/// ```
/// use funicular::robot::{Pose, Robot, State};
/// use funicular::statics::{self, StaticModel, TensionRule};
///
/// let mut robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// robot.state = State::Pose(Pose::new([1.0, 2.0, 1.5], [0.0; 3]));
/// let rest = statics::solve(&robot, StaticModel::Catenary, None)?;
/// assert_eq!(rest.rule, Some(TensionRule::Lowest)); // eight cables for six degrees of freedom leave a choice
/// assert!(rest.requested_pose.is_none() && rest.equilibrium.residual < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(robot: &Robot, model: StaticModel, rule: Option<TensionRule>) -> Result<Solution, StaticsError> {
    if rule.is_some() {
        refuse_rule_without_choice(robot)?;
    }
    solve_at(robot, &robot.state, model, &rule.unwrap_or_default())
}

/// Equilibrium of a robot at a state, which need not be its own. For unstrained lengths: the pose ([`forward`]). For a
/// pose: the lengths and tensions ([`inverse`]), chosen by the rule if more cables than degrees of freedom leave a
/// choice ([`distribute_tensions`]). For a pose that fewer cables cannot hold: the nearest one that they can hold
/// ([`nearest_equilibrium`]).
///
/// # Errors
/// [`StaticsError`] of the function that solves it; [`StaticsError::NoState`] for an unknown state.
///
/// # Example
/// ```
/// use funicular::robot::{Pose, Robot, State};
/// use funicular::statics::{self, StaticModel, TensionRule};
///
/// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let state = State::Pose(Pose::new([0.5, 0.1, 0.6], [0.0; 3]));
/// let rest = statics::solve_at(&robot, &state, StaticModel::Catenary, &TensionRule::Lowest)?;
/// assert_eq!(rest.rule, None); // six cables for six degrees of freedom: no choice
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_at(
    robot: &Robot,
    state: &State,
    model: StaticModel,
    rule: &TensionRule,
) -> Result<Solution, StaticsError> {
    let found = |equilibrium| Solution { equilibrium, requested_pose: None, rule: None, held_pose: None };
    match state {
        State::Unknown => Err(StaticsError::NoState),
        State::Lengths(lengths) => Ok(found(forward(robot, lengths, model, None)?)),
        State::Pose(pose) => match cables_to_degrees_of_freedom(robot) {
            Ordering::Less => {
                let nearest = nearest_equilibrium(robot, pose, model)?;
                Ok(Solution { requested_pose: Some((*pose, nearest.distance)), ..found(nearest.equilibrium) })
            }
            Ordering::Equal => Ok(found(determinate(robot, pose, model)?)),
            Ordering::Greater => {
                let equilibrium = distribute_tensions(robot, pose, model, rule)?;
                Ok(Solution { rule: Some(rule.clone()), ..found(equilibrium) })
            }
        },
    }
}

/// Equilibrium of a robot at held unstrained lengths by [`solve_held_at`]: those with which `holder` rests at its own
/// state. A given rule must have a choice.
///
/// # Errors
/// [`StaticsError`], as for [`solve`] of the holder and for [`forward`] of the robot.
pub fn solve_held(
    holder: &Robot,
    robot: &Robot,
    model: StaticModel,
    rule: Option<TensionRule>,
) -> Result<Solution, StaticsError> {
    if rule.is_some() {
        refuse_rule_without_choice(holder)?;
    }
    solve_held_at(holder, robot, &holder.state, model, &rule.unwrap_or_default())
}

/// Equilibrium of a robot at held unstrained lengths: those with which `holder`, a robot with the same cables and, for
/// example, another mass, rests at a state. The search starts at the pose of the holder, so that it finds the
/// equilibrium to which the platform moves if several hold these lengths.
///
/// # Errors
/// [`StaticsError`], as for [`solve_at`] of the holder and for [`forward`] of the robot.
///
/// # Example
/// ```
/// use funicular::robot::{Pose, Robot, State};
/// use funicular::statics::{self, StaticModel, TensionRule};
///
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let state = State::Pose(Pose::new([1.0, 2.0, 1.5], [0.0; 3]));
/// let (heavier, rule) = (robot.with_mass(2.0 * robot.platform.mass), TensionRule::Lowest);
/// let rest = statics::solve_held_at(&robot, &heavier, &state, StaticModel::Catenary, &rule)?;
/// assert!(rest.equilibrium.pose.position_w.z < 1.5); // the heavier platform rests lower
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_held_at(
    holder: &Robot,
    robot: &Robot,
    state: &State,
    model: StaticModel,
    rule: &TensionRule,
) -> Result<Solution, StaticsError> {
    let held = solve_at(holder, state, model, rule)?;
    let pose = held.equilibrium.pose;
    let lengths: Vec<f64> = held.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
    let equilibrium = forward(robot, &lengths, model, Some(&pose))?;
    Ok(Solution { equilibrium, requested_pose: held.requested_pose, rule: held.rule, held_pose: Some(pose) })
}

/// Inverse statics: unstrained lengths and tensions that hold the platform at a pose.
///
/// With more cables than degrees of freedom the tensions are as low as their limits allow; [`solve_at`] takes other
/// rules. With as many cables the solution is unique, whatever the limits; [`crate::warnings`] compares it with them.
///
/// # Errors
/// [`StaticsError`]: fewer cables than degrees of freedom ([`nearest_equilibrium`] finds a pose that they can hold),
/// tensions beyond their limits if there is a choice, a singular pose, a straight cable that would need negative
/// tension, no tensions found for sagging cables, coinciding ends, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel}};
/// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let pose = Pose::new([0.5, 0.1, 0.6], [0.0, 2.0, 0.0]);
/// let held = statics::inverse(&robot, &pose, StaticModel::Catenary)?;
/// let lengths: Vec<f64> = held.cables.iter().map(|c| c.unstrained_length).collect();
/// let back = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// assert!((back.pose.position_w - pose.position_w).norm() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn inverse(robot: &Robot, pose: &Pose, model: StaticModel) -> Result<Equilibrium, StaticsError> {
    match cables_to_degrees_of_freedom(robot) {
        Ordering::Equal => determinate(robot, pose, model),
        // Refuses fewer cables than degrees of freedom.
        Ordering::Less | Ordering::Greater => distribute_tensions(robot, pose, model, &TensionRule::default()),
    }
}

/// Comparison of the number of cables with the number of degrees of freedom.
fn cables_to_degrees_of_freedom(robot: &Robot) -> Ordering {
    robot.cables.len().cmp(&robot.platform.motion.count())
}

/// Refuses a tension rule where the tensions follow from the state alone.
fn refuse_rule_without_choice(robot: &Robot) -> Result<(), StaticsError> {
    let choice = cables_to_degrees_of_freedom(robot) == Ordering::Greater;
    match &robot.state {
        State::Pose(_) if !choice => {
            let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
            Err(StaticsError::NothingToChoose { cables, dof })
        }
        State::Lengths(_) => Err(StaticsError::RuleOfLengths),
        State::Pose(_) | State::Unknown => Ok(()),
    }
}
