//! Tension distribution: inverse statics for more cables than degrees of freedom. Of all tensions that hold the
//! platform, a rule chooses the best within the limits.
//!
//! The unknown of every cable is its tension τ parallel to the chord. The balance is linear in the tensions apart from
//! the small vertical contribution of the sag. So the balance is linearised about the last tensions, the linear problem
//! is solved, and so on (sequential quadratic programming). The linear problem is solved in the null space of the
//! balance, which has one or two dimensions for most robots: this takes microseconds, a general solver a tenth of a
//! millisecond. With many cables it is solved in the space of the cables instead, see [`feasible_set`].

mod balanced_pull;
mod bounds;
mod centre;
mod feasible_set;
mod holding;
mod null_space;
mod payload;
mod proof;
mod ray;
mod search;
mod stiffest;

use super::collect::without_stability;
use super::equilibrium::Equilibrium;
use super::error::RopeRefusal;
use super::error::StaticsError;
use super::exit_points;
use super::free_motion::{has_choice, independent_directions};
use super::ideal;
use super::limits::{LimitViolation, TensionRange};
use super::model::StaticModel;
pub(super) use super::obstacle::Obstacle;
use super::ropes;
use super::wrench_set::CableAtPose;
use crate::drive::CableAtRest;
use crate::platform::{Coordinates, load_size};
use crate::robot::{Cable, Pose, Robot};
pub(super) use balanced_pull::balanced_pull;
pub(crate) use centre::along::PlatformAlong;
pub(crate) use centre::curve::{TauLimit, TauLimitKind, TensionCurve};
pub(crate) use centre::rates::RatesRow;
pub use centre::rates::{CentreMotion, CentreRates, centre_rates};
pub(crate) use centre::{CentreCable, CentreLoad, CentreRow, CentreSearch, Potential};
pub use centre::{CentreCertificate, TensionCentre, tension_centre};
pub use holding::HeldTensions;
pub(crate) use holding::tension_margins;
pub use payload::{PayloadBound, PayloadSide, RequestedPayload, payload_bound};
pub(super) use payload::{with_weight, with_wrench};
pub use ray::LimitAtCable;
pub(super) use ray::{RaySearch, WrenchRay, equilibrium_of, limits_reached};
use search::TensionSearch;

/// Rule that selects one of all possible tension distributions of a robot with more cables than degrees of freedom.
///
/// The rules compare the tension τ of each cable parallel to its chord, (10a), which is between those of its ends. The
/// limits hold for the complete cable, both ends and the drum included. Over a pulley τ is that of the free span, and
/// the rule compares tensions at the exit points of its result.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TensionRule {
    /// Lowest tensions: minimum sum of squares of the excess over the minimum, (38).
    #[default]
    Lowest,
    /// Tensions closest to a target [N], one for all cables or one per cable, in least squares.
    Closest(Vec<f64>),
    /// Tensions farthest from the limits: maximum of the smallest [`TensionMargin::relative`](super::TensionMargin),
    /// (39). Of equal solutions the one nearest to the middles. Needs a maximum for every cable.
    Middle,
    /// Centre of the tensions within the limits: minimum of `−Σ ln(τ − α) + ln(β − τ)`, α and β being the limits of τ,
    /// (40b1). The only rule whose tensions and lengths are smooth functions of the pose and of every number: for paths
    /// and controllers. Needs a maximum for every cable; [`tension_centre`] gives more of it.
    Centre,
    /// Stiffest tensions: maximum of the minimum eigenvalue of the scaled stiffness, (40), which
    /// [`Stability`](super::Stability) gives. Needs elastic cables and a maximum for every cable.
    Stiffest,
}

impl TensionRule {
    /// Name in commands and files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lowest => "lowest",
            Self::Closest(_) => "closest",
            Self::Middle => "middle",
            Self::Centre => "centre",
            Self::Stiffest => "stiffest",
        }
    }
}

