//! Stages of a step: Newton's method for their velocities, shortened where ropes go slack or taut.

use super::{GAMMA, STAGES, Stepper, TIMES, VELOCITY_RATE, WEIGHTS, norm};
use crate::math::Vec3;
use crate::simulation::rope::Newton;
use crate::simulation::system::{BODY, MotionNumbers, turn_rate};

/// Part of the tolerance to which Newton's method solves a stage. At a tenth natural frequencies drift by 5e-6.
const NEWTON_PART: f64 = 0.03;
/// Part of the tolerance that is enough whatever the steps before it were: those across kinks do not contract.
const SMALL_PART: f64 = 0.1 * NEWTON_PART;
/// Newton steps of a stage; more than this many with one factor are slower than a new factor.
const NEWTON_STEPS: usize = 10;
const NEWTON_STEPS_OF_OLD_FACTOR: usize = 4;
/// Maximum contraction of a factor that is kept; above it a rope has gone slack or taut since it was made. Smooth
/// motion contracts by 0.1 or less.
const MAX_CONTRACTION: f64 = 0.7;
/// Maximum work along a change of Newton's method that is too much after it, over the work that was missing before it.
/// Larger changes are shortened, or steps would go to and fro across the kinks of strongly damped ropes. Changes
/// that go to and fro have 1 and more, those that contract 0.2 and less.
const MAX_OVERSHOOT: f64 = 0.5;

/// A stage that Newton's method did not solve.
pub(super) struct NotSolved;

impl Stepper {
    /// Velocity, place and acceleration of a stage of a step of `h` [s] that ends before `until` or there.
    pub(super) fn solve_stage(&mut self, stage: usize, h: f64, until: f64) -> Result<(), NotSolved> {
        let (weights, hg) = (&WEIGHTS[stage], h * GAMMA);
        // A step that ends where something jumps knows nothing of what comes after it.
        let time = (self.time + TIMES[stage] * h).min(until.next_down());
        let lengths = self.system.lengths(time);
        let turn_base = self.turn_base(weights, stage) * h;
        let (past, rest) = self.stages.split_at_mut(stage);
        let current = &mut rest[0];
        bases(&self.now, past, weights, h, &mut self.work);
        predict(past, stage, h, &mut current.v);

        let (mut last, mut is_fresh, mut scale) = (f64::INFINITY, false, 1.0);
        // Work that was missing along the last change before it.
        let mut missing = None;
        for round in 0..NEWTON_STEPS {
            place(&self.work, &turn_base, hg, current);
            let body = self.system.body_motion(current);
            self.system.fill_ends(time, &body, &lengths, current);
            self.system.needed(time, &lengths, &body, current, &mut self.needed);

            // Ropes went slack or taut on the way: back to where no work is missing and none too much.
            if let Some(missing) = missing.take() {
                let beyond = self.system.work(&self.needed, &self.change);
                if beyond > MAX_OVERSHOOT * missing {
                    add(&mut current.v, -scale * beyond / (missing + beyond), &self.change);
                    self.factored = None;
                    last = f64::INFINITY;
                    continue;
                }
            }

            if self.factored.is_none() {
                let of = Newton { mass: 1.0 / hg, damping: 1.0, stiffness: hg };
                self.counts.factored += 1;
                self.arrow.factor(&self.system, time, &lengths, current, &self.needed, of).map_err(|_| NotSolved)?;
                self.factored = Some(h);
                self.factor_place.set((time, h, self.system.rotation), &lengths, current, &self.needed);
                is_fresh = true;
            }
            self.change.copy_from_slice(&self.needed);
            self.arrow.solve(&self.system, &mut self.change);
            scale = self.factored.map_or(1.0, |of| 2.0 / (1.0 + h / of));
            add(&mut current.v, scale, &self.change);

            let size = norm(&self.change, self.length) * hg.max(1.0 / VELOCITY_RATE) * scale / self.tolerance;
            if !size.is_finite() {
                break;
            }
            if last.is_finite() {
                self.contraction = size / last;
            }
            if is_enough(size, self.contraction, last.is_finite()) {
                place(&self.work, &turn_base, hg, current);
                return Ok(());
            }
            let crosses_kink = last.is_finite() && self.contraction > MAX_CONTRACTION;
            if crosses_kink || (round >= NEWTON_STEPS_OF_OLD_FACTOR && !is_fresh) {
                self.factored = None;
            }
            last = size;
            missing = Some(-self.system.work(&self.needed, &self.change));
        }
        self.factored = None;
        Err(NotSolved)
    }
}

/// True if a change over the tolerance leaves less than Newton's method has to; `contraction` is that of this change if
/// it `follows` another one, or an earlier one.
fn is_enough(size: f64, contraction: f64, follows: bool) -> bool {
    let rate = contraction.min(0.95);
    let contracts = (follows || size < NEWTON_PART) && contraction < 1.0;
    size < SMALL_PART || (contracts && rate / (1.0 - rate) * size < NEWTON_PART)
}

/// Adds a part of a change.
fn add(v: &mut [f64], part: f64, change: &[f64]) {
    for (v, change) in v.iter_mut().zip(change) {
        *v += part * change;
    }
}

/// Position and velocity that the stages before give, in `x` and `v` of `out`.
fn bases(now: &MotionNumbers, past: &[MotionNumbers], weights: &[f64; STAGES], h: f64, out: &mut MotionNumbers) {
    out.x.copy_from_slice(&now.x);
    out.v.copy_from_slice(&now.v);
    for (stage, weight) in past.iter().zip(weights) {
        let weight = weight * h;
        if weight == 0.0 {
            continue;
        }
        for (sum, value) in out.x.iter_mut().zip(&stage.v) {
            *sum += weight * value;
        }
        for (sum, value) in out.v.iter_mut().zip(&stage.a) {
            *sum += weight * value;
        }
    }
}

/// First velocity of a stage: on the line through the two stages nearest in time.
fn predict(past: &[MotionNumbers], stage: usize, h: f64, v: &mut [f64]) {
    let time = TIMES[stage];
    if stage == 1 {
        for ((v, before), a) in v.iter_mut().zip(&past[0].v).zip(&past[0].a) {
            *v = before + time * h * a;
        }
        return;
    }
    let mut nearest: Vec<usize> = (0..stage).collect();
    nearest.sort_by(|a, b| (TIMES[*a] - time).abs().total_cmp(&(TIMES[*b] - time).abs()));
    let (a, b) = (nearest[0], nearest[1]);
    let part = (time - TIMES[a]) / (TIMES[b] - TIMES[a]);
    for ((v, of_a), of_b) in v.iter_mut().zip(&past[a].v).zip(&past[b].v) {
        *v = of_a + part * (of_b - of_a);
    }
}

/// Position and acceleration of a stage from its velocity.
fn place(base: &MotionNumbers, turn_base: &Vec3, hg: f64, current: &mut MotionNumbers) {
    for (k, v) in current.v.iter().enumerate() {
        current.x[k] = base.x[k] + hg * v;
        current.a[k] = (v - base.v[k]) / hg;
    }
    let omega = Vec3::from_column_slice(&current.v[3..BODY]);
    let mut turn = turn_base + omega * hg;
    for _ in 0..3 {
        turn = turn_base + turn_rate(&turn, &omega) * hg;
    }
    current.x[3..BODY].copy_from_slice(turn.as_slice());
}
