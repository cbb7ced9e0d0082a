//! Tensions with the minimum violation of the limits, with a proof that no others exist or further starts.

use super::margin::MarginOptimum;
use super::proximal_step::ProximalStepControl;
use super::{HOLDS, MAX_ITERATIONS, TensionSearch, VIOLATION};
use crate::math::order;
use crate::platform::{Coordinates, load_wrench};
use crate::statics::error::StaticsError;
use crate::statics::limits::{Limit, LimitViolation};
use crate::statics::obstacle::Obstacle;
use crate::statics::tension::feasible_set::FeasibleSet;
use crate::statics::tension::proof::Infeasibility;
use crate::statics::wrench_set::{CableAtPose, ReachableTensions, WrenchSet, spread_start};

/// Distance from a limit, over the size of the tensions, from which on an optimum has left the limit: well above
/// [`VIOLATION`], by which the optima are relaxed, and below the millionth to which tensions are given.
const LEAVES: f64 = 1e-7;

/// Maximum number of further starts if neither tensions within the limits nor a proof of their absence is found.
const MAX_STARTS: usize = 12;

impl TensionSearch<'_> {
    /// Moves to the tensions with the minimum violation of the limits; an error if they do violate them.
    ///
    /// Below its minimum a cable is continued by its tangent there. So a cable that would need negative tension has a
    /// violation as well, and the forces have no kink on which linearisations could disagree. If no tension is negative
    /// after all, the violation is computed once more with the cables as they hang.
    ///
    /// The minimum violation may be a local one if cables sag. The pose is refused for good only if a direction proves
    /// it, see [`Infeasibility`]; otherwise the search begins again elsewhere.
    pub(super) fn min_violation(&mut self) -> Result<(), StaticsError> {
        if let Some(tau) = self.rescued.clone() {
            self.set(&tau);
            return Ok(());
        }

        let minima: Vec<f64> = self.cables.iter_mut().map(CableAtPose::at_minimum).collect();
        let mut optimum = self.min_violation_above(&minima)?;
        if optimum.distance >= -VIOLATION * self.size {
            // Such tensions exist; the next linear problem will find them.
            return Ok(());
        }

        let slackest: Vec<f64> = self.cables.iter().map(|cable| cable.slackest).collect();
        if optimum.tau.iter().zip(&slackest).all(|(tau, slackest)| tau > slackest)
            && let Ok(hung) = self.min_violation_above(&slackest)
            && hung.distance < -VIOLATION * self.size
        {
            optimum = hung;
        }

        // The proofs are those of cables of their own.
        if self.robot.has_ropes_over_sheaves() {
            return Err(StaticsError::NotFoundWithinLimits { miss: self.miss(&optimum), starts: 1 });
        }

        // The direction of the limits' multipliers is nearly always a proof.
        let reaches: Vec<ReachableTensions> =
            self.cables.iter().zip(&minima).map(|(cable, tau)| ReachableTensions::of(cable, *tau)).collect();
        let motion = self.robot.platform.motion;
        let load = Coordinates::of(self.robot).reduce(&load_wrench(self.robot, self.pose));
        let claim = Infeasibility { set: WrenchSet { reaches: &reaches, motion }, load };
        let verdict = claim.prove(&optimum.multipliers);
        if let Some(direction) = verdict.direction {
            let mut miss = self.miss(&optimum);
            miss.missing = Some(Box::new(claim.missing(self.robot, &direction)));
            return Err(StaticsError::BeyondLimits(miss));
        }

        // Other starts: the tensions with the maximum contributions in that direction, and others between the limits.
        let mut starts = 1;
        for k in 0..MAX_STARTS {
            starts += 1;
            let start = if k == 0 { verdict.max_shares.clone() } else { spread_start(&reaches, self.size, k) };
            self.set(&start);
            let Ok(found) = self.min_violation_above(&slackest) else { continue };
            if found.distance >= -VIOLATION * self.size {
                self.set(&found.tau);
                self.rescued = Some(found.tau);
                return Ok(());
            }
            if found.distance > optimum.distance {
                optimum = found;
            }
        }
        Err(StaticsError::NotFoundWithinLimits { miss: self.miss(&optimum), starts })
    }

    /// Minimum violation if cables are continued by their tangents below these tensions.
    fn min_violation_above(&mut self, floors: &[f64]) -> Result<MarginOptimum, StaticsError> {
        let mut here = self.tensions();
        let mut stride = ProximalStepControl::default();
        let mut mildest: Option<MarginOptimum> = None;

        for iteration in 0..MAX_ITERATIONS {
            self.iterations += 1;
            let hung: Vec<f64> = here.iter().zip(floors).map(|(tau, floor)| tau.max(*floor)).collect();
            self.set(&hung);

            // Linear problem about tensions at which the cables can hang.
            let linear = self.linearise();
            let optimum = MarginOptimum { hung, ..self.margin_optimum(&linear, None, &here, stride.climb)? };

            let change =
                here.iter().zip(&optimum.tau).fold(0.0, |m: f64, (from, to)| m.max((to - from).abs())) / self.size;
            if change <= VIOLATION {
                return Ok(optimum);
            }

            stride.next(change, self.size, optimum.height);
            here.clone_from(&optimum.tau);
            if iteration > MAX_ITERATIONS / 2 && mildest.as_ref().is_none_or(|mildest| optimum.height > mildest.height)
            {
                mildest = Some(optimum);
            }
        }
        // Very heavy and soft ropes may wander without end. If every linear problem has been infeasible, so is the
        // pose; the smallest violation among them is an estimate.
        mildest
            .filter(|optimum| optimum.distance < -VIOLATION * self.size)
            .ok_or_else(|| self.not_converged(stride.last_change, VIOLATION))
    }

    /// Violation of the limits at the optimum, and the reason why even tensions without limits do not balance the load,
    /// if there is one.
    fn miss(&mut self, optimum: &MarginOptimum) -> LimitViolation {
        let limits = self.limits_in_the_way(optimum);
        let names = |limit: Limit| {
            let of = limits.iter().filter(|(_, which)| *which == limit);
            of.map(|(i, _)| self.robot.cables[self.cables[*i].index].name.clone()).collect()
        };
        LimitViolation {
            by: -optimum.distance,
            minimum_of: names(Limit::Minimum),
            maximum_of: names(Limit::Maximum),
            obstacle: Obstacle::at(self.robot, self.pose, self.model).map(Box::new),
            missing: None,
        }
    }

    /// Limits that every set of tensions with the minimum violation violates by the full amount; see
    /// [`LimitViolation`].
    ///
    /// The multipliers of one optimum give some of them, of a symmetric robot an arbitrary choice. Of the other limits
    /// at which this optimum is, those belong to the list that no optimum can leave. So the smallest distance from
    /// these limits is maximised among the optima: if it is positive, none of them belongs to the list; otherwise its
    /// multipliers name further ones.
    fn limits_in_the_way(&mut self, optimum: &MarginOptimum) -> Vec<(usize, Limit)> {
        // The last step of the search may have been a short one that no limit has stopped: solve its problem again.
        self.set(&optimum.hung);
        let linear = self.linearise();
        let again = self.margin_optimum(&linear, None, &optimum.tau, None);
        let solutions = self.solutions_for_feasible_set(&linear, &vec![1.0; self.cables.len()]);
        let (Ok(there), Ok(solutions)) = (again, solutions) else { return self.limits_at(optimum) };
        if there.held_by.is_empty() {
            return self.limits_at(optimum);
        }

        // Limits of an optimum: sign, tension that is not passed, and whether the optimum is at it.
        let slack = LEAVES * self.size;
        let mut rows: Vec<(usize, Limit, f64, f64)> = Vec::with_capacity(2 * self.cables.len());
        for (i, [lower, upper]) in linear.limits.iter().enumerate() {
            let lower = self.floor(i, *lower);
            rows.push((i, Limit::Minimum, 1.0, lower.at + lower.rate * there.height));
            if upper.at.is_finite() {
                rows.push((i, Limit::Maximum, -1.0, upper.rate * there.height - upper.at));
            }
        }

        let mut named = there.held_by;
        // Each pass names at least one further limit.
        for _ in 0..rows.len() {
            let is_open = |(i, limit, sign, level): &(usize, Limit, f64, f64)| {
                sign * there.tau[*i] - level <= slack && !named.contains(&(*i, *limit))
            };
            let open: Vec<bool> = rows.iter().map(is_open).collect();
            if !open.contains(&true) {
                break;
            }

            // Largest distance from all open limits among the optima.
            let mut feasible = FeasibleSet::new(&solutions, true);
            for ((i, _, sign, level), open) in rows.iter().zip(&open) {
                // Rounding of the optimum's height must not leave the set empty.
                feasible.add(Some(*i), *sign, if *open { -1.0 } else { 0.0 }, level - VIOLATION * self.size);
            }
            feasible.add(None, 1.0, -1.0, -self.size);
            let found = feasible.highest(|i| there.tau[i], self.tolerance(&solutions));

            let Some(found) = found.filter(|found| found.height <= slack) else { break };
            let strongest = found.held.iter().fold(0.0, |most: f64, held| most.max(held.multiplier));
            let before = named.len();
            for held in found.held.iter().filter(|held| held.multiplier > HOLDS * strongest) {
                if open.get(held.row) == Some(&true) {
                    named.push((rows[held.row].0, rows[held.row].1));
                }
            }
            if named.len() == before {
                break;
            }
        }
        order::sort_ascending(&mut named, |(i, _)| *i as f64);
        named
    }

    /// Limits that hold an optimum whose linear problem is not at hand: those of its search, or else those of the
    /// problem about the cables as they hang.
    fn limits_at(&mut self, optimum: &MarginOptimum) -> Vec<(usize, Limit)> {
        if !optimum.held_by.is_empty() {
            return optimum.held_by.clone();
        }
        self.set(&optimum.tau);
        let there = self.margin_optimum(&self.linearise(), None, &optimum.tau, None);
        there.map_or_else(|_| Vec::new(), |there| there.held_by)
    }
}
