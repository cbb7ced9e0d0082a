//! Extreme multiple of a wrench that the cables hold in addition to the load: the end of a ray in the set of wrenches.
//!
//! The multiple is one more unknown of the balance, beside the tensions, and the objective is this unknown. The balance
//! and the limits are linearised about the last tensions, the linear problem is solved exactly, and so on: with
//! straight cables one step is the solution, with sagging cables three to five are.

use super::feasible_set::{FeasiblePoint, FeasibleSet, MIN_DIRECTIONS_IN_CABLE_SPACE};
use super::null_space::Solutions;
use super::search::{HOLDS, Linear, ProximalStep, ProximalStepControl, TauBound, TensionSearch};
use crate::drive::CableAtRest;
use crate::math::Vec6;
use crate::math::active_set::Active;
use crate::platform::{Coordinates, load_wrench};
use crate::robot::{Pose, Robot};
use crate::statics::collect::collect;
use crate::statics::equilibrium::Equilibrium;
use crate::statics::error::StaticsError;
use crate::statics::ideal;
use crate::statics::limits::Limit;
use crate::statics::model::StaticModel;
use crate::statics::wrench_set::{CableAtPose, ReachableTensions, TensionPlace, WrenchSet};

/// Maximum number of iterations: robots of the library take 2 to 6.
const MAX_ITERATIONS: usize = 100;

/// Change of tensions and multiple in a step, over their size, at which the iteration ends.
pub(in crate::statics) const CONVERGED: f64 = 1e-10;

/// Multiples beyond the extreme one, over the size of the tensions, for which the proof is attempted, nearest first.
/// The shares of sagging cables are not quite concave in the tension. This costs some 1e-5 for taut cables, and up to
/// 1e-3 for robots whose lower cables are nearly slack.
const BEYOND: [f64; 7] = [1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3];

/// Relative distance within which a tension counts as at its limit, in the list of limits that bind.
const AT_LIMIT: f64 = 1e-6;

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

/// Wrench whose multiples are added to the load.
#[derive(Debug, Clone, Copy)]
pub(in crate::statics) struct WrenchRay {
    /// Wrench of the multiple 1 [N], reduced.
    pub unit: Vec6,
    /// 1 for the maximum multiple, -1 for the minimum.
    pub sign: f64,
    /// Minimum multiple that is considered.
    pub least: f64,
}

/// Search for the extreme multiple of a wrench.
pub(in crate::statics) struct RaySearch<'a> {
    robot: &'a Robot,
    pose: &'a Pose,
    search: TensionSearch<'a>,
    ray: WrenchRay,
    iterations: usize,
}

/// Extreme multiple of a wrench.
pub(in crate::statics) struct RayEnd {
    /// Tensions τ [N].
    pub tau: Vec<f64>,
    /// Multiple of the wrench.
    pub multiple: f64,
    /// Cables whose limits bind, in the order of the file.
    pub held_by: Vec<(usize, Limit)>,
    /// True if a cable without a maximum is at its bound for numbers.
    pub unlimited: bool,
    /// Multipliers of the balance.
    pub multipliers: Vec6,
}

impl<'a> RaySearch<'a> {
    /// Search from cables with the tensions of a first guess.
    pub(in crate::statics) fn new(
        robot: &'a Robot,
        pose: &'a Pose,
        model: StaticModel,
        cables: Vec<CableAtPose>,
        ray: WrenchRay,
    ) -> Self {
        Self { robot, pose, search: TensionSearch::new(robot, pose, model, cables), ray, iterations: 0 }
    }

    /// Number of iterations.
    pub(in crate::statics) fn iterations(&self) -> usize {
        self.iterations
    }

    /// Reference size of the tensions [N].
    pub(in crate::statics) fn size(&self) -> f64 {
        self.search.size()
    }

    /// Cables with the tensions of a result.
    pub(in crate::statics) fn into_cables_at(mut self, end: &RayEnd) -> Vec<CableAtPose> {
        self.search.set(&end.tau);
        self.search.into_cables()
    }

