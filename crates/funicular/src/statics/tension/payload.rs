//! Payload: the minimum and the maximum mass that the cables hold at a pose in addition to the platform, all tensions
//! within their limits.
//!
//! The weight of the payload is one more unknown of the balance, beside the tensions, and the objective is this
//! unknown. The balance and the limits are linearised about the last tensions, the linear problem is solved exactly,
//! and so on: with straight cables one step is the solution, with sagging cables three to five are. Every set of
//! tensions within the limits counts, whatever a rule would choose.

use super::TensionRule;
use super::cable_at_pose::{CableAtPose, TensionPlace};
use super::feasible_set::{FeasiblePoint, FeasibleSet, MIN_DIRECTIONS_IN_CABLE_SPACE};
use super::null_space::Solutions;
use super::proof::{Infeasibility, ReachableTensions};
use super::search::{HOLDS, Linear, ProximalStep, ProximalStepControl, TauBound, TensionSearch};
use crate::drive::CableAtRest;
use crate::math::active_set::Active;
use crate::math::{Vec3, Vec6};
use crate::platform::{Coordinates, load_wrench, wrench_of};
use crate::robot::{Load, Pose, Robot};
use crate::statics::collect::collect;
use crate::statics::equilibrium::{CableState, Equilibrium};
use crate::statics::error::StaticsError;
use crate::statics::exit_points;
use crate::statics::free_motion::unopposed;
use crate::statics::ideal;
use crate::statics::limits::Limit;
use crate::statics::model::StaticModel;

/// Maximum number of iterations: robots of the library take 2 to 6.
const MAX_ITERATIONS: usize = 100;

/// Change of tensions and payload weight in a step, over their size, at which the iteration ends.
const CONVERGED: f64 = 1e-10;

/// Relative distance within which a tension counts as at its limit, in the list of limits that bind.
const AT_LIMIT: f64 = 1e-6;

/// Payload weights beyond the extreme one, over the size of the tensions, for which the proof is attempted, nearest
/// first. The shares of sagging cables are not quite concave in the tension. This costs some 1e-5 for taut
/// cables, and up to 1e-3 for robots whose lower cables are nearly slack.
const BEYOND: [f64; 7] = [1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3];

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

/// Tension at its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitAtCable {
    /// Index of the cable.
    pub cable: usize,
    /// Limit that is reached.
    pub limit: Limit,
    /// Place in the cable where it is reached.
    pub place: TensionPlace,
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

    let search = TensionSearch::new(robot, pose, model, cables);
    let mut payload = PayloadSearch { robot, pose, search, unit, requested, iterations: 0 };
    let optimum = payload.extreme()?;
    if optimum.weight.abs() <= CONVERGED * payload.search.size()
        && let Some(motion) = unopposed(robot, pose, &payload.unit)
    {
        return Err(StaticsError::UnbalancedPayload { motion: motion.to_string() });
    }
    Ok(payload.collect(model, &optimum))
}

/// Search for the extreme payload.
struct PayloadSearch<'a> {
    robot: &'a Robot,
    pose: &'a Pose,
    search: TensionSearch<'a>,
    /// Wrench of a payload per newton of its weight, reduced.
    unit: Vec6,
    requested: RequestedPayload,
    iterations: usize,
}

/// Solution of the linear problem.
struct Optimum {
    tau: Vec<f64>,
    /// Weight of the payload [N].
    weight: f64,
    /// Cables whose limits hold the payload back, in the order of the file.
    held_by: Vec<(usize, Limit)>,
    /// True if a cable without a maximum is at its bound for numbers.
    unlimited: bool,
    /// Multipliers of the balance.
    multipliers: Vec6,
}

