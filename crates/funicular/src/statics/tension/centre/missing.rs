//! Proof, in a bounded number of steps, that no tensions within the limits balance the load: a direction of wrenches in
//! which the cables do not reach it, (39a).
//!
//! Between its limits the wrench of each cable is nearly a straight line. For straight lines, the dual of the centre is
//! a concave function of the multipliers, unbounded exactly where there are no tensions, and Newton's method on it runs
//! along a direction that proves it. The true curves confirm the direction by upper bounds, (39b).

use super::{CentreCable, CentreSearch, MAX_INLINE};
use crate::math::{Mat6, Vec6};
use crate::statics::wrench_set::{CurveBetween, CurvePoint};
use arrayvec::ArrayVec;

/// Maximum number of Newton steps on the dual; 3 to 12 are usual.
const MAX_STEPS: usize = 24;

/// Newton decrement above which a step is shortened, as for self-concordant functions.
const LONG: f64 = 0.4;

/// Maximum number of doublings of a shortened step while the dual still grows along it.
const MAX_DOUBLINGS: usize = 4;

/// Part of the sizes of all contributions below which a missing wrench is rounding.
const ROUNDING: f64 = 1e-12;

/// Missing wrench.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MissingInDirection {
    /// Direction, reduced, of length 1.
    pub(crate) direction: Vec6,
    /// Least size of the missing wrench along it [N].
    pub(crate) size: f64,
    /// Cables that reach farthest along it at their maximum, one bit each; the others do at their minimum.
    pub(crate) at_maximum: u32,
}

/// Cable as a straight line between its limits.
struct StraightBetween {
    from: Vec6,
    along: Vec6,
    curve: CurveBetween,
}

impl CentreSearch<'_, '_> {
    /// Proof that no tensions within the limits balance the load, the exit points held where they are; `None` if there
    /// is none, or none was found. Reserves no memory.
    pub(crate) fn missing(&self) -> Option<MissingInDirection> {
        let mut lines = ArrayVec::<StraightBetween, MAX_INLINE>::new();
        for cable in &*self.cables {
            let line = self.line(cable);
            lines.try_push(line).ok()?;
        }
        let fixed = lines.iter().fold(self.load.wrench, |sum, line| sum + line.from);

        let mut y = self.multipliers;
        for _ in 0..MAX_STEPS {
            // A direction that proves it for straight lines, and then for the curves.
            let reach: f64 = lines.iter().map(|line| y.dot(&line.along).max(0.0)).sum();
            if y.dot(&fixed) + reach < 0.0
                && let Some(missing) = self.confirmed(&lines, &y)
            {
                return Some(missing);
            }

            let (slope, matrix) = dual(&lines, &fixed, &y);
            let step = self.solved(&matrix, &-slope)?;
            let decrement = (-slope.dot(&step)).max(0.0).sqrt();
            if !decrement.is_finite() || decrement < f64::EPSILON {
                return None;
            }
            let mut part = if decrement > LONG { 1.0 / (1.0 + decrement) } else { 1.0 };
            for _ in 0..MAX_DOUBLINGS {
                let (ahead, _) = dual(&lines, &fixed, &(y + step * (2.0 * part)));
                if part >= 1.0 || ahead.dot(&step) > 0.0 {
                    break;
                }
                part *= 2.0;
            }
            y += step * part;
        }
        None
    }

    /// Missing wrench along a direction by upper bounds of the true curves; `None` if they do not prove it.
    fn confirmed(&self, lines: &[StraightBetween], y: &Vec6) -> Option<MissingInDirection> {
        let direction = y.try_normalize(0.0)?;
        let own = direction.dot(&self.load.wrench);
        let (mut sum, mut size, mut at_maximum) = (own, own.abs(), 0_u32);
        for (i, line) in lines.iter().enumerate() {
            let bound = line.curve.bound(&direction);
            sum += bound;
            size += bound.abs();
            if direction.dot(&line.along) > 0.0 {
                at_maximum |= 1 << i;
            }
        }
        (sum < -ROUNDING * size).then_some(MissingInDirection { direction, size: -sum, at_maximum })
    }

    fn line(&self, cable: &CentreCable<'_>) -> StraightBetween {
        let point = |tau: f64| {
            let span = cable.curve.span.at_parallel_tension(tau);
            let by_tau = span.catenary.by_parallel_tension();
            let ([cos, _], (along_w, up_w)) = (span.catenary.chord_direction(), span.axes_w());
            let column = along_w * cos + up_w * by_tau.vertical_at_start[0];
            CurvePoint {
                tau,
                wrench: self.wrench(cable, &span.force_on_start_w()),
                by_tau: self.wrench(cable, &column),
                length: [span.catenary.rope().unstrained_length, by_tau.length[0]],
            }
        };
        let (span, ends) = (&cable.curve.span, [point(cable.lower), point(cable.upper)]);
        let curve = CurveBetween {
            chord: self.wrench(cable, &span.chord_w().normalize()),
            up: self.wrench(cable, &span.axes_w().1),
            weight_per_length: span.catenary.rope().weight_per_length,
            sin: span.catenary.chord_direction()[1],
            ends,
        };
        StraightBetween { from: ends[0].wrench, along: ends[1].wrench - ends[0].wrench, curve }
    }
}

/// Derivatives of the negative dual by the multipliers: the balance that is left, and its matrix.
fn dual(lines: &[StraightBetween], fixed: &Vec6, y: &Vec6) -> (Vec6, Mat6) {
    let (mut left, mut matrix) = (*fixed, Mat6::zeros());
    for line in lines {
        // Place between the limits, 0 to 1, at which the slope of both logarithms is that of the line.
        let slope = y.dot(&line.along);
        let place = 0.5 + 0.25 * slope / (1.0 + (1.0 + 0.25 * slope * slope).sqrt());
        let (below, above) = (place.max(f64::MIN_POSITIVE), (1.0 - place).max(f64::MIN_POSITIVE));
        let curvature = (below * below).recip() + (above * above).recip();
        left += line.along * place;
        matrix.ger(curvature.recip(), &line.along, &line.along, 1.0);
    }
    (left, matrix)
}