/// Unstrained lengths and tensions that hold the platform at a pose, the tensions within the limits of the robot file
/// and chosen by a rule. For more cables than degrees of freedom; with as many cables [`inverse`](super::inverse) gives
/// the unique solution.
///
/// Accuracy: the balance to [`RESIDUAL_LIMIT`](super::RESIDUAL_LIMIT), the limits to a millionth, and the rule's
/// optimum to a millionth of the tensions (for [`TensionRule::Stiffest`] of the stiffness; its optimum is local if
/// cables sag).
///
/// # Errors
/// [`StaticsError`]: too few cables, coinciding ends, a singular pose, a minimum not below its maximum, missing data
/// for the rule, no tensions within the limits, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{robot::{Pose, Robot}, statics::{self, StaticModel, TensionRange, TensionRule}};
/// # let robot = Robot::from_toml(funicular_robots::COGIRO)?;
/// let pose = Pose::new([1.0, -2.0, 1.5], [0.0, 0.0, 5.0]);
/// let held = statics::distribute_tensions(&robot, &pose, StaticModel::Catenary, &TensionRule::Closest(vec![400.0]))?;
/// assert!(held.residual <= statics::RESIDUAL_LIMIT);
/// for (i, cable) in held.cables.iter().enumerate() {
///     let margin = TensionRange::of(&robot, i, &cable.chord_w()).margin(cable);
///     assert!(margin.distance() >= -1e-6 * cable.tension_platform);
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
    ropes::check(robot, model)?;
    if !matches!(rule, TensionRule::Lowest | TensionRule::Closest(_)) {
        ropes::refuse(robot, RopeRefusal::Rule)?;
    }
    if *rule == TensionRule::Centre {
        return Ok(tension_centre(robot, pose, model, None)?.equilibrium);
    }
    let solve = |held: &Robot, last: Option<&Equilibrium>| at_exit_points((robot, held), pose, model, rule, last);
    let found = exit_points::equilibrium(robot, pose, model, solve);
    let is_beyond = matches!(found, Err(StaticsError::BeyondLimits(_) | StaticsError::NotFoundWithinLimits { .. }));
    if !is_beyond || !exit_points::depend_on_tensions(robot, model) {
        return found;
    }
    // The first exit points and supports are those of straight cables, with which a load near the limit may not be
    // held: begin with those of the extreme payload instead.
    let at_limit = [PayloadSide::Maximum, PayloadSide::Minimum].into_iter().find_map(|side| {
        let center_p = robot.platform.center_of_mass_p;
        let requested = RequestedPayload { center_p, side, prove: false };
        let bound = payload_bound(robot, pose, model, requested, None).ok()?;
        let is_within = if side == PayloadSide::Maximum { bound.mass >= 0.0 } else { bound.mass <= 0.0 };
        let start = bound.cables.as_slice();
        if !is_within || start.is_empty() {
            return None;
        }
        exit_points::equilibrium_from(robot, pose, model, solve, start).ok()
    });
    at_limit.map_or_else(|| found.map_err(with_held_exits), Ok)
}

/// Error of a search that held the exit points of the pulleys and says so in its proof.
fn with_held_exits(mut error: StaticsError) -> StaticsError {
    if let StaticsError::BeyondLimits(LimitViolation { missing: Some(missing), .. }) = &mut error {
        missing.holds_exits = true;
    }
    error
}

/// Tensions by [`distribute_tensions`] of cables that end at fixed points. `last` is the result for points nearby, from
/// which a search for the nearest tensions starts; it has one optimum. `whole` is the robot whose exit points `robot`
/// holds: limits of the free spans keep the drums within the limits of the whole cables, to which the rule `middle`
/// refers.
fn at_exit_points(
    (whole, robot): (&Robot, &Robot),
    pose: &Pose,
    model: StaticModel,
    rule: &TensionRule,
    last: Option<&Equilibrium>,
) -> Result<Equilibrium, StaticsError> {
    let mut start = if robot.has_ropes_over_sheaves() {
        ropes_at(robot, pose, model, rule)?
    } else {
        cables_at(robot, pose, model, rule)?
    };
    if let (Some(last), TensionRule::Lowest | TensionRule::Closest(_)) = (last, rule) {
        start_from(&mut start, last);
    }
    let mut search = TensionSearch::new(robot, pose, model, start);

    match rule {
        TensionRule::Lowest => {
            let minima: Vec<f64> = search.cables().iter().map(|cable| cable.range.minimum).collect();
            search.nearest_to(&minima)?;
        }
        TensionRule::Closest(target) => {
            let first: Vec<usize> = search.cables().iter().map(|cable| cable.index).collect();
            let target: Vec<f64> = first.into_iter().map(|i| target[i % target.len()]).collect();
            search.nearest_to(&target)?;
        }
        TensionRule::Middle => {
            let cables = search.cables().iter().zip(&whole.cables).enumerate();
            let range = |(i, (at_pose, cable)): (usize, (&CableAtPose, &Cable))| {
                TensionRange::with_limits(robot, i, cable.limits(), &at_pose.hanging.chord_w())
            };
            let widths: Vec<f64> = cables.map(range).map(|range| range.maximum - range.minimum).collect();
            search.middle_of(&widths)?;
        }
        TensionRule::Stiffest => stiffest::search(&mut search)?,
        TensionRule::Centre => unreachable!("it lets the exit points follow, and does not hold them"),
    }

    let iterations = search.iterations();
    let held = search.into_cables();
    if model == StaticModel::Ideal {
        let tensions: Vec<f64> = held.iter().map(CableAtPose::tau).collect();
        return Ok(ideal::collect(robot, *pose, &tensions, iterations));
    }

    let mut held: Vec<&CableAtPose> = held.iter().flat_map(CableAtPose::all).collect();
    held.sort_by_key(|cable| cable.index);
    let lengths: Vec<f64> = held.iter().map(|cable| cable.hanging.catenary.rope().unstrained_length).collect();
    let hanging = held.into_iter().map(|cable| CableAtRest::fixed(cable.hanging.clone())).collect();
    Ok(without_stability(robot, *pose, model, hanging, &lengths, iterations))
}

