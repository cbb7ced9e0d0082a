//! Payload: the minimum and the maximum mass that the cables hold at a pose in addition to the platform, all tensions
//! within their limits.
//!
//! The weight of the payload is the multiple of a wrench, whose extreme is searched ([`RaySearch`]). Every set of
//! tensions within the limits counts, whatever a rule would choose.

use super::TensionRule;
use super::ray::{CONVERGED, LimitAtCable, RayEnd, RaySearch, WrenchRay, equilibrium_of, limits_reached};
use crate::math::{Vec3, Vec6};
use crate::platform::{Coordinates, wrench_of};
use crate::robot::{Load, Pose, Robot};
use crate::statics::equilibrium::{CableState, Equilibrium};
use crate::statics::error::StaticsError;
use crate::statics::exit_points;
use crate::statics::free_motion::unopposed;
use crate::statics::model::StaticModel;

/// Payload that the cables hold at a pose: the minimum or the maximum.
#[derive(Debug, Clone, PartialEq)]
pub struct PayloadBound {
    /// Mass [kg]. The maximum is infinite if no maximum tension limits it. It is negative if the platform is too heavy
    /// without a payload.
    pub mass: f64,
    /// Cables with this payload; empty for an infinite mass.
    pub cables: Vec<CableState>,
    /// Tensions at their limits, in the order of the file; empty for an infinite mass.
    pub limits: Vec<LimitAtCable>,
    /// Residual of the balance with this payload, as [`Equilibrium::residual`].
    pub residual: f64,
    /// Number of iterations.
    pub iterations: usize,
    /// Mass [kg], slightly beyond [`Self::mass`], from which on it is proved that no tensions within the limits hold
    /// the payload, however the cables sag; `None` if no proof was requested or found.
    pub excluded_from: Option<f64>,
}

/// Side of the range of payloads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PayloadSide {
    /// Minimum payload, at least zero.
    Minimum,
    /// Maximum payload. It may be negative, down to minus the mass of the platform.
    Maximum,
}

impl PayloadSide {
    fn sign(self) -> f64 {
        match self {
            Self::Minimum => -1.0,
            Self::Maximum => 1.0,
        }
    }
}

/// Payload to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RequestedPayload {
    /// Centre of mass of the payload, platform frame [m].
    pub center_p: Vec3,
    /// Side of the range.
    pub side: PayloadSide,
    /// Attempt the proof that no payload beyond the result is possible.
    pub prove: bool,
}

/// Minimum or maximum payload that cables within their limits hold at a pose, over all possible tensions; with as many
/// cables as degrees of freedom the tensions of each payload are unique.
///
/// The limits are those of [`TensionRange`](super::super::TensionRange) for the robot without payload. `start` is an
/// equilibrium at the pose, from which the search starts; a search without it starts from low tensions.
///
/// If cables sag, the balance is not linear. The result is then a local extremum, which
/// [`PayloadBound::excluded_from`] shows to be the global one.
///
/// # Errors
/// [`StaticsError`]: fewer cables than degrees of freedom, coinciding ends, a singular pose, limits that exclude each
/// other, a payload without weight, no payload at which tensions are within the limits, or no convergence.
///
/// # Example
/// ```
/// # use funicular::{math::Vec3, robot::{Pose, Robot, TensionLimits}};
/// # use funicular::statics::{self, PayloadSide, RequestedPayload, StaticModel};
/// let limits = TensionLimits { minimum: Some(50.0), maximum: Some(5000.0) };
/// let robot = Robot::from_toml(funicular_robots::COGIRO)?.with_tension_limits(limits);
/// let pose = Pose::new([1.0, 2.0, 1.5], [0.0; 3]);
/// let center_p = robot.platform.center_of_mass_p;
/// let requested = RequestedPayload { center_p, side: PayloadSide::Maximum, prove: true };
/// let found = statics::payload_bound(&robot, &pose, StaticModel::Catenary, requested, None)?;
/// assert!(found.mass > 100.0 && found.excluded_from < Some(1.001 * found.mass) && !found.limits.is_empty());
/// // The payload is held, and one that is heavier by a thousandth is not.
/// let with = |mass: f64| statics::inverse(&robot.with_mass(robot.platform.mass + mass), &pose, StaticModel::Catenary);
/// assert!(with(0.999 * found.mass).is_ok() && with(1.001 * found.mass).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
/// docs/theory.md, equations (40c) to (40e).
pub fn payload_bound(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    requested: RequestedPayload,
    start: Option<&Equilibrium>,
) -> Result<PayloadBound, StaticsError> {
    if !exit_points::depend_on_tensions(robot, model) {
        return at_exit_points(robot, pose, model, requested, start);
    }
    let solve = |held: &Robot, _: Option<&PayloadBound>| at_exit_points(held, pose, model, requested, start);
    exit_points::with_places(robot, pose, model, solve, |bound| &mut bound.cables, &[])
}

