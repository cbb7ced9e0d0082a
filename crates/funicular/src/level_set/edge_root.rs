//! Ends of the set on many segments at once, each by inverse quadratic interpolation within a bracket.
//!
//! The values decide only where they are those of a smooth function. Where the set ends at a jump, at the end of a
//! plateau of zeros or where the function has no value, its sides alone narrow the bracket.

use super::{Evaluate, is_inside};
use crate::math::Vec3;

/// Evaluations after which a zero is taken as it is: bisection alone narrows a segment by 2⁶⁰.
const MAX_EVALUATIONS: usize = 60;

/// Evaluations within which the bracket has to shrink to a half; otherwise it is halved.
const PATIENCE: usize = 4;

/// Largest ratio of the slopes on both sides of a zero that counts as smooth. A kink at the end of the set costs one
/// more evaluation only.
const MAX_SLOPE_RATIO: f64 = 3.0;

/// Part of the tolerance beyond a zero at which the other side is looked for.
const PROBE: f64 = 0.5;

/// Width of a bracket over the tolerance at which a probe has confirmed the zero in it.
const MAX_PROBED: f64 = 2.0;

/// Fraction of a segment, and the value of the function there if it has one.
type EdgeSample = (f64, Option<f64>);

/// Next evaluation on a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NextSample {
    /// At the zero of the interpolation.
    Zero,
    /// Just beyond it, to see whether the set really ends there.
    Probe,
    /// In the middle of the bracket, until it is narrow.
    Middle,
}

/// Segment from a point inside the set to one outside, with the end of the set between them.
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
    /// Fraction of the next evaluation, and its reason; at the end, the fraction of the end of the set.
    at: f64,
    next: NextSample,
    is_done: bool,
}

impl EdgeRoot {
    /// Segment with the values at its ends; that at the inner end is not negative, that at the outer end is negative or
    /// missing. Zeros are found to a tolerance [m].
    pub(super) fn new([from, to]: [Vec3; 2], [inner, outer]: [Option<f64>; 2], tolerance: f64) -> Self {
        let mut root = Self {
            from,
            to,
            inner: (0.0, inner),
            outer: (1.0, outer),
            replaced: None,
            halved: (1.0, 0),
            evaluations: 0,
            at: 0.0,
            next: NextSample::Zero,
            is_done: false,
        };
        root.at = root.zero();
        if inner == Some(0.0) {
            root.probe(tolerance);
        }
        root
    }

    /// End of the set: to the tolerance once it was found, before as the values let expect it.
    pub(super) fn end(&self) -> Vec3 {
        self.point(if self.is_done { self.at } else { self.zero() })
    }

    fn point(&self, at: f64) -> Vec3 {
        self.from + (self.to - self.from) * at
    }

    /// Finds the ends of the set on all segments to a tolerance [m]. Returns the number of evaluations, and whether all
    /// were found: otherwise the work was stopped.
    pub(super) fn find_all(roots: &mut [Self], tolerance: f64, evaluate: &mut Evaluate<'_>) -> (usize, bool) {
        let mut evaluations = 0;
        loop {
            let open: Vec<usize> = (0..roots.len()).filter(|i| !roots[*i].is_done).collect();
            if open.is_empty() {
                return (evaluations, true);
            }

            let points: Vec<Vec3> = open.iter().map(|i| roots[*i].point(roots[*i].at)).collect();
            let Some(values) = evaluate(&points) else { return (evaluations, false) };
            evaluations += points.len();
            for (i, value) in open.into_iter().zip(values) {
                roots[i].add(value, tolerance);
            }
        }
    }

    /// Takes the value at the present fraction and chooses the next one.
    fn add(&mut self, value: Option<f64>, tolerance: f64) {
        let length = (self.to - self.from).norm();
        let before = self.at;
        self.evaluations += 1;
        let end = if is_inside(value) { &mut self.inner } else { &mut self.outer };
        self.replaced = Some(std::mem::replace(end, (before, value)));

        let width = (self.outer.0 - self.inner.0).abs();
        self.halved = if width <= 0.5 * self.halved.0 { (width, 0) } else { (self.halved.0, self.halved.1 + 1) };
        let probed = self.next == NextSample::Probe;
        let allowed = if probed { MAX_PROBED } else { 1.0 } * tolerance;
        if width * length <= allowed || self.evaluations >= MAX_EVALUATIONS {
            (self.at, self.is_done) = (self.zero(), true);
            return;
        }
        if probed {
            self.next = NextSample::Middle;
        }

        // The change of an interpolated zero bounds the error of the one before, if the function is smooth.
        self.at = self.zero();
        let is_near = (self.at - before).abs() * length <= tolerance;
        if self.next == NextSample::Zero && is_near {
            if self.is_smooth() {
                self.is_done = true;
            } else {
                self.probe(tolerance);
            }
        }
    }

    /// Goes just beyond the zero, to the side where nothing was evaluated near it.
    fn probe(&mut self, tolerance: f64) {
        let beyond = PROBE * tolerance / (self.to - self.from).norm();
        let is_near_inner = self.at - self.inner.0 <= self.outer.0 - self.at;
        let at = if is_near_inner { self.at + beyond } else { self.at - beyond };
        self.next = NextSample::Probe;
        self.at = if at > self.inner.0 && at < self.outer.0 { at } else { self.middle() };
    }

    /// True if the values on both sides of the zero are those of one smooth function, as far as three samples tell.
    fn is_smooth(&self) -> bool {
        let slope = |a: EdgeSample, b: EdgeSample| Some((b.1? - a.1?) / (b.0 - a.0));
        let Some(replaced) = self.replaced else { return false };
        let across = slope(self.inner, self.outer);
        let beside = if replaced.0 <= self.inner.0 { slope(replaced, self.inner) } else { slope(self.outer, replaced) };
        let (Some(across), Some(beside)) = (across, beside) else { return false };
        let ratio = across / beside;
        ratio > 1.0 / MAX_SLOPE_RATIO && ratio < MAX_SLOPE_RATIO
    }

    /// Fraction of the zero: by interpolation as long as the function seems to be smooth, then the middle of the
    /// bracket.
    fn zero(&self) -> f64 {
        if self.next == NextSample::Middle || self.outer.1.is_none() || self.halved.1 > PATIENCE {
            return self.middle();
        }
        if self.inner.1 == Some(0.0) {
            return self.inner.0;
        }
        let is_between = |at: &f64| *at > self.inner.0 && *at < self.outer.0;
        let ends = [self.inner, self.outer];
        let curved = self.replaced.and_then(|replaced| inverse_interpolation(&[ends[0], ends[1], replaced]));
        let straight = || inverse_interpolation(&ends).filter(is_between);
        curved.filter(is_between).or_else(straight).unwrap_or_else(|| self.middle())
    }

    fn middle(&self) -> f64 {
        f64::midpoint(self.inner.0, self.outer.0)
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
