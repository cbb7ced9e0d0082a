//! The equilibrium of a robot at its state, whichever way the state is given.

use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::forward::forward;
use super::inverse::inverse;
use super::model::StaticModel;
use super::nearest::nearest;
use super::tension::{TensionRule, distribute};
use crate::robot::{Pose, Robot, State};

/// A robot's equilibrium, and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// The equilibrium.
    pub equilibrium: Equilibrium,
    /// The pose asked, where fewer cables than freedoms hold only the nearest to it, and how far that is [m], by
    /// [`distance`](super::distance).
    pub instead_of: Option<(Pose, f64)>,
    /// The rule that the tensions were chosen by, where there was a choice.
    pub rule: Option<TensionRule>,
}

/// The equilibrium at [`Robot::state`]: of lengths the pose ([`forward`]), of a pose the lengths ([`inverse`]; of more
/// cables than freedoms by a rule, [`distribute`]; of fewer the nearest pose, [`nearest`]).
///
/// # Errors
/// [`StaticsError`]; [`StaticsError::NoState`] of a robot without state, [`StaticsError::NothingToChoose`] for a rule that
/// has no choice.
///
/// # Example
/// ```
/// use funicular::robot::{Pose, Robot, State};
/// use funicular::statics::{self, StaticModel, TensionRule};
///
/// let mut robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// robot.state = State::Pose(Pose::new([1.0, 2.0, 1.5], [0.0; 3]));
/// let rest = statics::rest(&robot, StaticModel::Catenary, None)?;
/// assert_eq!(rest.rule, Some(TensionRule::Lowest)); // eight cables for six freedoms leave a choice
/// assert!(rest.instead_of.is_none() && rest.equilibrium.residual < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rest(robot: &Robot, model: StaticModel, rule: Option<TensionRule>) -> Result<Rest, StaticsError> {
    let (cables, freedoms) = (robot.cables.len(), robot.platform.freedoms.count());
    let found = |equilibrium| Rest { equilibrium, instead_of: None, rule: None };
    match &robot.state {
        State::Pose(pose) if cables > freedoms => {
            let rule = rule.unwrap_or_default();
            let equilibrium = distribute(robot, pose, model, &rule)?;
            Ok(Rest { rule: Some(rule), ..found(equilibrium) })
        }
        State::Pose(_) if rule.is_some() => Err(StaticsError::NothingToChoose { cables, freedoms }),
        State::Lengths(_) if rule.is_some() => Err(StaticsError::RuleOfLengths),
        State::Lengths(lengths) => Ok(found(forward(robot, lengths, model, None)?)),
        State::Pose(pose) if cables < freedoms => {
            let nearest = nearest(robot, pose, model)?;
            Ok(Rest { instead_of: Some((*pose, nearest.distance)), ..found(nearest.equilibrium) })
        }
        State::Pose(pose) => Ok(found(inverse(robot, pose, model)?)),
        State::Unknown => Err(StaticsError::NoState),
    }
}