/// Payload by [`payload_bound`] of cables that end at fixed points.
fn at_exit_points(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    requested: RequestedPayload,
    start: Option<&Equilibrium>,
) -> Result<PayloadBound, StaticsError> {
    let g = robot.gravity_w.norm();
    let coordinates = Coordinates::of(robot);
    let lever_w = pose.rot_wp * requested.center_p;
    let unit = coordinates.reduce(&wrench_of(&-robot.up_w(), &lever_w));
    // Rounding of a direction that is out of the plane of a planar platform.
    if g == 0.0 || unit.norm() < 1e-12 {
        return Err(StaticsError::WeightlessPayload);
    }

    let mut cables = super::cables_at(robot, pose, model, &TensionRule::Lowest)?;
    if let Some(start) = start {
        super::start_from(&mut cables, start);
    }

    let least = match requested.side {
        PayloadSide::Minimum => 0.0,
        PayloadSide::Maximum => -robot.platform.mass * g,
    };
    let ray = WrenchRay { unit, sign: requested.side.sign(), least };
    let mut search = RaySearch::new(robot, pose, model, cables, ray);
    let end = search.extreme()?.ok_or(StaticsError::NoPayload)?;
    if end.multiple.abs() <= CONVERGED * search.size()
        && let Some(motion) = unopposed(robot, pose, &unit)
    {
        return Err(StaticsError::UnbalancedPayload { motion: motion.to_string() });
    }
    Ok(collect_bound(search, (robot, pose, model), requested, &end))
}

/// Result with the cables as they hang with the extreme payload.
fn collect_bound(
    search: RaySearch,
    (robot, pose, model): (&Robot, &Pose, StaticModel),
    requested: RequestedPayload,
    end: &RayEnd,
) -> PayloadBound {
    let (g, iterations) = (robot.gravity_w.norm(), search.iterations());
    if end.unlimited && requested.side == PayloadSide::Maximum {
        let (cables, limits) = (Vec::new(), Vec::new());
        return PayloadBound { mass: f64::INFINITY, cables, limits, residual: 0.0, iterations, excluded_from: None };
    }

    let excluded_from = if requested.prove { search.excluded_from(end).map(|weight| weight / g) } else { None };
    let cables = search.into_cables_at(end);

    let limits = limits_reached(&cables, &end.held_by);
    let mass = end.multiple / g + 0.0;
    let loaded = with_weight(robot, pose, &requested.center_p, end.multiple);
    let rest = equilibrium_of(&loaded, pose, model, cables, iterations);
    PayloadBound { mass, cables: rest.cables, limits, residual: rest.residual, iterations, excluded_from }
}

/// Robot with a payload of this weight [N] as a part of its load: the wrench at this pose is that of both.
pub(in crate::statics) fn with_weight(robot: &Robot, pose: &Pose, center_p: &Vec3, weight: f64) -> Robot {
    let force_w = robot.up_w() * -weight;
    let Load { force_w: own_force_w, moment_w, point_p } = robot.load;
    let arm_w = pose.rot_wp * (center_p - point_p);
    robot.with_load(Load { force_w: own_force_w + force_w, moment_w: moment_w + arm_w.cross(&force_w), point_p })
}

/// Robot with a wrench in addition to its load, world axes about the platform origin (N, N m).
pub(in crate::statics) fn with_wrench(robot: &Robot, pose: &Pose, wrench_w: &Vec6) -> Robot {
    let (force_w, about_origin_w) = (wrench_w.fixed_rows::<3>(0), wrench_w.fixed_rows::<3>(3));
    let Load { force_w: own_force_w, moment_w, point_p } = robot.load;
    let arm_w = pose.rot_wp * point_p;
    let moment_w = moment_w + about_origin_w - arm_w.cross(&force_w.into_owned());
    robot.with_load(Load { force_w: own_force_w + force_w, moment_w, point_p })
}
