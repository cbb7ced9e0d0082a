//! Course of a commanded change over time: boxes convolved with each other, which bound rate, acceleration and jerk,
//! and the impulses of a shaper (docs/theory.md, equation (46j)).

use super::Side;
use super::shaper::{Impulse, Shaper};
use crate::math::Complex;

/// Course over time of a change from nothing to all of it, from t = 0 on.
///
/// The rate is a chain of unit boxes, convolved: the longest is the time from the beginning of the acceleration to that
/// of the deceleration, the second the time of each acceleration, the third that of each change of the acceleration.
/// Without boxes the change is a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Durations of the boxes [s], all positive, at most [`MAX_BOXES`] of a course within limits.
    boxes: Vec<f64>,
    /// Parts of the change, each of which begins at its time.
    impulses: Vec<Impulse>,
}

/// Number of boxes of a course with a continuous jerk, the largest of all.
const MAX_BOXES: usize = 4;

/// Number of derivatives of a motion, the value among them.
const ORDERS: usize = 4;

/// Part of the duration of a course below which two of its corners are one: phases that end together differ by
/// rounding, 1e-16 of the duration, and no phase that changes a motion is this short.
pub(super) const SAME_CORNER: f64 = 1e-9;

/// Magnitude of x up to which a series gives `(eˣ − 1)/x` and its successors: the closed form has lost two digits
/// there, and [`TERMS`] terms of the series leave 1e-19.
const SMALL: f64 = 0.5;
const TERMS: u32 = 16;

impl Profile {
    /// Course with boxes of these durations [s], in any order; zeros are no boxes.
    pub fn new(boxes: &[f64]) -> Self {
        let boxes = boxes.iter().copied().filter(|duration| *duration > 0.0).collect();
        Self { boxes, impulses: vec![Impulse { time: 0.0, amplitude: 1.0 }] }
    }

    /// Durations of its boxes [s], in any order.
    pub(crate) fn boxes(&self) -> &[f64] {
        &self.boxes
    }

    /// The course after a shaper.
    #[must_use]
    pub fn shaped(&self, shaper: &Shaper) -> Self {
        let own = Shaper { impulses: self.impulses.clone() };
        Self { boxes: self.boxes.clone(), impulses: own.convolved(shaper).impulses }
    }

    /// Time after which nothing changes [s].
    pub fn duration(&self) -> f64 {
        self.boxes.iter().sum::<f64>() + self.last_impulse()
    }

    /// Fastest course of a change by one, from rest to rest, within limits of its rate [1/s], of the change of the rate
    /// [1/s²] and of the change of that [1/s³]; the first or the last may be infinite. Seven phases of constant jerk.
    pub fn limited(rate: f64, acceleration: f64, jerk: f64) -> Self {
        // Rate that phases of constant jerk alone reach.
        let highest = rate.min((0.25 * jerk).cbrt());
        let (rate, acceleration) = if acceleration * acceleration >= highest * jerk {
            (highest, (highest * jerk).sqrt())
        } else {
            // Rate that is reached if its two ramps take the whole time.
            let ramp = acceleration / jerk;
            let reached = 0.5 * acceleration * ((ramp * ramp + 4.0 / acceleration).sqrt() - ramp);
            (rate.min(reached), acceleration)
        };
        Self::new(&[1.0 / rate, rate / acceleration, acceleration / jerk])
    }

    /// Course of [`Self::limited`] whose changes of the acceleration take twice as long, so that the jerk rises and
    /// falls in straight lines within the same limit. Fifteen phases; without a limit of the jerk the acceleration
    /// jumps.
    pub fn continuous_jerk(rate: f64, acceleration: f64, jerk: f64) -> Self {
        let mut found = Self::limited(rate, acceleration, jerk);
        // A further box averages all derivatives, so that every limit stays kept.
        let shortest = found.boxes.iter().copied().fold(f64::INFINITY, f64::min);
        if found.boxes.len() == MAX_BOXES - 1 {
            found.boxes.push(shortest);
        }
        found
    }

    /// The course with all times multiplied by a positive factor.
    #[must_use]
    pub(super) fn slowed(&self, factor: f64) -> Self {
        let later = |impulse: &Impulse| Impulse { time: impulse.time * factor, ..*impulse };
        let boxes = self.boxes.iter().map(|duration| duration * factor).collect();
        Self { boxes, impulses: self.impulses.iter().map(later).collect() }
    }

