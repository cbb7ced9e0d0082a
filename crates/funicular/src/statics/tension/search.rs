//! Iteration of the tension distribution: linearise the balance and the limits, solve the linear problem exactly,
//! repeat.

mod margin;
mod proximal_step;
mod violation;

pub(super) use margin::HOLDS;
pub(super) use proximal_step::{ProximalStep, ProximalStepControl};

use super::feasible_set::{FeasiblePoint, FeasibleSet, MIN_DIRECTIONS_IN_CABLE_SPACE};
use super::null_space::Solutions;
use crate::math::Vec6;
use crate::platform::{Coordinates, balance, load_size};
use crate::robot::{Pose, Robot};
use crate::statics::error::StaticsError;
use crate::statics::model::StaticModel;
use crate::statics::residual::scaled_residual;
use crate::statics::wrench_set::{CableAtPose, TensionByTau};
use proximal_step::{SETBACK, SMALLER_CLIMB};

/// Maximum number of iterations. Robots of the library take 2 to 5, cables that sag by a tenth of their chord and more
/// up to 20.
const MAX_ITERATIONS: usize = 100;

/// Change of the tensions, over their size, at which the iteration ends.
const CONVERGED: f64 = 1e-10;

/// Scaled residual at which the iteration may end; one more step squares it.
const BALANCED: f64 = 1e-12;

/// Violation of a limit, over the size of the tensions, that counts as rounding.
const VIOLATION: f64 = 1e-9;

/// Minimum derivative of a tension with respect to τ. At the slackest (v up to 1.2) the maximum tension of a level
/// cable is about at its minimum (v = 1.1997). Its derivative is near zero or negative there, and a limit computed from
/// it would be on the wrong side.
const MIN_SLOPE: f64 = 1e-3;

/// Rounding of a limit of the linear problem, over the size of the tensions: some hundred units in the last place, for
/// the few operations that a limit takes.
const LIMIT_ROUNDING: f64 = 1e-13;

/// Maximum change of the tensions, over that at the last setback, at which steps may grow again. It is below
/// [`SETBACK_FACTOR`]: one short step of a linear problem leaves this part of the change, which is no recovery yet.
const MAX_CHANGE_RECOVERED: f64 = 0.3;

/// Factor by which setbacks shorten the step of a search for the nearest tensions, and the minimum fraction of a step.
/// The minimum keeps the search moving: a hundred such steps go five full steps far.
const SETBACK_FACTOR: f64 = 0.5;
const MIN_STEP_FRACTION: f64 = 0.05;

/// Change of a tension, over the size of the tensions, from which on the difference of two slopes gives a curvature:
/// the rounding of the slopes, 1e-16, then leaves an error of a billionth.
const MIN_MOVE: f64 = 1e-7;

/// Range of a cable's curvature in the search for the nearest tensions, relative to that of the squared distance, 1.
/// Below, a step would be more than ten times as long as without curvature; above, the cable would hardly move.
const CURVATURES: [f64; 2] = [0.1, 100.0];

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
        let (wrench, scale) = balance(self.robot, self.pose, self.cables.iter().flat_map(CableAtPose::forces));
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
        Solutions::of(&linear.columns, scales, &linear.right, dof, true).ok_or_else(|| self.singular())
    }

    /// Solutions for [`FeasibleSet`], which needs no directions if they are many.
    fn solutions_for_feasible_set(&self, linear: &Linear, scales: &[f64]) -> Result<Solutions, StaticsError> {
        let dof = self.robot.platform.motion.count();
        let in_null_space = self.cables.len() < MIN_DIRECTIONS_IN_CABLE_SPACE + dof;
        Solutions::of(&linear.columns, scales, &linear.right, dof, in_null_space).ok_or_else(|| self.singular())
    }

    /// Error of a pose at which the cables have dependent directions and do not balance the load.
    pub(super) fn singular(&self) -> StaticsError {
        StaticsError::singular(self.robot, self.pose, self.model)
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

            // Linearise about the present tensions.
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
                    part = (SETBACK_FACTOR * part).max(MIN_STEP_FRACTION);
                }
                continue;
            };

            // End if nothing changes.
            let change = self.change(&step.tau);
            if change <= CONVERGED && linear.residual <= BALANCED {
                return Ok(());
            }

            // Choose the fraction of the step.
            if change > SETBACK * last_change {
                (part, setback) = ((SETBACK_FACTOR * part).max(MIN_STEP_FRACTION), change);
            } else if change < MAX_CHANGE_RECOVERED * setback {
                part = (part / SETBACK_FACTOR).min(1.0);
            }
            last_change = change;

            // Take it.
            let before = self.tensions();
            let after: Vec<f64> = before.iter().zip(&step.tau).map(|(from, to)| from + part * (to - from)).collect();
            last = Some((before, linear.columns, step.multipliers));
            self.set(&after);
        }
        Err(self.not_converged(last_change, CONVERGED))
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
        self.middle_of(&widths)
    }

    /// Moves to the tensions whose distance from the limits is the largest fraction of the `widths` that it can be.
    pub(super) fn middle_of(&mut self, widths: &[f64]) -> Result<(), StaticsError> {
        let mut stride = ProximalStepControl::default();
        let mut reach = 1.0;

        for _ in 0..MAX_ITERATIONS {
            self.iterations += 1;
            let linear = self.linearise();
            let optimum = self.margin_optimum(&linear, Some(widths), &self.tensions(), stride.climb)?;

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
            if change <= CONVERGED && linear.residual <= BALANCED {
                return Ok(());
            }
            stride.next(change, self.size, optimum.height);
            self.set(&optimum.tau);
        }
        Err(self.not_converged(stride.last_change, CONVERGED))
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
