//! Lowest and highest tension of a hanging span as smooth functions of its forces.
//!
//! The highest tension of a cable has a kink where the cable goes level, and the lowest one a jump of its curvature
//! where the lowest point reaches an end. Absolute value and maximum are rounded over a hundredth of the weight, so
//! that the limits of τ are smooth functions of pose and numbers (docs/theory.md, (40b2) and (40b3)).

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
        let Self { horizontal: h, weight, .. } = *self;
        let [size, by_vertical, size_by_weight] = self.rounded_vertical();
        let width = ROUNDED * weight;

        // Vertical force at the lower end where that is below the lowest point of the curve; zero beyond.
        let q = size - 0.5 * weight;
        let root = (q * q + width * width).sqrt();
        let low = if q > 0.0 { 0.5 * (q + root) } else { 0.5 * width * width / (root - q) };
        let (by_q, by_width) = (low / root, 0.5 * width / root);

        let value = h.hypot(low);
        self.with_drum(
            -1.0,
            RoundedTension {
                value,
                by_horizontal: h / value,
                by_vertical: low / value * by_q * by_vertical,
                by_weight: low / value * (by_q * (size_by_weight - 0.5) + by_width * ROUNDED),
                by_drum: 0.0,
            },
        )
    }

    /// Highest tension anywhere in the cable: at the upper end, or at the drum.
    pub(crate) fn highest(&self) -> RoundedTension {
        let [size, by_vertical, size_by_weight] = self.rounded_vertical();
        let high = size + 0.5 * self.weight;
        let value = self.horizontal.hypot(high);
        self.with_drum(
            1.0,
            RoundedTension {
                value,
                by_horizontal: self.horizontal / value,
                by_vertical: high / value * by_vertical,
                by_weight: high / value * (size_by_weight + 0.5),
                by_drum: 0.0,
            },
        )
    }

    /// Rounded size of the mean vertical force, and its derivatives by that force and by the weight.
    fn rounded_vertical(&self) -> [f64; 3] {
        let width = ROUNDED * self.weight;
        let size = self.vertical.hypot(width);
        [size, self.vertical / size, ROUNDED * width / size]
    }

    /// Rounded maximum (`side` 1) or minimum (−1) of a tension of the span and of that at the drum.
    fn with_drum(&self, side: f64, span: RoundedTension) -> RoundedTension {
        let Some(drum) = self.drum else { return span };
        let (width, apart) = (ROUNDED * self.weight, span.value - drum);
        let root = apart.hypot(width);
        let of_span = 0.5 * (1.0 + side * apart / root);
        RoundedTension {
            value: 0.5 * (span.value + drum + side * root),
            by_horizontal: of_span * span.by_horizontal,
            by_vertical: of_span * span.by_vertical,
            by_weight: of_span * span.by_weight + side * 0.5 * width / root * ROUNDED,
            by_drum: 1.0 - of_span,
        }
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