    /// Time in which the course slows down before it ends [s].
    pub(super) fn slowing(&self) -> f64 {
        self.boxes.iter().sum::<f64>() - self.boxes.iter().copied().fold(0.0, f64::max)
    }

    /// Times at which the derivative of the order of the number of boxes jumps [s], ascending. Phases that end together
    /// have one corner, and none if their jumps cancel.
    pub(super) fn corner_times(&self) -> Vec<f64> {
        let own = self.merged_corners();
        let of = |impulse: &Impulse| {
            let (start, size) = (impulse.time, impulse.amplitude);
            own.iter().map(|(jump, at)| (jump * size, start + at)).collect::<Vec<_>>()
        };
        let all = merged(self.impulses.iter().flat_map(of).collect(), self.tolerance());
        all.into_iter().map(|(_, at)| at).collect()
    }

    /// Order of the derivative that jumps at the corners.
    pub(super) fn order_of_corners(&self) -> usize {
        self.boxes.len()
    }

    /// Time within which two corners are one [s].
    fn tolerance(&self) -> f64 {
        SAME_CORNER * self.duration()
    }

    /// Part of the change that is done at a time [s], 0 to 1.
    pub fn done(&self, time: f64) -> f64 {
        self.derivative(time, 0)
    }

    /// Derivative of this order of the part that is done at a time [s]; 0 at a jump and beyond the number of boxes.
    pub fn derivative(&self, time: f64, order: usize) -> f64 {
        let own: f64 = self.boxes.iter().sum();
        let of_one = |t: f64| {
            if t >= own {
                f64::from(u8::from(order == 0))
            } else if t <= 0.0 || order > self.boxes.len() {
                0.0
            } else {
                self.truncated(t, self.boxes.len() - order)
            }
        };
        self.impulses.iter().map(|impulse| impulse.amplitude * of_one(time - impulse.time)).sum()
    }

    /// Part that is done and its three derivatives just before or just after a time [s]; both sides differ at corners
    /// alone.
    ///
    /// The phases are integrated one after the other. The sum of powers over all corners, as in [`Self::derivative`],
    /// would lose digits in a long phase of constant rate between short changes of the acceleration.
    pub fn beside(&self, time: f64, side: Side) -> [f64; ORDERS] {
        let mut found = [0.0; ORDERS];
        for impulse in &self.impulses {
            let own = self.one_beside(time - impulse.time, side);
            found.iter_mut().zip(own).for_each(|(sum, own)| *sum += impulse.amplitude * own);
        }
        found
    }

    /// [`Self::beside`] for a single impulse at the time 0.
    fn one_beside(&self, time: f64, side: Side) -> [f64; ORDERS] {
        let (own, same) = (self.boxes.iter().sum::<f64>(), self.tolerance());
        let has_passed = |corner: f64| match side {
            Side::Before => time > corner + same,
            Side::After => time >= corner - same,
        };
        let mut found = [0.0; ORDERS];
        if has_passed(own) || !has_passed(0.0) {
            found[0] = f64::from(u8::from(has_passed(own)));
            return found;
        }
        if time > 0.5 * own {
            // The rate is the same from both ends.
            let mirrored = if side == Side::Before { Side::After } else { Side::Before };
            let [done, rate, second, third] = self.one_beside((own - time).min(0.5 * own), mirrored);
            return [1.0 - done, rate, -second, third];
        }

        let (count, area) = (self.boxes.len(), self.boxes.iter().product::<f64>());
        let mut state = vec![0.0; count + 1];
        let mut last = 0.0;
        let mut top = 0.0;
        for (jump, at) in self.merged_corners().into_iter().filter(|(_, at)| has_passed(*at)) {
            advance(&mut state, at - last);
            top += jump;
            state[count] = top / area;
            last = at;
        }
        advance(&mut state, (time - last).max(0.0));
        std::array::from_fn(|order| if order <= count { state[order] } else { 0.0 })
    }

    /// Jump of the derivative of the order of the number of boxes, over the product of the boxes, and time of every
    /// corner of the chain.
    fn merged_corners(&self) -> Vec<(f64, f64)> {
        merged(self.corners().collect(), self.tolerance())
    }

