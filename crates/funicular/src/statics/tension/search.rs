//! Iteration of the tension distribution: linearise the balance and the limits, solve the linear problem exactly,
//! repeat.

use super::cable_at_pose::{CableAtPose, TensionByTau};
use super::feasible_set::{FeasiblePoint, FeasibleSet, MIN_DIRECTIONS_IN_CABLE_SPACE};
use super::null_space::Solutions;
use super::proof::{Infeasibility, ReachableTensions};
use crate::math::Vec6;
use crate::math::active_set::Active;
use crate::platform::{Coordinates, balance, load_size, load_wrench};
use crate::robot::{Pose, Robot};
use crate::statics::error::StaticsError;
use crate::statics::limits::{Limit, LimitViolation};
use crate::statics::model::StaticModel;
use crate::statics::obstacle::Obstacle;
use crate::statics::residual::scaled_residual;

/// Maximum number of iterations. Robots of the library take 2 to 5, cables that sag by a tenth of their chord and more
/// up to 20.
const MAX_ITERATIONS: usize = 100;

/// Change of the tensions, over their size, at which the iteration ends.
const STILL: f64 = 1e-10;

/// Scaled residual at which the iteration may end; one more step squares it.
const BALANCED: f64 = 1e-12;

/// Violation of a limit, over the size of the tensions, that counts as rounding.
const VIOLATION: f64 = 1e-9;

/// Multiplier of a limit, over the largest one, above which the limit holds an optimum; rounding leaves 1e-12.
const HOLDS: f64 = 1e-9;

/// Distance from a limit, over the size of the tensions, from which on an optimum has left the limit: well above
/// [`VIOLATION`], by which the optima are relaxed, and below the millionth to which tensions are given.
const LEAVES: f64 = 1e-7;

/// Minimum derivative of a tension with respect to τ. At the slackest (v up to 1.2) the maximum tension of a level
/// cable is about at its minimum (v = 1.1997). Its derivative is near zero or negative there, and a limit computed from
/// it would be on the wrong side.
const MIN_SLOPE: f64 = 1e-3;

/// Rounding of a limit of the linear problem, over the size of the tensions: some hundred units in the last place, for
/// the few operations that a limit takes.
const LIMIT_ROUNDING: f64 = 1e-13;

/// Ratio of two successive changes of the tensions above which a step counts as a setback. A search that converges
/// slower than this factor per step would reach the maximum number of iterations without [`STILL`]: `0.9^100 = 3e-5`.
const SETBACK: f64 = 0.9;

/// Ratio to the change at the last setback below which that setback is behind, so that steps may grow again. Below
/// [`SHORTER`]: one short step of a linear problem leaves that part of the change, which is no recovery yet.
const RECOVERED: f64 = 0.3;

/// Factor by which setbacks shorten the step of a search for the nearest tensions, and the minimum fraction of a step.
/// The minimum keeps the search moving: a hundred such steps go five full steps far.
const SHORTER: f64 = 0.5;
const MIN_STEP_FRACTION: f64 = 0.05;

/// Factor by which a repeated setback reduces the growth of the smallest distance, and by which a search from another
/// start reduces its first step each time. Chosen, not fitted; each is smaller than [`SHORTER`], because a proximal step
/// never grows again.
const SMALLER_CLIMB: f64 = 0.3;

/// Change of a tension, over the size of the tensions, from which on the difference of two slopes gives a curvature:
/// the rounding of the slopes, 1e-16, then leaves an error of a billionth.
const MIN_MOVE: f64 = 1e-7;

/// Range of a cable's curvature in the search for the nearest tensions, relative to that of the squared distance, 1.
/// Below, a step would be more than ten times as long as without curvature; above, the cable would hardly move.
const CURVATURES: [f64; 2] = [0.1, 100.0];

/// Maximum number of further starts if neither tensions within the limits nor a proof of their absence is found.
const MAX_STARTS: usize = 12;

