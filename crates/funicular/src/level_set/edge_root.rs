//! Zeros of the function on many segments at once, each by inverse quadratic interpolation within a bracket.

use super::{Evaluate, is_inside};
use crate::math::Vec3;

/// Evaluations after which a zero is taken as it is: bisection alone narrows a segment by 2⁶⁰.
const MAX_EVALUATIONS: usize = 60;

/// Evaluations within which the bracket has to shrink to a half; otherwise it is halved.
const PATIENCE: usize = 4;

/// Fraction of a segment, and the value of the function there if it has one.
type EdgeSample = (f64, Option<f64>);

/// Segment from a point inside the set to one outside, with the zero of the function between them.
#[derive(Debug, Clone)]
pub(super) struct EdgeRoot {
    from: Vec3,
    to: Vec3,
    /// Nearest sample inside and outside.
    inner: EdgeSample,
    outer: EdgeSample,
    /// EdgeSample that was such an end before, for the curvature.
    replaced: Option<EdgeSample>,
    /// Width of the bracket when it was last halved, and the evaluations since then.
    halved: (f64, usize),
    evaluations: usize,
    /// Fraction of the zero, as well as it is known.
    at: f64,
    is_done: bool,
}

impl EdgeRoot {
    /// Segment with the values at its ends; that at the inner end is not negative, that at the outer end is negative or
    /// missing.
    pub(super) fn new([from, to]: [Vec3; 2], [inner, outer]: [Option<f64>; 2]) -> Self {
        let is_done = inner == Some(0.0);
        let mut root = Self {
            from,
            to,
            inner: (0.0, inner),
            outer: (1.0, outer),
            replaced: None,
            halved: (1.0, 0),
            evaluations: 0,
            at: 0.0,
            is_done,
        };
        if !is_done {
            root.at = root.guess();
        }
        root
    }

    /// Point of the zero.
    pub(super) fn point(&self) -> Vec3 {
        self.from + (self.to - self.from) * self.at
    }

    /// Finds the zeros of all segments to a tolerance [m]. Returns the number of evaluations, and whether all zeros
    /// were found: otherwise the work was stopped.
    pub(super) fn find_all(roots: &mut [Self], tolerance: f64, evaluate: &mut Evaluate<'_>) -> (usize, bool) {
        let mut evaluations = 0;
        loop {
            let open: Vec<usize> = (0..roots.len()).filter(|i| !roots[*i].is_done).collect();
            if open.is_empty() {
                return (evaluations, true);
            }

            let points: Vec<Vec3> = open.iter().map(|i| roots[*i].point()).collect();
            let Some(values) = evaluate(&points) else { return (evaluations, false) };
            evaluations += points.len();
            for (i, value) in open.into_iter().zip(values) {
                roots[i].add(value, tolerance);
            }
        }
    }

    /// Takes the value at the present guess and makes the next one.
    fn add(&mut self, value: Option<f64>, tolerance: f64) {
        let length = (self.to - self.from).norm();
        let before = self.at;
        self.evaluations += 1;
        let end = if is_inside(value) { &mut self.inner } else { &mut self.outer };
        self.replaced = Some(std::mem::replace(end, (before, value)));

        let width = (self.outer.0 - self.inner.0).abs();
        self.halved = if width <= 0.5 * self.halved.0 { (width, 0) } else { (self.halved.0, self.halved.1 + 1) };
        if value == Some(0.0) {
            self.is_done = true;
            return;
        }

        // The change of an interpolated guess bounds the error of the one before.
        self.at = self.guess();
        let moved = (self.at - before).abs() * length;
        let is_near = moved <= tolerance && self.outer.1.is_some();
        self.is_done = is_near || width * length <= tolerance || self.evaluations >= MAX_EVALUATIONS;
    }

    /// Next fraction to try, between the ends of the bracket.
    fn guess(&self) -> f64 {
        let middle = f64::midpoint(self.inner.0, self.outer.0);
        if self.outer.1.is_none() || self.halved.1 > PATIENCE {
            return middle;
        }
        let is_between = |at: &f64| (at - self.inner.0) * (self.outer.0 - at) > 0.0;
        let ends = [self.inner, self.outer];
        let curved = self.replaced.and_then(|replaced| inverse_interpolation(&[ends[0], ends[1], replaced]));
        curved.filter(is_between).or_else(|| inverse_interpolation(&ends).filter(is_between)).unwrap_or(middle)
    }
}

/// Zero of the polynomial through samples whose argument is the value (Lagrange); `None` without a value or with two
/// equal ones.
fn inverse_interpolation(samples: &[EdgeSample]) -> Option<f64> {
    let mut zero = 0.0;
    for (i, (at, value)) in samples.iter().enumerate() {
        let mut term = *at;
        for (_, other) in samples.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, sample)| sample) {
            term *= (*other)? / ((*other)? - (*value)?);
        }
        zero += term;
    }
    zero.is_finite().then_some(zero)
}