impl PayloadSearch<'_> {
    fn extreme(&mut self) -> Result<Optimum, StaticsError> {
        let sign = self.requested.side.sign();
        let mut stride = ProximalStepControl::default();
        let mut weight = 0.0;
        while self.iterations < MAX_ITERATIONS {
            self.iterations += 1;

            // Solve the problem linearised about the present tensions.
            let linear = self.search.linearise();
            let Some(optimum) = self.step(&linear, weight, stride.climb)? else {
                return Err(StaticsError::NoPayload);
            };

            // End if nothing changes.
            let size = self.search.size() + optimum.weight.abs();
            let changes = self.search.cables().iter().zip(&optimum.tau);
            let change = changes.fold((optimum.weight - weight).abs(), |most: f64, (cable, tau)| {
                most.max((tau.max(cable.slackest) - cable.tau()).abs())
            }) / size;
            if change.is_nan() {
                break;
            }
            if change <= CONVERGED {
                return Ok(optimum);
            }

            // Take the step, and choose the size of the next.
            stride.next(change, size, sign * optimum.weight);
            self.search.set(&optimum.tau);
            weight = optimum.weight;
        }

        let p = self.pose.position_w;
        Err(StaticsError::TensionsNotConverged {
            iterations: self.iterations,
            change: stride.last_change,
            limit: CONVERGED,
            residual: self.search.linearise().residual,
            x: p.x,
            y: p.y,
            z: p.z,
        })
    }

    /// Solves the linear problem (40c); `None` if no payload satisfies it. With a `climb` the payload changes by a
    /// limited amount instead, and the tensions move little.
    fn step(&self, linear: &Linear, weight: f64, climb: Option<ProximalStep>) -> Result<Option<Optimum>, StaticsError> {
        let cables = self.search.cables();
        let (count, dof) = (cables.len(), self.robot.platform.motion.count());
        let sign = self.requested.side.sign();

        // The weight of the payload is one more column of the balance.
        let mut columns = linear.columns.clone();
        columns.push(self.unit);
        let in_null_space = count + 1 < MIN_DIRECTIONS_IN_CABLE_SPACE + dof;
        let solutions = Solutions::of(&columns, &vec![1.0; count + 1], &linear.right, dof, in_null_space)
            .ok_or_else(|| self.search.singular())?;

        // The limits; a cable without a maximum is bounded by its axial stiffness, at which its length is doubled.
        let mut feasible = FeasibleSet::new(&solutions, true);
        let mut rows = Vec::with_capacity(2 * count + 2);
        for (i, ([lower, upper], cable)) in linear.limits.iter().zip(cables).enumerate() {
            feasible.add(Some(i), 1.0, 0.0, lower.at.max(cable.slackest));
            rows.push(Some((i, Limit::Minimum)));
            let TauBound { at, .. } = *upper;
            let at = if at.is_finite() { at } else { cable.axial_stiffness() };
            feasible.add(Some(i), -1.0, 0.0, -at);
            rows.push(Some((i, Limit::Maximum)));
        }

        // The objective t ≤ ±weight, and the minimum weight.
        feasible.add(Some(count), sign, -1.0, 0.0);
        rows.push(None);
        let lightest = match self.requested.side {
            PayloadSide::Minimum => 0.0,
            PayloadSide::Maximum => -self.robot.platform.mass * self.robot.gravity_w.norm(),
        };
        feasible.add(Some(count), 1.0, 0.0, lightest);
        rows.push(None);

        // Extreme weight.
        let tolerance = self.search.tolerance(&solutions);
        let here = |i: usize| if i < count { cables[i].tau() } else { weight };
        let found = match climb {
            None => feasible.highest(here, tolerance),
            Some(climb) => feasible.nearest(here, climb.from + climb.by, tolerance),
        };
        let Some(FeasiblePoint { sigma: mut tau, held, .. }) = found else { return Ok(None) };
        let weight = tau.pop().unwrap_or(0.0);

        Ok(Some(self.optimum(tau, weight, &held, &rows, &solutions)))
    }

    /// Extreme weight with the limits that hold it back and the multipliers of the balance. `held` are the active
    /// inequalities; `rows` are the limits of all inequalities.
    fn optimum(
        &self,
        tau: Vec<f64>,
        weight: f64,
        held: &[Active],
        rows: &[Option<(usize, Limit)>],
        solutions: &Solutions,
    ) -> Optimum {
        let (cables, sign) = (self.search.cables(), self.requested.side.sign());
        let count = cables.len();
        let strongest = held.iter().fold(0.0, |most: f64, held| most.max(held.multiplier));
        let mut pressed = vec![0.0; count + 1];
        let (mut held_by, mut unlimited) = (Vec::new(), false);
        for held in held {
            match rows[held.row] {
                Some((i, limit)) => {
                    pressed[i] += if limit == Limit::Minimum { held.multiplier } else { -held.multiplier };
                    if held.multiplier > HOLDS * strongest {
                        held_by.push((i, limit));
                        unlimited |= limit == Limit::Maximum && cables[i].range.maximum.is_infinite();
                    }
                }
                // The row of the objective; that of the minimum weight does not enter the proof.
                None => pressed[count] += if held.row == 2 * count { sign * held.multiplier } else { 0.0 },
            }
        }
        let multipliers = solutions.multipliers(|i| -pressed[i]);

        Optimum { tau, weight, held_by, unlimited, multipliers }
    }

    /// Result with the cables as they hang with the extreme payload.
    fn collect(self, model: StaticModel, optimum: &Optimum) -> PayloadBound {
        let g = self.robot.gravity_w.norm();
        let iterations = self.iterations;
        if optimum.unlimited && self.requested.side == PayloadSide::Maximum {
            let (cables, limits) = (Vec::new(), Vec::new());
            return PayloadBound {
                mass: f64::INFINITY,
                cables,
                limits,
                residual: 0.0,
                iterations,
                excluded_from: None,
            };
        }

        let excluded_from =
            if self.requested.prove { self.excluded_weight(optimum).map(|weight| weight / g) } else { None };
        let Self { robot, pose, mut search, requested, .. } = self;
        search.set(&optimum.tau);
        let cables = search.into_cables();

        let limits = limits_reached(&cables, &optimum.held_by);
        let mass = optimum.weight / g + 0.0;
        let loaded = with_weight(robot, pose, &requested.center_p, optimum.weight);
        let rest = equilibrium_of(&loaded, pose, model, cables, iterations);
        PayloadBound { mass, cables: rest.cables, limits, residual: rest.residual, iterations, excluded_from }
    }

    /// Weight from which on the multipliers of the balance prove that no payload is possible: (40e).
    fn excluded_weight(&self, optimum: &Optimum) -> Option<f64> {
        let sign = self.requested.side.sign();
        let y = &optimum.multipliers;
        // A payload still farther away makes the sum still more negative.
        if sign * y.dot(&self.unit) >= 0.0 {
            return None;
        }

        let mut cables = self.search.cables().to_vec();
        let reaches: Vec<ReachableTensions> = cables
            .iter_mut()
            .map(|cable| {
                let minimum = cable.at_minimum();
                ReachableTensions::of(cable, minimum)
            })
            .collect();
        let own = Coordinates::of(self.robot).reduce(&load_wrench(self.robot, self.pose));
        let size = self.search.size() + optimum.weight.abs();
        BEYOND.into_iter().map(|beyond| optimum.weight + sign * beyond * size).find(|weight| {
            let load = own + self.unit * *weight;
            Infeasibility { reaches: &reaches, load, motion: self.robot.platform.motion }.is_proof(y)
        })
    }
}