/// Search for the best tensions at a pose.
pub(super) struct TensionSearch<'a> {
    robot: &'a Robot,
    pose: &'a Pose,
    model: StaticModel,
    cables: Vec<CableAtPose>,
    /// Reference size of the tensions [N].
    size: f64,
    iterations: usize,
    /// Tensions within the limits found by a search from other starts.
    rescued: Option<Vec<f64>>,
}

/// Problem linearised about the present tensions.
pub(super) struct Linear {
    /// Derivatives of the wrench with respect to the tensions, scaled, in the platform's coordinates.
    pub columns: Vec<Vec6>,
    /// Value of `columns · τ` for balanced tensions.
    pub right: Vec6,
    /// Scaled size of the remaining wrench.
    pub residual: f64,
    /// Limits in τ.
    pub limits: Vec<[TauBound; 2]>,
}

/// Limit of τ [N].
#[derive(Debug, Clone, Copy)]
pub(super) struct TauBound {
    /// Value.
    pub at: f64,
    /// Change of this limit per newton of change of the limited tension.
    pub rate: f64,
}

/// Proposed tensions, with the multipliers of the balance.
struct TensionStep {
    tau: Vec<f64>,
    /// Multipliers of the balance.
    multipliers: Vec6,
}

/// Tensions with the maximum of the smallest distance from the limits.
struct MarginOptimum {
    tau: Vec<f64>,
    /// This distance, in units of the widths, …
    distance: f64,
    /// … and in newtons.
    height: f64,
    held_by: Vec<(usize, Limit)>,
    /// Multipliers of the balance; zero if the distance is in units of the widths.
    multipliers: Vec6,
    /// Tensions with which the cables hang in the linear problem of a minimum violation; below them a cable is
    /// continued by its tangent.
    hung: Vec<f64>,
}

/// Limited growth of the smallest distance from the limits [N].
#[derive(Debug, Clone, Copy)]
pub(super) struct ProximalStep {
    pub from: f64,
    pub by: f64,
}

/// Step control of the search for the maximum distance.
///
/// If the optimum is not a corner of the linear problem, the corners on both sides take turns. Then the steps are made
/// smaller: the distance may grow by a limited amount only, with the smallest possible move of the tensions (a proximal
/// step). The fixed points are the same.
#[derive(Debug)]
pub(super) struct ProximalStepControl {
    pub climb: Option<ProximalStep>,
    pub last_change: f64,
    setbacks: usize,
}

impl Default for ProximalStepControl {
    fn default() -> Self {
        Self { climb: None, last_change: f64::INFINITY, setbacks: 0 }
    }
}

impl ProximalStepControl {
    pub(super) fn next(&mut self, change: f64, size: f64, height: f64) {
        if change > SETBACK * self.last_change {
            self.setbacks += 1;
            if self.setbacks > 1 {
                let by = self.climb.map_or(change * size, |climb| SMALLER_CLIMB * climb.by);
                self.climb = Some(ProximalStep { from: height, by });
            }
        }
        if let Some(climb) = &mut self.climb {
            climb.from = height;
        }
        self.last_change = change;
    }
}

impl<'a> TensionSearch<'a> {
    pub(super) fn new(robot: &'a Robot, pose: &'a Pose, model: StaticModel, cables: Vec<CableAtPose>) -> Self {
        let weight = load_size(robot);
        let minima: f64 = cables.iter().map(|cable| cable.range.minimum + cable.slackest).sum();
        let size = if weight + minima > 0.0 { weight + minima } else { 1.0 };
        Self { robot, pose, model, cables, size, iterations: 0, rescued: None }
    }

    pub(super) fn robot(&self) -> &Robot {
        self.robot
    }

    pub(super) fn pose(&self) -> &Pose {
        self.pose
    }

    pub(super) fn cables(&self) -> &[CableAtPose] {
        &self.cables
    }

    pub(super) fn into_cables(self) -> Vec<CableAtPose> {
        self.cables
    }

    pub(super) fn iterations(&self) -> usize {
        self.iterations
    }

    /// Counts an iteration.
    pub(super) fn count(&mut self) {
        self.iterations += 1;
    }

    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Present tensions.
    pub(super) fn tensions(&self) -> Vec<f64> {
        self.cables.iter().map(CableAtPose::tau).collect()
    }

