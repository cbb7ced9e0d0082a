//! Pairs of undamped modes and damped zeros: each mode has the zero to which it moves while its damping grows from
//! nothing to all of it.
//!
//! Where the damping of first order leads beside one zero and far from all others, this zero is meant. Elsewhere, as
//! where a mode of the platform comes near to those of the ropes, the mode is followed in steps so short that no other
//! zero is near. What cannot be followed is told.

use super::{CONVERGED, DampedMode, MAX_ROUNDING, Mode, ONE_ZERO};
use crate::dynamics::Dynamics;
use crate::math::Complex;
use std::f64::consts::TAU;

/// Distance of a prediction from a zero, over that from the next one, up to which the zero is meant; and the ratio of
/// two steps of Newton's method up to which a step is short enough: it is this ratio of distances, too.
const CLEAR: f64 = 0.1;

/// Minimum step of the part of the damping by which a mode is followed. Pairs of modes that come nearer than a
/// thousandth of their distance without damping change their motions into each other: neither has a partner.
const MIN_STEP: f64 = 1e-3;

/// Relative step of Newton's method at which a zero is near enough before all of the damping acts.
const ON_THE_WAY: f64 = 1e-7;

/// Maximum number of steps of Newton's method for one zero: each is ten times shorter than the one before.
const MAX_STEPS: usize = 16;

/// Maximum relative distance of a followed zero from a listed one that is the same.
const SAME_ZERO: f64 = 1e-7;

/// Relative distance of two modes up to which they may have been exchanged.
const BESIDE: f64 = 0.01;

/// Relative distance of a zero from the damping of first order up to which it is that of the mode: light damping leaves
/// its square, 1e-5.
const OF_FIRST_ORDER: f64 = 1e-3;

/// Relative distance of zeros up to which an answer is the same: a threefold zero is found to 1e-5, the third root of
/// rounding.
const SAME_ANSWER: f64 = 2e-5;

/// Robot whose modes are followed.
pub(super) struct FollowedMode<'a> {
    pub(super) dynamics: &'a Dynamics,
    /// Frequency up to which the clamped modes of the cables are divided out [rad/s].
    pub(super) poles_below: f64,
}

/// Zeros in the order of the modes.
pub(super) struct Pairs {
    pub(super) modes: Vec<DampedMode>,
    /// Modes for which it is not clear which zero is theirs, by their indices, ascending.
    pub(super) unclear: Vec<usize>,
    /// Zeros that belong to none of the modes.
    pub(super) others: Vec<DampedMode>,
}

/// Place at which there are as many zeros as are free.
struct ModePlace {
    zero: DampedMode,
    free: usize,
}

