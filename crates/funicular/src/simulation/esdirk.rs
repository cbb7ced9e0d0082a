//! Steps in time by a singly diagonally implicit Runge-Kutta method of order 4 with an error estimate of order 3.
//!
//! ESDIRK4(3)6L[2]SA of C. A. Kennedy and M. H. Carpenter, Additive Runge-Kutta schemes for
//! convection-diffusion-reaction equations, Appl. Numer. Math. 44, 2003, pages 139 to 181: six stages, the first of
//! which is the last of the step before; L-stable, so that waves that a step does not resolve fade.

mod rolling;
mod stage;
mod state;

use super::arrow::Arrow;
use super::dense::DenseOutput;
use super::resting::RestingRope;
use super::rope::{Newton, WoundLength};
use super::system::{BODY, MotionNumbers, System, three, turn_rate};
use crate::math::Vec3;
use rolling::Rolling;
use stage::NotSolved;
use state::FactorPlace;

/// Number of stages.
pub(super) const STAGES: usize = 6;
/// Diagonal of the method.
const GAMMA: f64 = 0.25;
/// Times of the stages within a step.
const TIMES: [f64; STAGES] = [0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0];
/// Weights of the earlier stages in each stage; the last row are those of the step.
const WEIGHTS: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [0.25, GAMMA, 0.0, 0.0, 0.0, 0.0],
    [8611.0 / 62500.0, -1743.0 / 31250.0, GAMMA, 0.0, 0.0, 0.0],
    [5_012_029.0 / 34_652_500.0, -654_441.0 / 2_922_500.0, 174_375.0 / 388_108.0, GAMMA, 0.0, 0.0],
    [
        15_267_082_809.0 / 155_376_265_600.0,
        -71_443_401.0 / 120_774_400.0,
        730_878_875.0 / 902_184_768.0,
        2_285_395.0 / 8_070_912.0,
        GAMMA,
        0.0,
    ],
    [82889.0 / 524_892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102_672.0, -2260.0 / 8211.0, GAMMA],
];
/// Weights of the embedded method of order 3.
const EMBEDDED: [f64; STAGES] = [
    4_586_570_599.0 / 29_645_900_160.0,
    0.0,
    178_811_875.0 / 945_068_544.0,
    814_220_225.0 / 1_159_782_912.0,
    -3_700_637.0 / 11_593_932.0,
    61727.0 / 225_920.0,
];

/// Step after the start and after an event [s].
const FIRST_STEP: f64 = 1e-4;
/// Step below which a motion cannot be followed [s]: a tenth of the time in which a wave in steel passes a millimetre.
const MIN_STEP: f64 = 2e-8;
/// Tolerated change of a velocity over that of a position [1/s].
const VELOCITY_RATE: f64 = 100.0;
/// Part of a step that failed that is tried next.
const SHORTER: f64 = 0.4;
/// Change of the step up to which a factor is kept.
const FACTOR_CHANGE: f64 = 0.15;

/// A motion that cannot be followed within the tolerance, at this time [s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooFast {
    pub(super) time: f64,
}

/// Counts of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepCounts {
    /// Steps taken.
    pub accepted: usize,
    /// Steps tried in vain.
    pub rejected: usize,
    /// Newton matrices factored.
    pub factored: usize,
    /// Evaluations of all forces.
    pub evaluations: usize,
}

/// System with its motion at one time, which goes on in steps.
#[derive(Clone)]
pub(super) struct Stepper {
    pub(super) system: System,
    pub(super) time: f64,
    /// Motion at `time`; the turn is zero.
    pub(super) now: MotionNumbers,
    /// Forces that it needs.
    pub(super) needed: Vec<f64>,
    pub(super) counts: StepCounts,
    tolerance: f64,
    /// Length that makes turns comparable with translations [m].
    length: f64,
    step: f64,
    error_before: f64,
    arrow: Arrow,
    /// Step of the factored matrix [s].
    factored: Option<f64>,
    /// Place at which the matrix was factored.
    factor_place: FactorPlace,
    contraction: f64,
    stages: Vec<MotionNumbers>,
    work: MotionNumbers,
    /// Last change of Newton's method.
    change: Vec<f64>,
}