    /// Hangs all cables with other tensions.
    pub(super) fn set(&mut self, tau: &[f64]) {
        for (cable, &tau) in self.cables.iter_mut().zip(tau) {
            cable.set(tau.max(cable.slackest));
        }
    }

    /// Largest change to other tensions, over their size.
    fn change(&self, tau: &[f64]) -> f64 {
        let change = self.cables.iter().zip(tau).fold(0.0, |most: f64, (cable, tau)| {
            let change = (tau.max(cable.slackest) - cable.tau()).abs();
            if change.is_nan() { f64::INFINITY } else { most.max(change) }
        });
        change / self.size
    }

    pub(super) fn linearise(&self) -> Linear {
        let coordinates = Coordinates::of(self.robot);
        let (wrench, scale) = balance(self.robot, self.pose, self.cables.iter().map(CableAtPose::force));
        let residual = scaled_residual(&coordinates, &wrench, scale);
        let motion = &self.robot.platform.motion;
        let mut right = -coordinates.reduce(&wrench);
        let columns: Vec<Vec6> = self.cables.iter().map(|cable| motion.reduced(&cable.column())).collect();
        for (column, cable) in columns.iter().zip(&self.cables) {
            right += column * cable.tau();
        }
        let limits = self.cables.iter().map(|cable| {
            let [min, max] = [cable.min_tension(), cable.max_tension()]
                .map(|tension| TensionByTau { slope: tension.slope.max(MIN_SLOPE), ..tension });
            let lower = cable.tau() + (cable.range.minimum - min.value) / min.slope;
            let upper = cable.tau() + (cable.range.maximum - max.value) / max.slope;
            [TauBound { at: lower, rate: 1.0 / min.slope }, TauBound { at: upper, rate: 1.0 / max.slope }]
        });
        Linear { limits: limits.collect(), columns, right, residual }
    }

    /// Lower limit of cable `i`, or its slackest τ if that is higher.
    fn floor(&self, i: usize, lower: TauBound) -> TauBound {
        let slackest = self.cables[i].slackest;
        if lower.at < slackest { TauBound { at: slackest, rate: 1.0 } } else { lower }
    }

    pub(super) fn solutions(&self, linear: &Linear, scales: &[f64]) -> Result<Solutions, StaticsError> {
        let dof = self.robot.platform.motion.count();
        Solutions::of(&linear.columns, scales, &linear.right, dof, true).ok_or(StaticsError::Singular)
    }

    /// Solutions for [`FeasibleSet`], which needs no directions if they are many.
    fn solutions_for_feasible_set(&self, linear: &Linear, scales: &[f64]) -> Result<Solutions, StaticsError> {
        let dof = self.robot.platform.motion.count();
        let in_null_space = self.cables.len() < MIN_DIRECTIONS_IN_CABLE_SPACE + dof;
        Solutions::of(&linear.columns, scales, &linear.right, dof, in_null_space).ok_or(StaticsError::Singular)
    }

    /// Violation of inequalities that counts as rounding.
    pub(super) fn tolerance(&self, solutions: &Solutions) -> f64 {
        LIMIT_ROUNDING * solutions.particular.iter().fold(self.size, |most, p| most.max(p.abs()))
    }