impl FollowedMode<'_> {
    /// Pairs of modes with the zeros of a search, which come in the order of the modes, and then others. `is_known`
    /// tells for each mode whether its zero is known without a search.
    pub(super) fn paired(&self, modes: &[Mode], zeros: &[DampedMode], is_known: impl Fn(usize) -> bool) -> Pairs {
        let mut places = places_of(zeros);
        let mut found: Vec<Option<DampedMode>> = vec![None; modes.len()];
        let mut take = |places: &mut [ModePlace], k: usize, at: usize| -> bool {
            let is_free = places[at].free > 0;
            if is_free {
                places[at].free -= 1;
                found[k] = Some(places[at].zero);
            }
            is_free
        };

        // Zeros that are known or that the damping of first order finds, then those that are followed.
        let mut doubtful = Vec::new();
        for (k, mode) in modes.iter().enumerate() {
            let of_first_order = mode.frequency_hz * TAU * Complex::new(1.0, mode.damping_ratio);
            let meant =
                if is_known(k) { nearest(&places, zeros[k].omega).0 } else { clearly_nearest(&places, of_first_order) };
            if !meant.is_some_and(|at| take(&mut places, k, at)) {
                doubtful.push(k);
            }
        }
        let mut outside = Vec::new();
        for k in doubtful.into_iter().filter(|k| modes[*k].multiplicity == 1) {
            let Some(zero) = self.follow(&modes[k]) else { continue };
            match nearest(&places, zero.omega) {
                (Some(at), distance) if distance <= SAME_ZERO * zero.omega.norm() => {
                    take(&mut places, k, at);
                }
                // The zero has left the region of the list.
                _ => outside.push((k, zero)),
            }
        }
        for (k, zero) in outside {
            found[k] = Some(zero);
        }

        // What is left goes to its own start, or to the nearest zero that is left.
        let unclear: Vec<usize> = (0..modes.len()).filter(|k| found[*k].is_none()).collect();
        for own in [true, false] {
            for &k in &unclear {
                if found[k].is_some() {
                    continue;
                }
                let is_free = |place: &&mut ModePlace| place.free > 0;
                let distance = |place: &ModePlace| (place.zero.omega - zeros[k].omega).norm();
                let left = places.iter_mut().filter(is_free).min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let Some(place) = left else { continue };
                if !own || distance(place) <= ONE_ZERO * zeros[k].omega.norm() {
                    place.free -= 1;
                    found[k] = Some(place.zero);
                }
            }
        }
        let unclear = exchangeable(modes, &found, &unclear);
        let modes = found.into_iter().zip(zeros).map(|(found, own)| found.unwrap_or(*own)).collect();
        let others = places.iter().flat_map(|place| std::iter::repeat_n(place.zero, place.free)).collect();
        Pairs { modes, unclear, others }
    }

    /// Zero to which a mode moves while the damping grows; `None` if it comes too near to another one on the way.
    pub(super) fn follow(&self, mode: &Mode) -> Option<DampedMode> {
        let mut omega = Complex::from(mode.frequency_hz * TAU);
        let mut slope = Complex::i() * omega * mode.damping_ratio;
        let (mut part, mut step) = (0.0, 0.5);
        loop {
            let next = if part + step >= 1.0 { 1.0 } else { part + step };
            let by = next - part;
            let Some((zero, error)) = self.zero_beside(omega + slope * by, next) else {
                step *= 0.5;
                if step < MIN_STEP {
                    return None;
                }
                continue;
            };
            if next >= 1.0 {
                return Some(DampedMode { omega: zero, error });
            }
            // Slope at the end of the parabola through both ends with the slope at its beginning.
            slope = 2.0 * (zero - omega) / by - slope;
            (omega, part, step) = (zero, next, 2.0 * step);
        }
    }

    /// Zero with a part of the damping beside a prediction, with its relative error; `None` if the prediction is not
    /// much nearer to it than to any other. Beside a zero at the distance e, with another one at the distance g, the
    /// step that follows Newton's step e is e²/g.
    fn zero_beside(&self, prediction: Complex, part: f64) -> Option<(Complex, f64)> {
        let near_enough = if part < 1.0 { ON_THE_WAY } else { CONVERGED };
        let (mut omega, mut before) = (prediction, f64::INFINITY);
        for _ in 0..MAX_STEPS {
            let step = 1.0 / self.dynamics.logarithmic_slope(omega, part, self.poles_below);
            let size = step.norm() / omega.norm();
            if !size.is_finite() {
                // At a zero, to rounding.
                return Some((omega, 0.0));
            }
            let is_rounding = size <= MAX_ROUNDING && size > CLEAR * before;
            if is_rounding || size <= near_enough {
                return Some((omega - step, size));
            }
            if size > CLEAR * before {
                return None;
            }
            omega -= step;
            before = size;
        }
        None
    }
}

/// Modes of those without a clear zero for which it matters which one they have: their zero is not that of their
/// damping of first order, or a mode beside them has another one. Zeros of modes of one frequency are one, except for
/// rounding.
fn exchangeable(modes: &[Mode], found: &[Option<DampedMode>], unclear: &[usize]) -> Vec<usize> {
    let apart = |a: Complex, b: Complex, part: f64| (a - b).norm() > part * a.norm();
    let of_first_order = |k: usize| modes[k].frequency_hz * TAU * Complex::new(1.0, modes[k].damping_ratio);
    let matters = |k: usize| {
        let Some(zero) = found[k] else { return true };
        let beside = unclear.iter().filter(|j| **j != k && !apart(of_first_order(k), of_first_order(**j), BESIDE));
        apart(zero.omega, of_first_order(k), OF_FIRST_ORDER)
            || beside.into_iter().any(|j| found[*j].is_none_or(|other| apart(zero.omega, other.omega, SAME_ANSWER)))
    };
    unclear.iter().copied().filter(|k| matters(*k)).collect()
}

/// Distinct places of zeros.
fn places_of(zeros: &[DampedMode]) -> Vec<ModePlace> {
    let mut places: Vec<ModePlace> = Vec::with_capacity(zeros.len());
    for zero in zeros {
        let is_here = |place: &&mut ModePlace| (place.zero.omega - zero.omega).norm() <= ONE_ZERO * zero.omega.norm();
        match places.iter_mut().rev().find(is_here) {
            Some(place) => place.free += 1,
            None => places.push(ModePlace { zero: *zero, free: 1 }),
        }
    }
    places
}

/// Nearest place, by its index, and its distance.
fn nearest(places: &[ModePlace], omega: Complex) -> (Option<usize>, f64) {
    let [(at, distance), _] = two_nearest(places, omega);
    (at, distance)
}

/// Place that is nearest by far.
fn clearly_nearest(places: &[ModePlace], omega: Complex) -> Option<usize> {
    let [(at, distance), (_, next)] = two_nearest(places, omega);
    at.filter(|_| distance <= CLEAR * next)
}

fn two_nearest(places: &[ModePlace], omega: Complex) -> [(Option<usize>, f64); 2] {
    let mut best = [(None, f64::INFINITY); 2];
    for (at, place) in places.iter().enumerate() {
        let distance = (place.zero.omega - omega).norm();
        if distance < best[0].1 {
            best = [(Some(at), distance), best[0]];
        } else if distance < best[1].1 {
            best[1] = (Some(at), distance);
        }
    }
    best
}
