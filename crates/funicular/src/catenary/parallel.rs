//! Catenary with a given tension parallel to its chord; its unstrained length follows.

use super::{Catenary, Hyperbolic, Rope, Slope};
use std::ops::{Add, Div, Mul, Sub};

/// Step over the length that is the last one of the search for it.
const LAST_STEP: f64 = 1e-8;

impl Catenary {
    /// Cable from the origin to `(span, rise)` [m], not both zero, whose [`parallel_tension`](Self::parallel_tension)
    /// is `tension` [N]. `rope` gives weight and stiffness; its length is the start of the search and does not change
    /// the result.
    ///
    /// The tension fixes v + k by (10a), so that (9) becomes an equation in the length alone, and a nearly linear one:
    /// one or two steps suffice from the length at another tension. Meant for tensions above a hundredth of the weight;
    /// a massless cable may have any tension that is not negative.
    pub(crate) fn with_parallel_tension(span: f64, rise: f64, rope: Rope, tension: f64) -> Self {
        let Rope { unstrained_length, weight_per_length: w, axial_stiffness: ea } = rope;
        let chord = super::hypot(span, rise);
        if w == 0.0 {
            return Self::straight_with(span, rise, chord, rope, tension);
        }

        // The range of lengths, and a start.
        let across = 0.5 * w * chord / tension;
        let k_by_length = 0.5 * w / ea;
        // Here v = 0: the rope is stretched so far that its weight does not count. The root is below, and so is the
        // start.
        let limit = across / k_by_length;
        let straight = chord / (1.0 + tension / ea);
        let mut length = if unstrained_length < limit { unstrained_length.max(straight) } else { straight };

        // Nearly linear: 1 or 2 passes from a neighbouring tension, 4 from far away. The limit is a guard.
        let mut near: Option<Hyperbolic> = None;
        for _ in 0..50 {
            let at = LengthOf::of(span, rise, across, k_by_length * length);
            let step = (at.length - length) / (1.0 - k_by_length * at.by_k);
            let (before, next) = (length, length + step);
            length = if next < limit { next.max(0.5 * length) } else { 0.5 * (length + limit) };
            // Newton's method squares the error: after a step below 1e-8 no further step counts.
            if step.abs() <= LAST_STEP * length {
                let change = k_by_length * (before - length);
                near = Some(at.hyperbolic.moved(across - k_by_length * before, change));
                break;
            }
        }

        let k = k_by_length * length;
        let v = (across - k).max(f64::MIN_POSITIVE);
        let Hyperbolic { sinh, cosh, v_cosh_minus_sinh, .. } = near.unwrap_or_else(|| Hyperbolic::of(v));
        let tanh_v = sinh / cosh;
        Self {
            rope: Rope { unstrained_length: length, ..rope },
            span,
            rise,
            horizontal: tension * span / chord,
            vertical_mean: w * rise / (2.0 * (tanh_v + k)),
            slope: Slope::Curved { v, tanh_v, sech2_v: 1.0 / (cosh * cosh), sinh_v: sinh, v_cosh_minus_sinh },
        }
    }

    fn straight_with(span: f64, rise: f64, chord: f64, rope: Rope, tension: f64) -> Self {
        let rope = Rope { unstrained_length: chord / (1.0 + tension / rope.axial_stiffness), ..rope };
        let (horizontal, vertical_mean) = (tension * span / chord, tension * rise / chord);
        Self { rope, span, rise, horizontal, vertical_mean, slope: Slope::Straight }
    }
}

/// First and second derivatives of a cable between fixed ends by its parallel tension τ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByParallelTension {
    /// Unstrained length [m/N, m/N²].
    pub(crate) length: [f64; 2],
    /// Vertical force V_A at the start [-, 1/N].
    pub(crate) vertical_at_start: [f64; 2],
}

