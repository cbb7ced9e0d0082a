//! Lowest and highest tension of a hanging span as smooth functions of its forces.
//!
//! The highest tension of a cable has a kink where the cable goes level, and the lowest one a jump of its curvature
//! where the lowest point reaches an end. Absolute value and maximum are rounded over a hundredth of the weight, so
//! that the limits of τ are smooth functions of pose and numbers (docs/theory.md, (40b2) and (40b3)).

use crate::math::dual::{Dual, Real};

/// Width over which corners are rounded, as a part of the weight of the span.
const ROUNDED: f64 = 0.01;

/// Tension and its derivatives by the forces of a span.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoundedTension {
    /// Value [N].
    pub(crate) value: f64,
    /// Derivative by the horizontal force.
    pub(crate) by_horizontal: f64,
    /// Derivative by the mean of the two vertical end forces.
    pub(crate) by_vertical: f64,
    /// Derivative by the weight.
    pub(crate) by_weight: f64,
    /// Derivative by the tension at the drum.
    pub(crate) by_drum: f64,
}

/// Forces of a span with weight [N].
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpanForces {
    /// Horizontal force.
    pub(crate) horizontal: f64,
    /// Mean of the vertical end forces.
    pub(crate) vertical: f64,
    /// Weight of the free span, positive.
    pub(crate) weight: f64,
    /// Tension at the drum of a cable over a pulley; `None` without one.
    pub(crate) drum: Option<f64>,
}

impl SpanForces {
    /// Lowest tension anywhere in the cable: at the lower end, or at the lowest point, or at the drum.
    pub(crate) fn lowest(&self) -> RoundedTension {
        self.with_derivatives(RoundedForces::lowest)
    }

    /// Highest tension anywhere in the cable: at the upper end, or at the drum.
    pub(crate) fn highest(&self) -> RoundedTension {
        self.with_derivatives(RoundedForces::highest)
    }

    fn with_derivatives(&self, of: impl Fn(&RoundedForces<Dual<4>>) -> Dual<4>) -> RoundedTension {
        let horizontal = Dual::variable(self.horizontal, 0);
        let found = of(&RoundedForces {
            horizontal_squared: horizontal * horizontal,
            vertical: Dual::variable(self.vertical, 1),
            weight: Dual::variable(self.weight, 2),
            drum: self.drum.map(|drum| Dual::variable(drum, 3)),
        });
        let [by_horizontal, by_vertical, by_weight, by_drum] = found.by;
        RoundedTension { value: found.value, by_horizontal, by_vertical, by_weight, by_drum }
    }
}

/// Forces of a span with weight, as [`SpanForces`], in numbers with derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoundedForces<T> {
    /// Square of the horizontal force [N²].
    pub(crate) horizontal_squared: T,
    /// Mean of the vertical end forces.
    pub(crate) vertical: T,
    /// Weight of the free span, positive.
    pub(crate) weight: T,
    /// Tension at the drum of a cable over a pulley; `None` without one.
    pub(crate) drum: Option<T>,
}

impl<T: Real> RoundedForces<T> {
    /// Lowest tension, as [`SpanForces::lowest`].
    pub(crate) fn lowest(&self) -> T {
        let width = self.weight * ROUNDED;
        let squared = width * width;

        // Vertical force at the lower end where that is below the lowest point of the curve; zero beyond.
        let q = self.rounded_vertical() - self.weight * 0.5;
        let root = (q * q + squared).sqrt();
        let low = if q.value() > 0.0 { (q + root) * 0.5 } else { squared * 0.5 / (root - q) };
        self.with_drum(-1.0, (self.horizontal_squared + low * low).sqrt())
    }

    /// Highest tension, as [`SpanForces::highest`].
    pub(crate) fn highest(&self) -> T {
        let high = self.rounded_vertical() + self.weight * 0.5;
        self.with_drum(1.0, (self.horizontal_squared + high * high).sqrt())
    }

    /// Rounded size of the mean vertical force.
    fn rounded_vertical(&self) -> T {
        let width = self.weight * ROUNDED;
        (self.vertical * self.vertical + width * width).sqrt()
    }

    /// Rounded maximum (`side` 1) or minimum (−1) of a tension of the span and of that at the drum.
    fn with_drum(&self, side: f64, span: T) -> T {
        let Some(drum) = self.drum else { return span };
        let (width, apart) = (self.weight * ROUNDED, span - drum);
        let root = (apart * apart + width * width).sqrt();
        (span + drum + root * side) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives by central differences, on both sides of every corner; and the distance from the true tensions,
    /// which (40b2) bounds.
    #[test]
    fn rounded_tensions_are_near_the_true_ones_and_have_their_derivatives() {
        let (h, weight) = (40.0, 6.0_f64);
        for vertical in [-30.0, -3.0, -0.01, 0.0, 0.02, 2.99, 3.0, 3.02, 25.0] {
            let plain = SpanForces { horizontal: h, vertical, weight, drum: None };
            let [start, end] = [vertical - 0.5 * weight, vertical + 0.5 * weight];
            let (low, high) = if start < 0.0 && end > 0.0 {
                (h, h.hypot(start).max(h.hypot(end)))
            } else {
                (h.hypot(start).min(h.hypot(end)), h.hypot(start).max(h.hypot(end)))
            };
            let width = ROUNDED * weight;
            let gap = plain.lowest().value - low;
            assert!((0.0..width * width / h).contains(&gap), "{vertical}: {gap:e}");
            let gap = plain.highest().value - high;
            assert!((0.0..width * weight / h).contains(&gap), "{vertical}: {gap:e}");

            for drum in [None, Some(high - 0.05), Some(high + 0.03), Some(low - 0.01), Some(low + 2.0)] {
                let forces = SpanForces { drum, ..plain };
                for of in [SpanForces::lowest, SpanForces::highest] {
                    let found = of(&forces);
                    let step = 1e-5;
                    let slope = |moved: &dyn Fn(f64) -> SpanForces| {
                        (of(&moved(step)).value - of(&moved(-step)).value) / (2.0 * step)
                    };
                    let by_horizontal = slope(&|s| SpanForces { horizontal: h + s, ..forces });
                    let by_vertical = slope(&|s| SpanForces { vertical: vertical + s, ..forces });
                    let by_weight = slope(&|s| SpanForces { weight: weight + s, ..forces });
                    let by_drum = slope(&|s| SpanForces { drum: drum.map(|drum| drum + s), ..forces });
                    for (found, slope) in [
                        (found.by_horizontal, by_horizontal),
                        (found.by_vertical, by_vertical),
                        (found.by_weight, by_weight),
                        (found.by_drum, by_drum),
                    ] {
                        assert!((found - slope).abs() < 1e-7, "{forces:?}: {found} {slope}");
                    }
                }
            }
        }
    }
}