impl Stepper {
    /// Stepper at a motion; accelerations are computed.
    pub(super) fn new(system: System, now: MotionNumbers, tolerance: f64, length: f64) -> Self {
        let (size, arrow) = (system.size, Arrow::new(&system));
        Self {
            time: 0.0,
            now,
            needed: vec![0.0; size],
            counts: StepCounts::default(),
            tolerance,
            length,
            step: FIRST_STEP,
            error_before: 1.0,
            arrow,
            factored: None,
            factor_place: FactorPlace::new(size, system.windings.len()),
            contraction: 0.1,
            stages: vec![MotionNumbers::zeros(size); STAGES],
            work: MotionNumbers::zeros(size),
            change: vec![0.0; size],
            system,
        }
    }

    /// Brings the motion to rest where all forces balance and every rope leaves its wheel along its tangent, from a
    /// place near it; `false` if there is no such place. `narrow` has the load per length of each rope that hangs in a
    /// bend too narrow for its mesh.
    pub(super) fn settle(&mut self, narrow: &[Option<Vec3>]) -> bool {
        const ROUNDS: usize = 20;
        for _ in 0..ROUNDS {
            if !self.settle_on_wheels(narrow) {
                return false;
            }
            if !self.roll_wheels(Rolling::AtRest) {
                return true;
            }
        }
        true
    }

    /// Brings the motion to rest with the wrap angles held. Ropes in narrow bends are at rest between their ends at
    /// every step, because Newton's method finds no hold on them, until their ends hardly move.
    fn settle_on_wheels(&mut self, narrow: &[Option<Vec3>]) -> bool {
        const STEPS: usize = 50;
        /// Change below which Newton's method takes all nodes along [m]: far below their distance, far above rounding.
        const CLOSE: f64 = 1e-6;
        let mut by_ends = narrow.iter().any(Option::is_some);
        // A table may begin with an acceleration: the rest before it has none.
        let at_rest = |length: WoundLength| WoundLength { rate: 0.0, acceleration: 0.0, ..length };
        let lengths: Vec<WoundLength> = self.system.lengths(self.time).into_iter().map(at_rest).collect();
        let of = Newton { mass: 0.0, damping: 0.0, stiffness: 1.0 };
        self.now.v.fill(0.0);
        self.now.a.fill(0.0);
        let (mut least, mut stalled) = (f64::INFINITY, 0);
        for step in 0..STEPS {
            if by_ends {
                self.hang(narrow, &lengths);
            }
            self.evaluate(&lengths);
            if self.arrow.factor(&self.system, self.time, &lengths, &self.now, &self.needed, of).is_err() {
                return false;
            }
            let mut change = self.needed.clone();
            self.arrow.solve(&self.system, &mut change);
            if by_ends {
                for i in (0..narrow.len()).filter(|i| narrow[*i].is_some()) {
                    change[self.system.of_rope(i)].fill(0.0);
                }
            }
            let size = change.iter().fold(0.0_f64, |most, of| most.max(of.abs()));
            if !size.is_finite() {
                return false;
            }
            // A long way is gone in parts: the ropes must not fold.
            let part = (0.05 * self.length.max(0.1) / size).min(1.0);
            for (x, change) in self.now.x.iter_mut().zip(&change) {
                *x += part * change;
            }
            self.absorb_turn();
            if by_ends {
                // Rounding of their forces may move soft platforms by more.
                by_ends = size > CLOSE && step < STEPS / 2;
                continue;
            }
            stalled = if size < 0.5 * least { 0 } else { stalled + 1 };
            least = least.min(size);
            if size < 1e-13 || (stalled > 2 && least < 1e-9) {
                self.evaluate(&lengths);
                self.factored = None;
                return true;
            }
        }
        false
    }

    /// Brings ropes in narrow bends to rest between their ends.
    fn hang(&mut self, narrow: &[Option<Vec3>], lengths: &[WoundLength]) {
        let body = self.system.body_motion(&self.now);
        self.system.fill_ends(self.time, &body, lengths, &mut self.now);
        for (i, load_w) in narrow.iter().enumerate().filter_map(|(i, load_w)| Some((i, (*load_w)?))) {
            let range = self.system.of_rope(i);
            let ends_w = [range.start, range.end - 3].map(|from| three(&self.now.x, from));
            let length = self.system.free_length(i, &lengths[i], &self.now).value;
            let resting = RestingRope { rope: &self.system.ropes[i], length, load_w, ends_w };
            let Some(nodes_w) = resting.nodes(&(-load_w * length)) else { continue };
            for (node, node_w) in nodes_w.iter().enumerate() {
                let from = range.start + 3 * node;
                self.now.x[from..from + 3].copy_from_slice(node_w.as_slice());
            }
        }
    }