impl Catenary {
    /// Derivatives by the parallel tension with both ends held: (9) differentiated twice, for v + k = w c/2τ.
    ///
    /// The horizontal force is τ cos α and has none but cos α. Meant for tensions above a hundredth of the weight.
    pub(crate) fn by_parallel_tension(&self) -> ByParallelTension {
        let Rope { unstrained_length: l, weight_per_length: w, axial_stiffness: ea } = self.rope;
        let (x, z) = (self.span, self.rise);
        let chord = super::hypot(x, z);
        let Slope::Curved { v, tanh_v, sech2_v, sinh_v, .. } = self.slope else {
            let tension = super::hypot(self.horizontal, self.vertical_mean);
            let first = -l / (ea + tension);
            return ByParallelTension {
                length: [first, -2.0 * first / (ea + tension)],
                vertical_at_start: [z / chord, 0.0],
            };
        };

        // Everything as a function of τ, the length at first held.
        let k_by_length = 0.5 * w / ea;
        let k = k_by_length * l;
        let across = v + k;
        let tau = 0.5 * w * chord / across;
        let u = Taylor { value: across, first: -across / tau, second: 2.0 * across / (tau * tau) };
        let cosh_v = (1.0 + sinh_v * sinh_v).sqrt();
        let parts = |length: Taylor| {
            let k = length * k_by_length;
            let v_of = u - k;
            let sinh = v_of.function(sinh_v, cosh_v, sinh_v);
            let tanh = v_of.function(tanh_v, sech2_v, -2.0 * tanh_v * sech2_v);
            let along = tanh + k;
            let (p, q) = (sinh / u * x, tanh / along * z);
            (p * p + q * q - length * length, along)
        };

        // The condition is zero for every τ: the derivatives of the length, one after the other.
        let along = tanh_v + k;
        let (p, q) = (x * sinh_v / across, z * tanh_v / along);
        let p_by_k = -x * cosh_v / across;
        let q_by_k = -z * (sech2_v * k + tanh_v) / (along * along);
        let by_length = 2.0 * ((p * p_by_k + q * q_by_k) * k_by_length - l);
        let first = -parts(Taylor { value: l, first: 0.0, second: 0.0 }).0.first / by_length;
        let second = -parts(Taylor { value: l, first, second: 0.0 }).0.second / by_length;

        let (_, along) = parts(Taylor { value: l, first, second });
        let vertical = Taylor { value: 0.5 * w * z, first: 0.0, second: 0.0 } / along;
        ByParallelTension {
            length: [first, second],
            vertical_at_start: [vertical.first - 0.5 * w * first, vertical.second - 0.5 * w * second],
        }
    }
}

/// Number with its first and second derivative by one variable.
#[derive(Debug, Clone, Copy)]
struct Taylor {
    value: f64,
    first: f64,
    second: f64,
}

impl Taylor {
    /// Function of this number with its value and its first two derivatives.
    fn function(self, value: f64, slope: f64, curvature: f64) -> Self {
        Self { value, first: slope * self.first, second: curvature * self.first * self.first + slope * self.second }
    }
}

impl Add for Taylor {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, first: self.first + other.first, second: self.second + other.second }
    }
}

impl Sub for Taylor {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Taylor {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            first: self.first * other.value + self.value * other.first,
            second: self.second * other.value + 2.0 * self.first * other.first + self.value * other.second,
        }
    }
}

impl Mul<f64> for Taylor {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { value: self.value * factor, first: self.first * factor, second: self.second * factor }
    }
}

impl Div for Taylor {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self * other.function(inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse)
    }
}

/// Length by (9) for `across = v + k`, and its derivative with respect to k.
struct LengthOf {
    length: f64,
    by_k: f64,
    hyperbolic: Hyperbolic,
}

