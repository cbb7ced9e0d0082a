//! Nearest points of two sagging cables.
//!
//! Newton's method from the chords alone ends in the wrong one of two minima in some pairs. So pairs of arcs are
//! searched from the least lower bound on. A pair of arcs over which the squared distance is convex has one minimum,
//! which Newton's method finds; others are divided.

use super::TOLERANCE;
use super::span::{Arc, ArcBounds, FreeSpan, PointOnSpan};
use crate::math::Vec3;
use parry3d_f64::math::Vector;
use parry3d_f64::query::details::closest_points_segment_segment_with_locations_nD;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Nearest points of two cables.
pub(super) struct NearCables {
    /// Distance of the centre lines [m].
    pub(super) distance: f64,
    /// The points [m].
    pub(super) points_w: [Vec3; 2],
}

/// Maximum number of Newton steps, a guard: two to four are usual.
const MAX_STEPS: usize = 30;

/// Change of a place, over the length of the cable, at which Newton's method ends: rounding.
const ARRIVED: f64 = 1e-14;

/// Nearest points of two cables, without ends that are mounted together; `None` if nothing is compared, or if the distance
/// is surely above `enough`.
pub(super) fn nearest(one: &FreeSpan, other: &FreeSpan, enough: f64) -> Option<NearCables> {
    let ends = |span: &FreeSpan| [span.point(0.0), span.point(span.length)];
    let (own, others) = (ends(one), ends(other));
    let apart = [(own[0] - others[0]).norm(), (own[1] - others[1]).norm()];
    let (own_range, other_range) = (one.compared(apart)?, other.compared(apart)?);

    let mut best = NearCables { distance: f64::INFINITY, points_w: own };
    let mut queue = BinaryHeap::new();
    let first = PairOfArcs::new(one.arc(own_range), other.arc(other_range));
    if first.lower > enough {
        return None;
    }
    queue.push(first);

    while let Some(pair) = queue.pop() {
        if pair.lower >= best.distance - TOLERANCE {
            break;
        }
        let found = minimum_in(one, other, &pair);
        if found.distance < best.distance {
            best = found;
        }
        let is_smallest = pair.arcs.iter().all(|arc| arc.sagitta < 0.25 * TOLERANCE);
        if is_smallest || is_convex(one, other, &pair) {
            continue;
        }
        let [own, others] = &pair.arcs;
        if own.sagitta >= others.sagitta {
            one.halves(own).into_iter().for_each(|half| queue.push(PairOfArcs::new(half, *others)));
        } else {
            other.halves(others).into_iter().for_each(|half| queue.push(PairOfArcs::new(*own, half)));
        }
    }
    Some(best)
}

/// Arcs of both cables, with the nearest points of their chords.
struct PairOfArcs {
    arcs: [Arc; 2],
    /// No points of the arcs are nearer [m].
    lower: f64,
    /// Places of the nearest points of the chords, from 0 to 1.
    fractions: [f64; 2],
}

impl PairOfArcs {
    fn new(own: Arc, other: Arc) -> Self {
        let [a, b, c, d] = [own.points_w[0], own.points_w[1], other.points_w[0], other.points_w[1]]
            .map(|point| Vector::new(point.x, point.y, point.z));
        let (one, two) = closest_points_segment_segment_with_locations_nD((&a, &b), (&c, &d));
        let fractions = [one, two].map(|location| location.barycentric_coordinates()[1]);
        let distance = (a + (b - a) * fractions[0] - c - (d - c) * fractions[1]).length();
        Self { lower: distance - own.sagitta - other.sagitta, arcs: [own, other], fractions }
    }
}

/// Minimum of the distance within a pair of arcs that Newton's method reaches from the nearest points of the chords.
fn minimum_in(one: &FreeSpan, other: &FreeSpan, pair: &PairOfArcs) -> NearCables {
    let ranges = [pair.arcs[0].s, pair.arcs[1].s];
    let at = |k: usize| ranges[k][0] + pair.fractions[k] * (ranges[k][1] - ranges[k][0]);
    let mut places = [at(0), at(1)];
    let mut best = NearCables { distance: f64::INFINITY, points_w: [Vec3::zeros(); 2] };

    for _ in 0..MAX_STEPS {
        let own = one.point_with_derivatives(places[0]);
        let others = other.point_with_derivatives(places[1]);
        let distance = (own.point_w - others.point_w).norm();
        if distance < best.distance {
            best = NearCables { distance, points_w: [own.point_w, others.point_w] };
        }
        let [ds, dt] = step(&own, &others, places, ranges);
        if !(ds.is_finite() && dt.is_finite()) {
            break;
        }
        let next =
            [(places[0] + ds).clamp(ranges[0][0], ranges[0][1]), (places[1] + dt).clamp(ranges[1][0], ranges[1][1])];
        let moved = (next[0] - places[0]).abs() / one.length + (next[1] - places[1]).abs() / other.length;
        places = next;
        if moved < ARRIVED {
            break;
        }
    }
    best
}

/// Newton step of half the squared distance, along free coordinates only: a place at the end of its range stays there
/// while the distance falls beyond.
fn step(own: &PointOnSpan, others: &PointOnSpan, places: [f64; 2], ranges: [[f64; 2]; 2]) -> [f64; 2] {
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
    if !held(0) && !held(1) {
        if beyond(0, ds) {
            ds = (places[0] + ds).clamp(ranges[0][0], ranges[0][1]) - places[0];
            dt = -(gradient[1] + mixed * ds) / tt;
        } else if beyond(1, dt) {
            dt = (places[1] + dt).clamp(ranges[1][0], ranges[1][1]) - places[1];
            ds = -(gradient[0] + mixed * dt) / ss;
        }
    }
    [ds, dt]
}

/// True if half the squared distance is surely convex over a pair of arcs: its second derivatives are bounded by the
/// slopes and curvatures at the ends and by the largest distance.
fn is_convex(one: &FreeSpan, other: &FreeSpan, pair: &PairOfArcs) -> bool {
    let [own, others] = &pair.arcs;
    let (Some(a), Some(b)) = (one.bounds(own), other.bounds(others)) else { return false };
    let farthest = own.points_w.iter().flat_map(|p| others.points_w.iter().map(move |q| (p - q).norm()));
    let farthest = farthest.fold(0.0, f64::max) + own.sagitta + others.sagitta;

    let least = |bounds: &ArcBounds| bounds.slope[0] * bounds.slope[0] - farthest * bounds.curvature;
    // Angle between the lines of the chords, less what the curves turn from them.
    let (p, q) = (own.points_w[1] - own.points_w[0], others.points_w[1] - others.points_w[0]);
    let angle = p.cross(&q).norm().atan2(p.dot(&q).abs()) - a.turn - b.turn;
    let mixed = a.slope[1] * b.slope[1] * angle.max(0.0).cos();
    least(&a) > 0.0 && least(&b) > 0.0 && least(&a) * least(&b) > mixed * mixed
}

impl PartialEq for PairOfArcs {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for PairOfArcs {}

impl PartialOrd for PairOfArcs {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for PairOfArcs {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}