    /// Takes the turn of the motion into the rotation of the system.
    fn absorb_turn(&mut self) {
        let turn = Vec3::from_column_slice(&self.now.x[3..BODY]);
        self.system.rotation = self.system.rotation_at(&turn);
        self.system.rotation.renormalize_fast();
        self.now.x[3..BODY].fill(0.0);
    }

    /// Forces that the present motion needs.
    pub(super) fn evaluate(&mut self, lengths: &[WoundLength]) {
        let body = self.system.body_motion(&self.now);
        self.system.fill_ends(self.time, &body, lengths, &mut self.now);
        self.system.needed(self.time, lengths, &body, &self.now, &mut self.needed);
    }

    /// Begins anew after an event: accelerations from the forces at the present places and velocities.
    pub(super) fn restart(&mut self) -> Result<(), TooFast> {
        self.accelerate()?;
        self.step = FIRST_STEP;
        self.error_before = 1.0;
        Ok(())
    }

    /// Accelerations from the forces at the present places and velocities.
    pub(super) fn accelerate(&mut self) -> Result<(), TooFast> {
        let lengths = self.system.lengths(self.time);
        let of = Newton { mass: 1.0, damping: 0.0, stiffness: 0.0 };
        self.now.a.fill(0.0);
        self.evaluate(&lengths);
        let too_fast = TooFast { time: self.time };
        self.arrow.factor(&self.system, self.time, &lengths, &self.now, &self.needed, of).map_err(|_| too_fast)?;
        let mut change = self.needed.clone();
        self.arrow.solve(&self.system, &mut change);
        self.now.a.copy_from_slice(&change);
        self.evaluate(&lengths);
        self.factored = None;
        Ok(())
    }

    /// One step, at most to `until`; returns how the motion went in between. What is commanded may jump at `until`, not
    /// before.
    pub(super) fn advance(&mut self, until: f64) -> Result<DenseOutput, TooFast> {
        if self.roll_wheels(Rolling::Between) {
            self.accelerate()?;
        }
        loop {
            let left = until - self.time;
            // The rest is gone in one step, or in two of one length.
            let ends = self.step >= 0.999_999 * left;
            let h = if ends {
                left
            } else if 2.0 * self.step > left {
                0.5 * left
            } else {
                self.step
            };
            if h < MIN_STEP && !ends {
                return Err(TooFast { time: self.time });
            }
            match self.attempt(h, until) {
                Ok(error) if error <= 1.0 => {
                    let dense = self.accept(h, until, error, ends);
                    if ends && self.system.jumps_at(until) {
                        self.accelerate()?;
                    }
                    return Ok(dense);
                }
                Ok(error) => {
                    self.counts.rejected += 1;
                    self.step = h * (0.9 * error.powf(-0.25)).clamp(0.2, 0.9);
                }
                Err(NotSolved) => {
                    self.counts.rejected += 1;
                    self.factored = None;
                    self.step = SHORTER * h;
                }
            }
            if self.step < MIN_STEP || self.step.is_nan() {
                return Err(TooFast { time: self.time });
            }
        }
    }

    /// Goes back to a time within the last step.
    pub(super) fn go_back(&mut self, dense: &DenseOutput, time: f64) {
        self.system.rotation = dense.rotation;
        dense.at(time, &mut self.now);
        self.time = time;
        self.absorb_turn();
        let lengths = self.system.lengths(time);
        self.evaluate(&lengths);
    }

    /// Goes back to the beginning of the last step, to try a shorter one.
    pub(super) fn take_back(&mut self, dense: &DenseOutput) {
        self.go_back(dense, dense.from);
        self.counts.accepted -= 1;
        self.counts.rejected += 1;
        self.step = SHORTER * (dense.until - dense.from);
        self.factored = None;
    }

    fn accept(&mut self, h: f64, until: f64, error: f64, ends: bool) -> DenseOutput {
        self.counts.accepted += 1;
        let error = error.max(1e-6);
        let factor = (0.9 * error.powf(-0.175) * self.error_before.powf(0.075)).clamp(0.3, 3.0);
        // A step near the right one is kept, and with it the factored matrix.
        let keeps = (0.9..=1.25).contains(&(0.9 * error.powf(-0.25)));
        let next = if keeps { h } else { h * factor };
        // A step that was cut short does not shorten the next one.
        self.step = if factor >= 1.0 { next.max(self.step) } else { next };
        self.error_before = error;

        let rotation = self.system.rotation;
        let before = std::mem::replace(&mut self.now, self.stages[STAGES - 1].clone());
        let time = self.time;
        self.time = if ends { until } else { self.time + h };
        let lengths = self.system.lengths(self.time);
        let dense = DenseOutput::new(time, self.time, rotation, before, self.now.clone());
        self.absorb_turn();
        self.evaluate(&lengths);
        self.counts.evaluations = self.system.evaluations;
        dense
    }

