//! Nearest points of two sagging cables.
//!
//! Newton's method from the chords alone ends in the wrong one of two minima in some pairs. So pairs of arcs are
//! searched from the least lower bound on. A pair of arcs over which the squared distance is convex has one minimum,
//! which Newton's method finds; others are divided.

use super::TOLERANCE;
use super::arc::{Arc, ArcBounds};
use super::bounded::Bounded;
use super::segments::{self, NearSegments};
use super::span::{FreeSpan, PointOnSpan};
use crate::math::Vec3;
use std::collections::BinaryHeap;

/// Nearest points of two cables.
pub(super) struct NearCables {
    /// Distance of the centre lines [m].
    pub(super) distance: f64,
    /// The points [m].
    pub(super) points_w: [Vec3; 2],
    /// Their places on the cables [m].
    s: [f64; 2],
    /// True if no points near them are nearer.
    is_minimum: bool,
}

/// Maximum number of Newton steps, a guard: two to four are usual.
const MAX_STEPS: usize = 30;

/// Maximum last step of Newton's method along a place, over the length of the cable: its error squares from step to
/// step and becomes rounding.
const MAX_LAST_STEP: f64 = 1e-8;

/// Maximum last step of a method without curvature, whose error shrinks by a factor only.
const MAX_LAST_STEP_WITHOUT_CURVATURE: f64 = 1e-14;

/// Maximum error of the points after a last step that both cables go freely [m]. Steps of a millimetre along taut
/// cables leave 1e-14, steps of a decimetre 1e-8.
const MAX_POINT_ERROR: f64 = 1e-13;

/// Nearest points of two cables, without ends that are mounted together; `None` if nothing is compared, or if the
/// distance is surely above `enough`.
pub(super) fn nearest(one: &FreeSpan, other: &FreeSpan, enough: f64) -> Option<NearCables> {
    let apart = [0, 1].map(|end| (one.ends_w[end] - other.ends_w[end]).norm());
    let first = PairOfArcs::bounded(*one.part(apart)?, *other.part(apart)?);
    if first.lower > enough {
        return None;
    }

    // Most pairs are settled with the first one, which needs no place in the queue.
    let mut best = minimum_in(one, other, &first.of);
    let (mut next, mut queue) = (Some(first), BinaryHeap::new());
    while let Some(Bounded { lower, of: pair }) = next.take().or_else(|| queue.pop()) {
        // No points are nearer than those that touch: two cables on one line touch everywhere.
        if lower.max(0.0) >= best.distance - TOLERANCE {
            break;
        }
        let [own, others] = &pair.arcs;
        let is_smallest = own.sagitta.max(others.sagitta) < 0.25 * TOLERANCE;
        let has_one_minimum = is_convex(&pair.arcs);
        if is_smallest || has_one_minimum {
            // A minimum of a larger pair that lies in this one is the one that it has.
            let is_known = has_one_minimum && best.is_minimum && own.holds(best.s[0]) && others.holds(best.s[1]);
            if !is_known {
                let found = minimum_in(one, other, &pair);
                best = if found.distance < best.distance { found } else { best };
            }
        } else if own.sagitta >= others.sagitta {
            one.halves(own).into_iter().for_each(|half| queue.push(PairOfArcs::bounded(half, *others)));
        } else {
            other.halves(others).into_iter().for_each(|half| queue.push(PairOfArcs::bounded(*own, half)));
        }
    }
    Some(best)
}

/// Arcs of both cables, with the nearest points of their chords.
struct PairOfArcs {
    arcs: [Arc; 2],
    /// Places of the nearest points of the chords, from 0 to 1.
    fractions: [f64; 2],
}

impl PairOfArcs {
    /// Arcs with a lower bound of the distance of their points [m]: along the line between the nearest points of the
    /// chords, no points of the chords are nearer than these, and the arcs reach beyond them by a part of their
    /// sagittas.
    fn bounded(own: Arc, other: Arc) -> Bounded<Self> {
        let NearSegments { distance, fractions, apart_w } = segments::nearest(&own.points_w, &other.points_w);
        let reach = if distance > 0.0 {
            let away_w = apart_w / distance;
            own.reach(&-away_w) + other.reach(&away_w)
        } else {
            own.sagitta + other.sagitta
        };
        Bounded { lower: distance - reach, of: Self { arcs: [own, other], fractions } }
    }
}

/// Minimum of the distance within a pair of arcs that Newton's method reaches from the nearest points of the chords.
fn minimum_in(one: &FreeSpan, other: &FreeSpan, pair: &PairOfArcs) -> NearCables {
    let ranges = [pair.arcs[0].s, pair.arcs[1].s];
    let at = |k: usize| ranges[k][0] + pair.fractions[k] * (ranges[k][1] - ranges[k][0]);
    let mut places = [at(0), at(1)];
    let mut best = NearCables { distance: f64::INFINITY, points_w: [Vec3::zeros(); 2], s: places, is_minimum: false };
    let mut consider = |points_w: [Vec3; 2], s: [f64; 2]| {
        let distance = (points_w[0] - points_w[1]).norm();
        if distance < best.distance {
            best = NearCables { distance, points_w, s, is_minimum: false };
        }
    };

    for _ in 0..MAX_STEPS {
        let own = one.point_with_derivatives(places[0]);
        let others = other.point_with_derivatives(places[1]);
        consider([own.point_w, others.point_w], places);
        let NewtonStep { by: [ds, dt], is_newtons, is_free } = step(&own, &others, places, ranges);
        if !(ds.is_finite() && dt.is_finite()) {
            break;
        }
        let next =
            [(places[0] + ds).clamp(ranges[0][0], ranges[0][1]), (places[1] + dt).clamp(ranges[1][0], ranges[1][1])];
        let moves = [next[0] - places[0], next[1] - places[1]];
        let moved = moves[0].abs() / one.length + moves[1].abs() / other.length;
        let largest = if is_newtons { MAX_LAST_STEP } else { MAX_LAST_STEP_WITHOUT_CURVATURE };
        let is_exact = is_free && point_error(&pair.arcs, moves).is_some_and(|error| error < MAX_POINT_ERROR);
        if is_exact || moved < largest {
            // So near, the derivatives give the points to rounding.
            consider([own.after(moves[0]), others.after(moves[1])], next);
            best.is_minimum = is_newtons;
            break;
        }
        places = next;
    }
    best
}

