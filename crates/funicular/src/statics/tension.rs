//! Pose to unstrained lengths and tensions for more cables than degrees of freedom: of all tensions that hold the platform, those
//! within the limits that a rule prefers.
//!
//! The unknown of every cable is its tension τ parallel to the chord. The balance is linear in them but for the small
//! vertical share of the sag; so it is linearised about the last tensions, the best solution of the linear problem is
//! taken, and so on (sequential quadratic programming). The linear problem is solved in the null space of the balance,
//! which has one or two dimensions in most robots: it takes microseconds, a general solver a tenth of a millisecond.
//! With many cables it is solved in the space of the cables instead, see [`room`].

mod active_set;
mod bounds;
mod cable_at_pose;
mod feasible_set;
mod null_space;
mod proof;
mod search;
mod stiffest;

use super::collect::collect;
use super::equilibrium::Equilibrium;
use super::error::StaticsError;
use super::ideal;
use super::model::StaticModel;
use crate::platform::Coordinates;
use crate::robot::{Pose, Robot};
use cable_at_pose::CableAtPose;
use search::TensionSearch;

/// Which of all possible tensions a robot with more cables than degrees of freedom shall have.
///
/// What a rule weighs is the tension τ of each cable parallel to its chord, (10a), which is between those of its ends;
/// limits hold for the whole cable, both ends included.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TensionRule {
    /// As low as possible: the least sum of squares of what is above the minimum, (38).
    #[default]
    Lowest,
    /// As near as possible to a wanted tension [N], one for all or one a cable, in least squares.
    Closest(Vec<f64>),
    /// As far as possible from the limits: the largest least [`TensionMargin::relative`](super::TensionMargin), (39).
    /// Of equals the nearest to the middles. Needs a maximum for every cable.
    Middle,
    /// As stiff as possible: the largest least eigenvalue of the scaled stiffness, (40), which is
    /// [`Stability`](super::Stability)'s. Needs elastic cables and a maximum for every one.
    Stiffest,
}

impl TensionRule {
    /// Name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lowest => "lowest",
            Self::Closest(_) => "closest",
            Self::Middle => "middle",
            Self::Stiffest => "stiffest",
        }
    }
}

/// The unstrained lengths and tensions that hold the platform at a pose, the tensions within the limits of the robot
/// file and chosen by a rule. More cables than degrees of freedom; with as many, [`inverse`](super::inverse) has the only answer.
///
/// The balance holds to [`RESIDUAL_LIMIT`](super::RESIDUAL_LIMIT), the limits to a millionth, and the rule's
/// optimum to a millionth of the tensions (of the stiffness for [`TensionRule::Stiffest`], whose optimum is local where cables sag).
///
/// # Errors
/// [`StaticsError`]: too few cables, coinciding ends, a singular pose, limits that exclude each other, a rule that needs
/// more than it is given, no tensions within the limits, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel, TensionRange, TensionRule}};
/// # let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let pose = Pose::new([1.0, -2.0, 1.5], [0.0, 0.0, 5.0]);
/// let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Closest(vec![400.0]))?;
/// assert!(held.residual <= statics::RESIDUAL_LIMIT);
/// for (i, cable) in held.cables.iter().enumerate() {
///     assert!(TensionRange::of(&robot, i, &cable.chord_w()).margin(cable).distance() >= -1e-6 * cable.tension_platform);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (36) to (40b).
pub fn distribute_tensions(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    rule: &TensionRule,
) -> Result<Equilibrium, StaticsError> {
    let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
    if cables < dof {
        return Err(StaticsError::InverseCableCount { cables, dof });
    }

    robot.platform.motion.check(pose)?;
    for cable in &robot.cables {
        if cable.chord_w(pose).norm() == 0.0 {
            return Err(StaticsError::CoincidingEnds { cable: cable.name.clone() });
        }
    }

    let coordinates = Coordinates::of(robot);
    let cables_at_pose: Vec<CableAtPose> =
        (0..cables).map(|i| CableAtPose::new(robot, i, pose, model, coordinates)).collect();
    check(robot, model, rule, &cables_at_pose)?;
    let mut search = TensionSearch::new(robot, pose, cables_at_pose);

    match rule {
        TensionRule::Lowest => {
            let minima: Vec<f64> = search.cables().iter().map(|cable| cable.range.minimum).collect();
            search.nearest_to(&minima)?;
        }
        TensionRule::Closest(wanted) => {
            let wanted: Vec<f64> = wanted.iter().copied().cycle().take(cables).collect();
            search.nearest_to(&wanted)?;
        }
        TensionRule::Middle => search.middle()?,
        TensionRule::Stiffest => stiffest::search(&mut search)?,
    }

    let iterations = search.iterations();
    let held = search.into_cables();
    if model == StaticModel::Ideal {
        let tensions: Vec<f64> = held.iter().map(CableAtPose::tau).collect();
        return Ok(ideal::collect(robot, *pose, &tensions, iterations));
    }

    let lengths: Vec<f64> = held.iter().map(|cable| cable.hanging.catenary.rope().unstrained_length).collect();
    let hanging = held.into_iter().map(|cable| cable.hanging).collect();
    Ok(collect(robot, *pose, model, hanging, &lengths, iterations))
}

/// Most cables of the rule `stiffest`, whose steps are taken in the null space of the balance: a hundred cables take a third
/// of a second, two hundred some seconds.
const MAX_CABLES_TO_STIFFEN: usize = 200;

/// Refuses what no tension can satisfy and what a rule does not know enough for.
fn check(
    robot: &Robot,
    model: StaticModel,
    rule: &TensionRule,
    cables_at_pose: &[CableAtPose],
) -> Result<(), StaticsError> {
    if let TensionRule::Closest(wanted) = rule {
        let cables = robot.cables.len();
        if wanted.len() != 1 && wanted.len() != cables {
            return Err(StaticsError::WantedCount { given: wanted.len(), cables });
        }
        if let Some(value) = wanted.iter().copied().find(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(StaticsError::Wanted { value });
        }
    }

    if *rule == TensionRule::Stiffest && model == StaticModel::Ideal {
        return Err(StaticsError::StiffestNeedsElastic);
    }
    if *rule == TensionRule::Stiffest && robot.cables.len() > MAX_CABLES_TO_STIFFEN {
        return Err(StaticsError::TooManyToStiffen { cables: robot.cables.len(), limit: MAX_CABLES_TO_STIFFEN });
    }

    for (cable, at_pose) in robot.cables.iter().zip(cables_at_pose) {
        let (cable, minimum, maximum) = (cable.name.clone(), at_pose.range.minimum, at_pose.range.maximum);
        if minimum >= maximum {
            return Err(StaticsError::LimitsExclude { cable, minimum, maximum });
        }
        if maximum.is_infinite() && matches!(rule, TensionRule::Middle | TensionRule::Stiffest) {
            return Err(StaticsError::NeedsMaximum { cable, rule: rule.name() });
        }
    }
    Ok(())
}