    /// Tries a step that ends before `until` or there; its error over the tolerance.
    fn attempt(&mut self, h: f64, until: f64) -> Result<f64, NotSolved> {
        if self.factored.is_none_or(|of| (h / of - 1.0).abs() > FACTOR_CHANGE) {
            self.factored = None;
        }
        // Rates of the position are kept in the place of the positions; those of the turn differ from the velocity.
        self.stages[0].v.copy_from_slice(&self.now.v);
        self.stages[0].a.copy_from_slice(&self.now.a);
        for stage in 1..STAGES {
            self.solve_stage(stage, h, until)?;
        }
        let error = self.error(h);
        if error.is_finite() { Ok(error) } else { Err(NotSolved) }
    }

    /// Rates of the turn at the stages before `stage`, weighted.
    fn turn_base(&self, weights: &[f64; STAGES], count: usize) -> Vec3 {
        (0..count).map(|j| self.stage_turn_rate(j) * weights[j]).sum()
    }

    fn stage_turn_rate(&self, j: usize) -> Vec3 {
        let omega = Vec3::from_column_slice(&self.stages[j].v[3..BODY]);
        if j == 0 { omega } else { turn_rate(&Vec3::from_column_slice(&self.stages[j].x[3..BODY]), &omega) }
    }

    /// Error of the tried step over the tolerance.
    fn error(&mut self, h: f64) -> f64 {
        let differences: [f64; STAGES] = std::array::from_fn(|j| WEIGHTS[STAGES - 1][j] - EMBEDDED[j]);
        let turn = self.turn_base(&differences, STAGES);
        let (of_x, of_v) = (&mut self.work.x, &mut self.work.v);
        of_x.fill(0.0);
        of_v.fill(0.0);
        for (stage, difference) in self.stages.iter().zip(differences) {
            if difference == 0.0 {
                continue;
            }
            for (sum, value) in of_x.iter_mut().zip(&stage.v) {
                *sum += difference * value;
            }
            for (sum, value) in of_v.iter_mut().zip(&stage.a) {
                *sum += difference * value;
            }
        }
        of_x[3..BODY].copy_from_slice(turn.as_slice());
        let position = norm(of_x, self.length);
        let velocity = norm(of_v, self.length) / VELOCITY_RATE;
        position.max(velocity) * h / self.tolerance
    }
}

/// The larger of the root mean squares over the platform and over the nodes of the ropes.
fn norm(numbers: &[f64], length: f64) -> f64 {
    let square = |of: &[f64]| of.iter().map(|x| x * x).sum::<f64>();
    let platform = (square(&numbers[..3]) + length * length * square(&numbers[3..BODY])) / BODY as f64;
    let nodes = &numbers[BODY..];
    platform.max(square(nodes) / nodes.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Conditions of order 4 of the method, of order 3 of the embedded one, and stage order 2.
    #[test]
    fn weights_meet_the_conditions_of_their_order() {
        let sum = |f: &dyn Fn(usize) -> f64| (0..STAGES).map(f).sum::<f64>();
        for stage in 1..STAGES {
            assert!((sum(&|j| WEIGHTS[stage][j]) - TIMES[stage]).abs() < 1e-14);
            assert!((sum(&|j| WEIGHTS[stage][j] * TIMES[j]) - 0.5 * TIMES[stage].powi(2)).abs() < 1e-14);
        }
        let squares = |i: usize| sum(&|j| WEIGHTS[i][j] * TIMES[j].powi(2));
        for (weights, order) in [(WEIGHTS[STAGES - 1], 4), (EMBEDDED, 3)] {
            for power in 0..order {
                assert!((sum(&|j| weights[j] * TIMES[j].powi(power)) - 1.0 / f64::from(power + 1)).abs() < 1e-14);
            }
            if order == 4 {
                assert!((sum(&|j| weights[j] * squares(j)) - 1.0 / 12.0).abs() < 1e-14);
            }
        }
    }
}