/// Limits that hold a payload back and those that are reached besides, one per cable, in the order of the file.
fn limits_reached(cables: &[CableAtPose], held_by: &[(usize, Limit)]) -> Vec<LimitAtCable> {
    let of_cable = |(i, cable): (usize, &CableAtPose)| {
        let holds = |limit: Limit| held_by.contains(&(i, limit));
        let (range, min, max) = (cable.range, cable.min_tension().value, cable.max_tension().value);
        let limit = if holds(Limit::Maximum) || max >= range.maximum * (1.0 - AT_LIMIT) {
            Limit::Maximum
        } else if holds(Limit::Minimum) || min <= range.minimum * (1.0 + AT_LIMIT) {
            Limit::Minimum
        } else {
            return None;
        };
        Some(LimitAtCable { cable: i, limit, place: cable.place(limit) })
    };
    cables.iter().enumerate().filter_map(of_cable).collect()
}

/// Robot with a payload of this weight [N] as a part of its load: the wrench at this pose is that of both.
fn with_weight(robot: &Robot, pose: &Pose, center_p: &Vec3, weight: f64) -> Robot {
    let force_w = robot.up_w() * -weight;
    let Load { force_w: own_force_w, moment_w, point_p } = robot.load;
    let arm_w = pose.rot_wp * (center_p - point_p);
    robot.with_load(Load { force_w: own_force_w + force_w, moment_w: moment_w + arm_w.cross(&force_w), point_p })
}

fn equilibrium_of(
    robot: &Robot,
    pose: &Pose,
    model: StaticModel,
    cables: Vec<CableAtPose>,
    iterations: usize,
) -> Equilibrium {
    if model == StaticModel::Ideal {
        let tensions: Vec<f64> = cables.iter().map(CableAtPose::tau).collect();
        return ideal::collect(robot, *pose, &tensions, iterations);
    }
    let lengths: Vec<f64> = cables.iter().map(|cable| cable.length()[0]).collect();
    let hanging = cables.into_iter().map(|cable| CableAtRest::fixed(cable.hanging)).collect();
    collect(robot, *pose, model, hanging, &lengths, iterations)
}