/// Step of both places.
struct NewtonStep {
    by: [f64; 2],
    /// True if it is Newton's, false if it is one without curvature.
    is_newtons: bool,
    /// True if it is Newton's along both cables, which no end of a range holds.
    is_free: bool,
}

/// Newton step of half the squared distance, along free coordinates only: a place at the end of its range stays there
/// while the distance falls beyond.
fn step(own: &PointOnSpan, others: &PointOnSpan, places: [f64; 2], ranges: [[f64; 2]; 2]) -> NewtonStep {
    let apart = own.point_w - others.point_w;
    let gradient = [apart.dot(&own.slope_w), -apart.dot(&others.slope_w)];
    let squares = [own.slope_w.norm_squared(), others.slope_w.norm_squared()];
    let mixed = -own.slope_w.dot(&others.slope_w);

    // Without the curvature where it makes the matrix indefinite: then the step goes downhill in any case.
    let with_curvature = [squares[0] + apart.dot(&own.curvature_w), squares[1] - apart.dot(&others.curvature_w)];
    let is_definite =
        with_curvature[0] > 0.0 && with_curvature[1] > 0.0 && with_curvature[0] * with_curvature[1] > mixed * mixed;
    let [ss, tt] = if is_definite { with_curvature } else { squares };

    let held =
        |k: usize| (places[k] <= ranges[k][0] && gradient[k] > 0.0) || (places[k] >= ranges[k][1] && gradient[k] < 0.0);
    let determinant = ss * tt - mixed * mixed;
    let [mut ds, mut dt] = match [held(0), held(1)] {
        [true, true] => [0.0, 0.0],
        [true, false] => [0.0, -gradient[1] / tt],
        [false, true] => [-gradient[0] / ss, 0.0],
        // Parallel: each by itself.
        [false, false] if determinant <= f64::EPSILON * ss * tt => [-gradient[0] / ss, 0.0],
        [false, false] => [
            -(tt * gradient[0] - mixed * gradient[1]) / determinant,
            -(ss * gradient[1] - mixed * gradient[0]) / determinant,
        ],
    };

    // One of both reaches the end of its range: the other one follows alone.
    let beyond = |k: usize, by: f64| places[k] + by < ranges[k][0] || places[k] + by > ranges[k][1];
    let are_free = !held(0) && !held(1) && determinant > f64::EPSILON * ss * tt;
    let is_free = is_definite && are_free && !beyond(0, ds) && !beyond(1, dt);
    if !held(0) && !held(1) {
        if beyond(0, ds) {
            ds = (places[0] + ds).clamp(ranges[0][0], ranges[0][1]) - places[0];
            dt = -(gradient[1] + mixed * ds) / tt;
        } else if beyond(1, dt) {
            dt = (places[1] + dt).clamp(ranges[1][0], ranges[1][1]) - places[1];
            ds = -(gradient[0] + mixed * dt) / ss;
        }
    }
    NewtonStep { by: [ds, dt], is_newtons: is_definite, is_free }
}

/// Error of the points after a step along both arcs [m]: the step times the square of the angle by which they bend
/// along it at most. `None` where an arc has no bounds.
fn point_error([own, others]: &[Arc; 2], moves: [f64; 2]) -> Option<f64> {
    let error = |arc: &Arc, by: f64| Some(arc.bounds.as_ref()?.bend_squared() * by.abs().powi(3));
    Some(error(own, moves[0])? + error(others, moves[1])?)
}

/// True if half the squared distance is surely convex over a pair of arcs: its second derivatives are bounded by those
/// of the arcs.
fn is_convex([own, others]: &[Arc; 2]) -> bool {
    let (Some(a), Some(b)) = (&own.bounds, &others.bounds) else { return false };
    let farthest = own.points_w.iter().flat_map(|p| others.points_w.iter().map(move |q| (p - q).norm_squared()));
    let farthest = farthest.fold(0.0, f64::max).sqrt() + own.sagitta + others.sagitta;

    let least = [own.least_second_derivative(a, others, farthest), others.least_second_derivative(b, own, farthest)];
    let chords_w = [own, others].map(|arc| arc.points_w[1] - arc.points_w[0]);
    let mixed = a.slope[1] * b.slope[1] * ArcBounds::greatest_cosine(a, b, [&chords_w[0], &chords_w[1]]);
    least[0] > 0.0 && least[1] > 0.0 && least[0] * least[1] > mixed * mixed
}