    /// Moves to the tensions within the limits nearest to `target` in least squares.
    ///
    /// The curvature of the balance enters the second derivative, cable by cable, by the change of its slope in the
    /// last step. It matters if cables sag deeply.
    pub(super) fn nearest_to(&mut self, target: &[f64]) -> Result<(), StaticsError> {
        let count = self.cables.len();
        let mut scales = vec![1.0; count];
        let mut last: Option<(Vec<f64>, Vec<Vec6>, Vec6)> = None;
        // If deeply sagging cables overstep, steps are shortened until the last setback is well behind.
        let (mut part, mut last_change, mut setback) = (1.0_f64, f64::INFINITY, f64::INFINITY);

        for _ in 0..MAX_ITERATIONS {
            self.iterations += 1;

            let linear = self.linearise();

            // Curvature of each cable, from the last step.
            if let Some((tau, columns, multipliers)) = &last {
                for (i, cable) in self.cables.iter().enumerate() {
                    let moved = cable.tau() - tau[i];
                    if moved.abs() > MIN_MOVE * self.size {
                        let bend = (linear.columns[i] - columns[i]).dot(multipliers) / moved;
                        let [low, high] = CURVATURES;
                        scales[i] = (1.0 - bend).clamp(low, high).sqrt();
                    }
                }
            }

            // Solve the linear problem.
            let Some(step) = self.step(&linear, target, &scales)? else {
                self.min_violation()?;
                last = None;
                if self.rescued.is_some() {
                    // From the result of another start, with shorter steps.
                    part = (SHORTER * part).max(MIN_STEP_FRACTION);
                }
                continue;
            };

            // End if nothing changes.
            let change = self.change(&step.tau);
            if change <= STILL && linear.residual <= BALANCED {
                return Ok(());
            }

            // Choose the fraction of the step.
            if change > SETBACK * last_change {
                (part, setback) = ((SHORTER * part).max(MIN_STEP_FRACTION), change);
            } else if change < RECOVERED * setback {
                part = (part / SHORTER).min(1.0);
            }
            last_change = change;

            let before = self.tensions();
            let after: Vec<f64> = before.iter().zip(&step.tau).map(|(from, to)| from + part * (to - from)).collect();
            last = Some((before, linear.columns, step.multipliers));
            self.set(&after);
        }
        Err(self.not_converged(last_change, STILL))
    }

    fn step(&self, linear: &Linear, target: &[f64], scales: &[f64]) -> Result<Option<TensionStep>, StaticsError> {
        let solutions = self.solutions_for_feasible_set(linear, scales)?;
        // The minimum of ½ Δᵀ D Δ + (τ − target)·Δ is at τ − (τ − target)/D.
        let aim = |i: usize| {
            let tau = self.cables[i].tau();
            scales[i] * (tau - (tau - target[i]) / (scales[i] * scales[i]))
        };

        // The limits.
        let mut feasible = FeasibleSet::new(&solutions, false);
        let mut rows = Vec::with_capacity(2 * scales.len());
        for (i, [lower, upper]) in linear.limits.iter().enumerate() {
            let lower = self.floor(i, *lower);
            feasible.add(Some(i), 1.0, 0.0, scales[i] * lower.at);
            rows.push((i, 1.0));
            if upper.at.is_finite() {
                feasible.add(Some(i), -1.0, 0.0, -(scales[i] * upper.at));
                rows.push((i, -1.0));
            }
        }

        // Nearest point within them, and the multipliers of the balance.
        let found = feasible.nearest(aim, 0.0, self.tolerance(&solutions));
        let Some(FeasiblePoint { sigma, held: active, .. }) = found else { return Ok(None) };
        let mut pressed = vec![0.0; scales.len()];
        for held in active {
            let (i, sign) = rows[held.row];
            pressed[i] += sign * held.multiplier;
        }
        let multipliers = solutions.multipliers(|i| sigma[i] - aim(i) - pressed[i]);
        Ok(Some(TensionStep {
            tau: sigma.iter().zip(scales).map(|(sigma, scale)| sigma / scale).collect(),
            multipliers,
        }))
    }

    /// Moves to the tensions as far from the limits as possible, relative to the distance between the limits.
    pub(super) fn middle(&mut self) -> Result<(), StaticsError> {
        let widths: Vec<f64> = self.cables.iter().map(|cable| cable.range.maximum - cable.range.minimum).collect();
        let mut stride = ProximalStepControl::default();
        let mut reach = 1.0;

        for _ in 0..MAX_ITERATIONS {
            self.iterations += 1;
            let linear = self.linearise();
            let optimum = self.margin_optimum(&linear, Some(&widths), &self.tensions(), stride.climb)?;

            if optimum.distance < -VIOLATION {
                self.min_violation()?;
                stride = ProximalStepControl::default();
                if self.rescued.is_some() {
                    // From the result of another start, next to the limits, with shorter steps each time.
                    reach *= SMALLER_CLIMB;
                    stride.climb = Some(ProximalStep { from: 0.0, by: reach * self.size });
                }
                continue;
            }

            let change = self.change(&optimum.tau);
            if change <= STILL && linear.residual <= BALANCED {
                return Ok(());
            }
            stride.next(change, self.size, optimum.height);
            self.set(&optimum.tau);
        }
        Err(self.not_converged(stride.last_change, STILL))
    }

