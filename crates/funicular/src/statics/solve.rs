//! Equilibrium of a robot at its state, given by lengths or by a pose.

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::forward::forward;
use super::free_motion::has_choice;
use super::ideal;
use super::inverse::determinate;
use super::model::StaticModel;
use super::nearest_pose::{NearestEquilibrium, nearest_equilibrium};
use super::ropes_at_pose::RopesAtPose;
use super::tension::{TensionRule, distribute_tensions};
use crate::robot::{Constraint, Pose, Robot, State};

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
    let is_given = rule.is_some();
    let found = solve_at(robot, &robot.state, model, &rule.unwrap_or_default())?;
    if is_given {
        refuse_idle_rule(robot, &found)?;
    }
    Ok(found)
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
        State::Pose(pose) if robot.has_ropes_over_sheaves() => {
            let (equilibrium, distance) = RopesAtPose { robot, pose, model, rule }.solved()?;
            let rule = robot.constraint().is_redundant().then(|| rule.clone());
            Ok(Solution { requested_pose: distance.map(|distance| (*pose, distance)), rule, ..found(equilibrium) })
        }
        State::Pose(pose) => match ConstraintAtPose::of(robot, pose, model) {
            ConstraintAtPose::Under => nearest(robot, pose, model, rule),
            ConstraintAtPose::Full => Ok(found(determinate(robot, pose, model)?)),
            ConstraintAtPose::Redundant => {
                let equilibrium = match distribute_tensions(robot, pose, model, rule) {
                    // Directions that are dependent to rounding only.
                    Err(StaticsError::Singular { .. }) if robot.constraint().is_under() => {
                        return nearest(robot, pose, model, rule);
                    }
                    tensions => tensions?,
                };
                // Fewer cables hold this pose itself.
                let requested_pose = robot.constraint().is_under().then_some((*pose, 0.0));
                Ok(Solution { requested_pose, rule: Some(rule.clone()), ..found(equilibrium) })
            }
        },
    }
}

/// Equilibrium at the nearest pose that fewer cables than degrees of freedom can hold. If their tensions there are a
/// matter of choice, the rule chooses them.
fn nearest(robot: &Robot, pose: &Pose, model: StaticModel, rule: &TensionRule) -> Result<Solution, StaticsError> {
    let NearestEquilibrium { equilibrium, distance } = nearest_equilibrium(robot, pose, model)?;
    let found = Solution { equilibrium, requested_pose: Some((*pose, distance)), rule: None, held_pose: None };
    let reached = found.equilibrium.pose;
    if !has_choice(robot, &reached, model) {
        return Ok(found);
    }
    match distribute_tensions(robot, &reached, model, rule) {
        // Directions that are dependent to rounding only: the tensions of the search are an equilibrium.
        Err(StaticsError::Singular { .. }) => Ok(found),
        tensions => Ok(Solution { equilibrium: tensions?, rule: Some(rule.clone()), ..found }),
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
    let is_given = rule.is_some();
    let found = solve_held_at(holder, robot, &holder.state, model, &rule.unwrap_or_default())?;
    if is_given {
        refuse_idle_rule(holder, &found)?;
    }
    Ok(found)
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
    if robot.has_ropes_over_sheaves() {
        let rule = TensionRule::default();
        return RopesAtPose { robot, pose, model, rule: &rule }.held();
    }
    match ConstraintAtPose::of(robot, pose, model) {
        ConstraintAtPose::Full => determinate(robot, pose, model),
        // Refuses fewer cables than degrees of freedom.
        ConstraintAtPose::Under | ConstraintAtPose::Redundant => {
            distribute_tensions(robot, pose, model, &TensionRule::default())
        }
    }
}

/// True if the tensions of a robot at a pose are a matter of its load alone: as many cables as degrees of freedom.
pub(super) fn has_unique_tensions(robot: &Robot, pose: &Pose, model: StaticModel) -> bool {
    ConstraintAtPose::of(robot, pose, model) == ConstraintAtPose::Full
}

/// Ways in which cables constrain the platform at a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ConstraintAtPose {
    /// Fewer cables than degrees of freedom: they hold only some poses.
    Under,
    /// As many cables as degrees of freedom: one set of tensions.
    Full,
    /// More cables than independent directions, which balance the load: the tensions are a matter of choice.
    Redundant,
}

impl ConstraintAtPose {
    fn of(robot: &Robot, pose: &Pose, model: StaticModel) -> Self {
        match robot.constraint() {
            Constraint::Redundantly(_) => Self::Redundant,
            Constraint::Fully if ideal::is_determinate(robot, pose) => Self::Full,
            _ if has_choice(robot, pose, model) => Self::Redundant,
            Constraint::Fully => Self::Full,
            Constraint::Under(_) => Self::Under,
        }
    }
}

/// Refuses a given tension rule that has had nothing to choose, because the state alone determines the tensions.
fn refuse_idle_rule(robot: &Robot, found: &Solution) -> Result<(), StaticsError> {
    match &robot.state {
        State::Pose(_) if found.rule.is_none() => {
            let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
            Err(StaticsError::NothingToChoose { cables, dof })
        }
        State::Lengths(_) => Err(StaticsError::RuleOfLengths),
        State::Pose(_) | State::Unknown => Ok(()),
    }
}