/// Gives cables at a pose the tensions of an equilibrium.
pub(super) fn start_from(cables: &mut [CableAtPose], equilibrium: &Equilibrium) {
    for cable in cables {
        let state = &equilibrium.cables[cable.index];
        let tau = state.hanging.as_ref().map_or(state.tension_platform, |of| of.catenary.parallel_tension());
        cable.set(tau.max(cable.slackest));
    }
}

/// Cables at a pose, taut, with their limits.
///
/// # Errors
/// Fewer cables than degrees of freedom, a pose that the platform cannot have, coinciding ends, or limits or data that
/// the rule excludes.
pub(super) fn cables_at(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    rule: &TensionRule,
) -> Result<Vec<CableAtPose>, StaticsError> {
    ropes::refuse(robot, RopeRefusal::Analysis)?;
    if robot.constraint().is_under() && !has_choice(robot, pose, model) {
        let (cables, dof) = (robot.cables.len(), robot.platform.motion.count());
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
        (0..robot.cables.len()).map(|i| CableAtPose::new(robot, i, pose, model, coordinates)).collect();
    check(robot, model, rule, &cables_at_pose)?;
    Ok(cables_at_pose)
}

/// Ropes at a pose, taut, with their limits; cables of one rope over sheaves have one tension. Without limits if there
/// are as many ropes as degrees of freedom, whose tensions are unique.
///
/// # Errors
/// As [`cables_at`].
fn ropes_at(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    rule: &TensionRule,
) -> Result<Vec<CableAtPose>, StaticsError> {
    robot.platform.motion.check(pose)?;
    if let Some(cable) = robot.cables.iter().find(|cable| cable.chord_w(pose).norm() == 0.0) {
        return Err(StaticsError::CoincidingEnds { cable: cable.name.clone() });
    }

    let (coordinates, is_limited) = (Coordinates::of(robot), robot.constraint().is_redundant());
    let at = |i: usize| CableAtPose::new(robot, i, pose, model, coordinates);
    let groups = robot.cables_of_ropes();
    let cables: Vec<CableAtPose> = (0..robot.cables.len()).map(at).collect();
    if is_limited {
        check(robot, model, rule, &cables)?;
    }
    let share = load_size(robot) / robot.cables.len() as f64;
    let rope = |group: &Vec<usize>| {
        let first = at(group[0]);
        let tau = first.tau().max(share);
        first.with_others(group[1..].iter().map(|i| at(*i)).collect(), is_limited, tau)
    };
    Ok(groups.iter().map(rope).collect())
}

/// Maximum number of cables for the rule `stiffest`, whose steps are taken in the null space of the balance: a hundred
/// cables take a third of a second, two hundred some seconds.
const MAX_CABLES_TO_STIFFEN: usize = 200;

/// Refuses limits that no tension can satisfy, and rules without the data that they need.
fn check(
    robot: &Robot,
    model: StaticModel,
    rule: &TensionRule,
    cables_at_pose: &[CableAtPose],
) -> Result<(), StaticsError> {
    if let TensionRule::Closest(target) = rule {
        let cables = robot.cables.len();
        if target.len() != 1 && target.len() != cables {
            return Err(StaticsError::TargetCount { given: target.len(), cables });
        }
        if let Some(value) = target.iter().copied().find(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(StaticsError::TargetTension { value });
        }
    }

    if *rule == TensionRule::Stiffest && model == StaticModel::Ideal {
        return Err(StaticsError::StiffestNeedsElastic);
    }
    if *rule == TensionRule::Stiffest && independent_directions(robot) < robot.platform.motion.count() {
        return Err(StaticsError::StiffestNeedsSpread);
    }
    if *rule == TensionRule::Stiffest && robot.cables.len() > MAX_CABLES_TO_STIFFEN {
        return Err(StaticsError::TooManyToStiffen { cables: robot.cables.len(), limit: MAX_CABLES_TO_STIFFEN });
    }

    for (cable, at_pose) in robot.cables.iter().zip(cables_at_pose) {
        let (cable, minimum, maximum) = (cable.name.clone(), at_pose.range.minimum, at_pose.range.maximum);
        if minimum >= maximum {
            return Err(StaticsError::LimitsExclude { cable, minimum, maximum });
        }
        if maximum.is_infinite() && matches!(rule, TensionRule::Middle | TensionRule::Centre | TensionRule::Stiffest) {
            return Err(StaticsError::NeedsMaximum { cable, rule: rule.name() });
        }
    }
    Ok(())
}