    /// Corrects tensions that nearly hold the platform within the limits; true if it succeeds.
    pub(super) fn settle(&mut self) -> bool {
        let linear = self.linearise();
        let slack = VIOLATION * self.size;
        let within = |(cable, [lower, upper]): (&CableAtPose, &[TauBound; 2])| {
            cable.tau() >= lower.at - slack && cable.tau() <= upper.at + slack
        };
        let settled = linear.residual <= BALANCED && self.cables.iter().zip(&linear.limits).all(within);
        settled || self.nearest_to(&self.tensions()).is_ok()
    }

    /// Moves to tensions within the limits, near their middle, that nearly hold the platform.
    pub(super) fn near_middle(&mut self) -> Result<(), StaticsError> {
        self.count();
        let widths: Vec<f64> = self.cables.iter().map(|cable| cable.range.maximum - cable.range.minimum).collect();
        let optimum = self.margin_optimum(&self.linearise(), Some(&widths), &self.tensions(), None)?;
        if optimum.distance < 0.0 {
            return self.middle();
        }
        self.set(&optimum.tau);
        Ok(())
    }

    /// Moves to the tensions with the minimum violation of the limits; an error if they do violate them.
    ///
    /// Below its minimum a cable is continued by its tangent there. So a cable that would need negative tension has a
    /// violation as well, and the forces have no kink on which linearisations could disagree. If no tension is negative
    /// after all, the violation is computed once more with the cables as they hang.
    ///
    /// The minimum violation may be a local one if cables sag. The pose is refused for good only if a direction proves
    /// it, see [`Infeasibility`]; otherwise the search begins again elsewhere.
    fn min_violation(&mut self) -> Result<(), StaticsError> {
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

        // The direction of the limits' multipliers is nearly always a proof.
        let reaches: Vec<ReachableTensions> =
            self.cables.iter().zip(&minima).map(|(cable, tau)| ReachableTensions::of(cable, *tau)).collect();
        let motion = self.robot.platform.motion;
        let load = Coordinates::of(self.robot).reduce(&load_wrench(self.robot, self.pose));
        let claim = Infeasibility { reaches: &reaches, load, motion };
        let verdict = claim.prove(&optimum.multipliers);
        if verdict.proved {
            return Err(StaticsError::BeyondLimits(self.miss(&optimum)));
        }

        // Other starts: the tensions with the maximum contributions in that direction, and others between the limits.
        let mut starts = 1;
        for k in 0..MAX_STARTS {
            starts += 1;
            let start = if k == 0 { verdict.max_shares.clone() } else { self.spread(&reaches, k) };
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

    /// Start number `k` of tensions that spread over the range between the limits, evenly in their logarithms.
    fn spread(&self, reaches: &[ReachableTensions], k: usize) -> Vec<f64> {
        let cables = reaches.iter().zip(&self.cables).enumerate();
        let tensions = cables.map(|(i, (reach, cable))| {
            let [low, high] = reach.limits();
            // Without a maximum, the upper end of the range is too high for a start.
            let high = if cable.range.maximum.is_infinite() { high.min(self.size.max(2.0 * low)) } else { high };
            let low = low.max(f64::MIN_POSITIVE);
            // Multiples of irrational numbers have no pattern (Weyl).
            let part = ((k as f64 + 1.0) * (i as f64 + 2.0).sqrt() * std::f64::consts::E).fract();
            low * (high / low).max(1.0).powf(part)
        });
        tensions.collect()
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

    /// Maximum of the smallest distance from the limits: over their `widths`, or, without widths, in N and at most
    /// zero.
    ///
    /// With a `climb` the distance grows by a limited amount instead, and the tensions `here` move little.
    fn margin_optimum(
        &self,
        linear: &Linear,
        widths: Option<&[f64]>,
        here: &[f64],
        climb: Option<ProximalStep>,
    ) -> Result<MarginOptimum, StaticsError> {
        let solutions = self.solutions_for_feasible_set(linear, &vec![1.0; self.cables.len()])?;
        // The height is in N in both cases.
        let unit = widths.map_or(1.0, |widths| widths.iter().sum::<f64>() / widths.len() as f64);

        // The limits.
        let mut feasible = FeasibleSet::new(&solutions, true);
        let mut rows = Vec::with_capacity(3 * self.cables.len());
        for (i, [lower, upper]) in linear.limits.iter().enumerate() {
            let width = widths.map_or(1.0, |widths| widths[i] / unit);
            let lower = if widths.is_some() { *lower } else { self.floor(i, *lower) };
            feasible.add(Some(i), 1.0, -width * lower.rate, lower.at);
            rows.push(Some((i, Limit::Minimum)));
            if upper.at.is_finite() {
                feasible.add(Some(i), -1.0, -width * upper.rate, -upper.at);
                rows.push(Some((i, Limit::Maximum)));
            }
            if widths.is_some() {
                feasible.add(Some(i), 1.0, 0.0, self.cables[i].slackest);
                rows.push(None);
            }
        }
        if widths.is_none() {
            feasible.add(None, 1.0, -1.0, 0.0);
            rows.push(None);
        }

        // Highest point.
        let tolerance = self.tolerance(&solutions);
        let found = match (climb, widths) {
            (Some(climb), _) => feasible.nearest(|i| here[i], climb.from + climb.by, tolerance),
            (None, None) => feasible.highest(|i| here[i], tolerance),
            (None, Some(_)) => feasible.highest(|i| 0.5 * (linear.limits[i][0].at + linear.limits[i][1].at), tolerance),
        };

        let Some(FeasiblePoint { sigma: tau, height, held }) = found else {
            // Only the slackest cables can prevent a solution here: they bind more strictly than the limits.
            return match widths {
                Some(_) => self.margin_optimum(linear, None, here, None),
                None => Err(self.not_converged(f64::INFINITY, STILL)),
            };
        };

        // Limits that hold it.
        let strongest = held.iter().fold(0.0, |m: f64, a| m.max(a.multiplier));
        let binds = |held: &Active| (held.multiplier > HOLDS * strongest).then(|| rows[held.row]).flatten();
        let mut held_by: Vec<_> = held.iter().filter_map(binds).collect();
        held_by.sort_by_key(|(i, _)| *i);
        let mut multipliers = Vec6::zeros();
        if widths.is_none() {
            let mut pressed = vec![0.0; self.cables.len()];
            for held in &held {
                if let Some((i, limit)) = rows[held.row] {
                    pressed[i] += if limit == Limit::Minimum { held.multiplier } else { -held.multiplier };
                }
            }
            multipliers = solutions.multipliers(|i| -pressed[i]);
        }
        Ok(MarginOptimum { tau, height, distance: height / unit, held_by, multipliers, hung: Vec::new() })
    }

    /// Violation of the limits at the optimum, and the reason why even tensions without limits do not balance the load,
    /// if there is one.
    fn miss(&mut self, optimum: &MarginOptimum) -> LimitViolation {
        let limits = self.limits_in_the_way(optimum);
        let names = |limit: Limit| {
            let of = limits.iter().filter(|(_, which)| *which == limit);
            of.map(|(i, _)| self.robot.cables[*i].name.clone()).collect()
        };
        LimitViolation {
            by: -optimum.distance,
            minimum_of: names(Limit::Minimum),
            maximum_of: names(Limit::Maximum),
            obstacle: Obstacle::at(self.robot, self.pose, self.model).map(Box::new),
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
        named.sort_by_key(|(i, _)| *i);
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

    fn not_converged(&self, change: f64, limit: f64) -> StaticsError {
        let (p, residual) = (self.pose.position_w, self.linearise().residual);
        StaticsError::TensionsNotConverged {
            iterations: self.iterations,
            change,
            limit,
            residual,
            x: p.x,
            y: p.y,
            z: p.z,
        }
    }
}