    /// Finds the extreme multiple; `None` if no multiple is held.
    ///
    /// # Errors
    /// A singular pose, or no convergence.
    pub(in crate::statics) fn extreme(&mut self) -> Result<Option<RayEnd>, StaticsError> {
        let sign = self.ray.sign;
        let mut stride = ProximalStepControl::default();
        let mut multiple = 0.0;
        while self.iterations < MAX_ITERATIONS {
            self.iterations += 1;

            // Solve the problem linearised about the present tensions.
            let linear = self.search.linearise();
            let Some(optimum) = self.step(&linear, multiple, stride.climb)? else {
                return Ok(None);
            };

            // End if nothing changes.
            let size = self.search.size() + optimum.multiple.abs();
            let changes = self.search.cables().iter().zip(&optimum.tau);
            let change = changes.fold((optimum.multiple - multiple).abs(), |most: f64, (cable, tau)| {
                most.max((tau.max(cable.slackest) - cable.tau()).abs())
            }) / size;
            if change.is_nan() {
                break;
            }
            if change <= CONVERGED {
                return Ok(Some(optimum));
            }

            // Take the step, and choose the size of the next.
            stride.next(change, size, sign * optimum.multiple);
            self.search.set(&optimum.tau);
            multiple = optimum.multiple;
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

    /// Solves the linear problem (40c); `None` if no multiple satisfies it. With a `climb` the multiple changes by a
    /// limited amount instead, and the tensions move little.
    fn step(
        &self,
        linear: &Linear,
        multiple: f64,
        climb: Option<ProximalStep>,
    ) -> Result<Option<RayEnd>, StaticsError> {
        let cables = self.search.cables();
        let (count, dof) = (cables.len(), self.robot.platform.motion.count());
        let WrenchRay { unit, sign, least } = self.ray;

        // The multiple of the wrench is one more unknown, with its column of the balance.
        let mut columns = linear.columns.clone();
        columns.push(unit);
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

        // The objective t ≤ ±multiple, and the minimum multiple.
        feasible.add(Some(count), sign, -1.0, 0.0);
        rows.push(None);
        feasible.add(Some(count), 1.0, 0.0, least);
        rows.push(None);

        // Extreme multiple.
        let tolerance = self.search.tolerance(&solutions);
        let here = |i: usize| if i < count { cables[i].tau() } else { multiple };
        let found = match climb {
            None => feasible.highest(here, tolerance),
            Some(climb) => feasible.nearest(here, climb.from + climb.by, tolerance),
        };
        let Some(FeasiblePoint { sigma: mut tau, held, .. }) = found else { return Ok(None) };
        let multiple = tau.pop().unwrap_or(0.0);

        Ok(Some(self.optimum(tau, multiple, &held, &rows, &solutions)))
    }

    /// Extreme multiple with the limits that bind and the multipliers of the balance. `held` are the active
    /// inequalities; `rows` are the limits of all inequalities.
    fn optimum(
        &self,
        tau: Vec<f64>,
        multiple: f64,
        held: &[Active],
        rows: &[Option<(usize, Limit)>],
        solutions: &Solutions,
    ) -> RayEnd {
        let (cables, sign) = (self.search.cables(), self.ray.sign);
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
                // The row of the objective; that of the minimum multiple does not enter the proof.
                None => pressed[count] += if held.row == 2 * count { sign * held.multiplier } else { 0.0 },
            }
        }
        let multipliers = solutions.multipliers(|i| -pressed[i]);

        RayEnd { tau, multiple, held_by, unlimited, multipliers }
    }

    /// Multiple from which on the multipliers of the balance prove that the cables hold none: (40e).
    pub(in crate::statics) fn excluded_from(&self, end: &RayEnd) -> Option<f64> {
        let WrenchRay { unit, sign, .. } = self.ray;
        let y = &end.multipliers;
        // A multiple still farther away makes the sum still more negative.
        if sign * y.dot(&unit) >= 0.0 {
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
        let set = WrenchSet { reaches: &reaches, motion: self.robot.platform.motion };
        let own = Coordinates::of(self.robot).reduce(&load_wrench(self.robot, self.pose));
        let size = self.search.size() + end.multiple.abs();
        BEYOND
            .into_iter()
            .map(|beyond| end.multiple + sign * beyond * size)
            .find(|multiple| set.separates(y, &(own + unit * *multiple)).0)
    }
}

/// Limits that bind and those that are reached besides, one per cable, in the order of the file.
pub(in crate::statics) fn limits_reached(cables: &[CableAtPose], held_by: &[(usize, Limit)]) -> Vec<LimitAtCable> {
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

/// Equilibrium of cables that hold the load of a robot at a pose.
pub(in crate::statics) fn equilibrium_of(
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