impl LengthOf {
    #[inline]
    fn of(x: f64, z: f64, across: f64, k: f64) -> Self {
        let h = Hyperbolic::of(across - k);
        let (tanh, sech2) = (h.sinh / h.cosh, 1.0 / (h.cosh * h.cosh));
        let along = tanh + k;
        let (xa, zb) = (x * h.sinh / across, z * tanh / along);
        let length = super::hypot(xa, zb);
        let xa_by_k = -x * h.cosh / across;
        let zb_by_k = -z * (sech2 * k + tanh) / (along * along);
        Self { length, by_k: (xa * xa_by_k + zb * zb_by_k) / length, hyperbolic: h }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..Default::default() })]

        /// Tensions from a quarter of the weight up to a strain of one half, all slopes, ropes from rubber to steel.
        #[test]
        fn the_length_found_has_the_requested_tension(
            slope in -1.0f64..=1.0, size in -1.0f64..3.0, weight in -4.0f64..2.0, stiffness in 2.0f64..7.0,
            part in 0.0f64..=1.0,
        ) {
            let chord = 10f64.powf(size);
            let (span, rise) = (chord * (1.0 - slope * slope).sqrt(), chord * slope);
            let weight_per_length = 10f64.powf(weight);
            let axial_stiffness = 10f64.powf(stiffness) + 10.0 * weight_per_length * chord;
            let rope = Rope { unstrained_length: chord, weight_per_length, axial_stiffness };
            let (low, high) = (0.25 * weight_per_length * chord, 0.5 * axial_stiffness);
            let tension = low * (high / low).powf(part);
            let cable = Catenary::with_parallel_tension(span, rise, rope, tension);
            prop_assert!((cable.parallel_tension() / tension - 1.0).abs() < 1e-12);
            let again = Catenary::solve(span, rise, cable.rope());

            // Rounding of the length in a rope that hardly stretches; it grows with the length of a slack cable.
            let tolerance = 1e-14 * (axial_stiffness / tension).max(100.0);
            let gap = (again.parallel_tension() / tension - 1.0).abs();
            prop_assert!(gap < tolerance, "τ {tension} N: {gap:e}, tolerance {tolerance:e}");
            for (ours, theirs) in [
                (cable.vertical_force_at_end(), again.vertical_force_at_end()),
                (cable.tension_at_start(), again.tension_at_start()),
            ] {
                let scale = again.tension_at_start().max(again.tension_at_end());
                prop_assert!((ours - theirs).abs() < tolerance * scale, "{ours} {theirs}");
            }
        }

        /// Basis of the tension limits: above the tension of (37) both end tensions grow with the parallel tension.
        #[test]
        fn end_tensions_grow_with_the_parallel_tension(
            slope in -1.0f64..=1.0, stiffness in 1.0f64..6.0, part in 0.0f64..=1.0,
        ) {
            let (span, rise) = ((1.0 - slope * slope).sqrt(), slope);
            let rope = Rope { unstrained_length: 1.0, weight_per_length: 1.0, axial_stiffness: 10f64.powf(stiffness) };
            let tension = Catenary::MIN_TENSION_TO_WEIGHT * (100.0 / Catenary::MIN_TENSION_TO_WEIGHT).powf(part);
            let [less, more] = [tension, 1.001 * tension].map(|t| Catenary::with_parallel_tension(span, rise, rope, t));
            prop_assert!(more.max_tension() > less.max_tension());
            prop_assert!(more.min_tension() > less.min_tension());
        }

        /// Derivatives by differences of the curve itself; the first ones also by the derivatives by the length.
        #[test]
        fn derivatives_by_the_parallel_tension_are_those_of_the_curve(
            slope in -1.0f64..=1.0, stiffness in 1.0f64..6.0, part in 0.0f64..=1.0,
        ) {
            let (span, rise) = ((1.0 - slope * slope).sqrt(), slope);
            let rope = Rope { unstrained_length: 1.0, weight_per_length: 1.0, axial_stiffness: 10f64.powf(stiffness) };
            let tension = Catenary::MIN_TENSION_TO_WEIGHT * (50.0 / Catenary::MIN_TENSION_TO_WEIGHT).powf(part);
            let at = |tau: f64| Catenary::with_parallel_tension(span, rise, rope, tau);
            let found = at(tension).by_parallel_tension();
            let by_length = 1.0 / at(tension).parallel_tension_by_length();
            let vertical = at(tension).start_force_by_length()[1] * by_length;
            prop_assert!((found.length[0] / by_length - 1.0).abs() < 1e-8);
            prop_assert!((found.vertical_at_start[0] - vertical).abs() < 1e-9 * (1.0 + vertical.abs()));

            // Central differences of the first derivatives; the error falls with the square of the step.
            let step = 1e-4 * tension;
            let [less, more] = [-step, step].map(|step| at(tension + step).by_parallel_tension());
            let length = (more.length[0] - less.length[0]) / (2.0 * step);
            let vertical = (more.vertical_at_start[0] - less.vertical_at_start[0]) / (2.0 * step);
            let size = 1e-6 / (tension * tension);
            prop_assert!((found.length[1] - length).abs() < 1e-6 * length.abs() + size, "{:?} {length}", found.length);
            prop_assert!((found.vertical_at_start[1] - vertical).abs() < 1e-6 * vertical.abs() + size,
                "{:?} {vertical}", found.vertical_at_start);
        }

        /// Basis of the infeasibility proofs, (39b): the contribution of sag to the mean vertical force falls with the
        /// parallel tension, ever more slowly, and so does the length unless the cable is steep.
        #[test]
        fn bend_and_length_are_convex_functions_of_the_parallel_tension(
            slope in -1.0f64..=1.0, stiffness in 0.0f64..6.0,
        ) {
            const STEPS: u32 = 300;
            const ROUNDING: f64 = 1e-11;
            let (span, rise) = ((1.0 - slope * slope).sqrt(), slope);
            let axial_stiffness = 10f64.powf(stiffness);
            let rope = Rope { unstrained_length: 1.0, weight_per_length: 1.0, axial_stiffness };
            let high = axial_stiffness.min(1000.0);
            let mut last: Option<[f64; 2]> = None;

            for k in 0..=STEPS {
                let part = f64::from(k) / f64::from(STEPS);
                let tension = Catenary::MIN_TENSION_TO_WEIGHT * (high / Catenary::MIN_TENSION_TO_WEIGHT).powf(part);
                let cable = Catenary::with_parallel_tension(span, rise, rope, tension);
                let by_tension = 1.0 / cable.parallel_tension_by_length();
                let bend = (cable.vertical_mean - tension * slope) * slope.signum();
                let by_length = cable.start_force_by_length()[1];
                let bend_rate = (by_length * by_tension - slope + 0.5 * by_tension) * slope.signum();
                prop_assert!(bend >= -ROUNDING * (1.0 + tension) && bend_rate <= ROUNDING && by_tension < 0.0);
                if let Some([bend_before, length_before]) = last {
                    prop_assert!(bend_rate >= bend_before - ROUNDING, "{bend_before} {bend_rate} at {tension}");
                    let steep = slope.abs() > 0.95;
                    prop_assert!(steep || by_tension >= length_before - ROUNDING, "{length_before} {by_tension} at \
                        {tension}");
                }
                last = Some([bend_rate, by_tension]);
            }
        }
    }

    /// Checks (36a) by orders: the vertical force minus the terms of (36a) falls with the order of the first omitted
    /// term when the tension doubles, and the vertical force minus the straight line falls with the order of (36a)'s
    /// own term.
    #[test]
    fn the_vertical_force_bends_with_the_first_power_of_weight_over_tension_in_inclined_cables() {
        // So stiff that the strain, at most 3e-12, is far below the last term considered, 2e-8.
        let rope = Rope { unstrained_length: 1.0, weight_per_length: 1.0, axial_stiffness: 1e13 };
        for (sin, line_order, remainder_order) in [(0.6, 1, 3), (-0.8, 1, 3), (0.0, 2, 4)] {
            let cos2: f64 = 1.0 - sin * sin;
            let left = |tau: f64| {
                let cable = Catenary::with_parallel_tension(cos2.sqrt(), sin, rope, tau);
                let beside_line = cable.vertical_force_at_start() - (tau * sin - 0.5);
                (beside_line, beside_line - (sin / (12.0 * tau) - cos2 / (48.0 * tau * tau)))
            };
            for tau in [6.0, 12.0] {
                let ((line, rest), (line_2, rest_2)) = (left(tau), left(2.0 * tau));
                // The next order adds a few per cent to each at these tensions.
                let order = |one: f64, two: f64| (one / two).log2();
                assert!((order(line, line_2) - f64::from(line_order)).abs() < 0.1, "{sin} {tau}: {line} {line_2}");
                let found = order(rest, rest_2);
                assert!((found - f64::from(remainder_order)).abs() < 0.1, "{sin} {tau}: {rest:e} {rest_2:e} {found}");
            }
        }
    }

    #[test]
    fn a_massless_cable_is_a_spring() {
        let rope = Rope { unstrained_length: 1.0, weight_per_length: 0.0, axial_stiffness: 1000.0 };
        let cable = Catenary::with_parallel_tension(3.0, 4.0, rope, 100.0);
        assert!((cable.rope().unstrained_length - 5.0 / 1.1).abs() < 1e-15);
        assert!((cable.tension_at_start() - 100.0).abs() < 1e-12);
        let slack = Catenary::with_parallel_tension(3.0, 4.0, rope, 0.0);
        assert!((slack.rope().unstrained_length - 5.0).abs() < 1e-15);
    }
}