    /// Integral of the part that is not done yet, from a time [s] on: the way of a stop from unit speed.
    pub fn remaining(&self, time: f64) -> f64 {
        let own: f64 = self.boxes.iter().sum();
        let left = |t: f64| if t >= own { 0.0 } else { 0.5 * own - t + self.truncated(t, self.boxes.len() + 1) };
        self.impulses.iter().map(|impulse| impulse.amplitude * left(time - impulse.time)).sum()
    }

    /// Integral of order `order` − n of the chain of n boxes convolved.
    fn truncated(&self, time: f64, order: usize) -> f64 {
        let passed = self.corners().filter(|(_, at)| time > *at);
        let sum: f64 = passed.map(|(sign, at)| sign * power(time - at, order)).sum();
        sum / self.boxes.iter().product::<f64>()
    }

    /// Sign and time of every corner of the chain: one per subset of the boxes.
    fn corners(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        (0..1_u32 << self.boxes.len()).map(|subset| {
            let chosen = self.boxes.iter().enumerate().filter(move |(j, _)| subset >> j & 1 == 1);
            chosen.fold((1.0, 0.0), |(sign, at), (_, duration)| (-sign, at + duration))
        })
    }

    fn last_impulse(&self) -> f64 {
        self.impulses.iter().map(|impulse| impulse.time).fold(0.0, f64::max)
    }

    /// `∫ r(τ) e^{λ(T−τ)} dτ` with the rate r, at the end T of the course.
    pub(crate) fn at_end(&self, lambda: Complex) -> Complex {
        let shaped = Shaper { impulses: self.impulses.clone() }.at_end(lambda);
        self.boxes.iter().map(|duration| mean_exponential(lambda * *duration)).product::<Complex>() * shaped
    }

    /// `∫ r(τ) e^{λ(t−τ)} dτ` over τ up to a time t [s].
    pub(crate) fn until(&self, lambda: Complex, time: f64) -> Complex {
        let end = self.duration();
        if time >= end {
            return self.at_end(lambda) * (lambda * (time - end)).exp();
        }
        let order = self.boxes.len();
        let area: f64 = self.boxes.iter().product();
        let mut sum = Complex::new(0.0, 0.0);
        for impulse in &self.impulses {
            let since = time - impulse.time;
            for (sign, at) in self.corners().filter(|(_, at)| since >= *at) {
                sum += remainder(lambda, since - at, order) * (sign * impulse.amplitude / area);
            }
        }
        sum
    }
}

/// Corners in ascending order; several within a time [s] are one, and none if their jumps cancel.
fn merged(mut corners: Vec<(f64, f64)>, same: f64) -> Vec<(f64, f64)> {
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut found: Vec<(f64, f64)> = Vec::with_capacity(corners.len());
    for (jump, at) in corners {
        match found.last_mut() {
            Some(last) if at - last.1 <= same => last.0 += jump,
            _ => found.push((jump, at)),
        }
    }
    found.into_iter().filter(|(jump, _)| jump.abs() > SAME_CORNER).collect()
}

/// Value and derivatives after a time in which the last one is constant.
fn advance(state: &mut [f64], time: f64) {
    for order in 0..state.len() {
        state[order] = state[order..].iter().enumerate().map(|(k, of)| of * power(time, k)).sum();
    }
}

/// `xᵏ/k!`.
fn power<T: Copy + std::ops::Div<f64, Output = T> + std::iter::Product>(x: T, k: usize) -> T {
    (1..=k).map(|j| x / j as f64).product()
}

/// `(eˣ − 1)/x`.
pub(crate) fn mean_exponential(x: Complex) -> Complex {
    remainder(x, 1.0, 1)
}

/// `(e^{λt} − Σ_{m<n} (λt)^m/m!)/λⁿ`: the response of `ẏ = λ y` to `t^{n−1}/(n−1)!`.
fn remainder(lambda: Complex, time: f64, order: usize) -> Complex {
    let x = lambda * time;
    if order == 0 {
        return x.exp();
    }
    if x.norm() <= SMALL {
        // tⁿ/n! (1 + x/(n+1) + x²/((n+1)(n+2)) + …).
        let (mut term, mut sum) = (Complex::new(1.0, 0.0), Complex::new(1.0, 0.0));
        for k in 1..=TERMS {
            term *= x / (order as f64 + f64::from(k));
            sum += term;
        }
        return sum * power(time, order);
    }
    let polynomial: Complex = (0..order).map(|m| power(x, m)).sum();
    (x.exp() - polynomial) / (0..order).map(|_| lambda).product::<Complex>()
}
