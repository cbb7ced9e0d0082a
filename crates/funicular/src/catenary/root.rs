//! Root of the one equation F(v) = 0 of the elastic catenary (docs/theory.md, equations (6) to (10)).

use super::hypot;

/// Values of sinh, cosh and their differences without cancellation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hyperbolic {
    pub(super) sinh: f64,
    pub(super) cosh: f64,
    /// sinh v − v.
    sinh_minus_v: f64,
    /// v cosh v − sinh v.
    pub(super) v_cosh_minus_sinh: f64,
}

impl Hyperbolic {
    #[inline]
    pub(super) fn of(v: f64) -> Self {
        if v < 1.0 {
            // Taylor series of sinh v − v; at v = 1 the first omitted term, v¹⁹/19!, is 8e-18.
            const C: [f64; 8] = [
                1.0 / 6.0,
                1.0 / 120.0,
                1.0 / 5_040.0,
                1.0 / 362_880.0,
                1.0 / 39_916_800.0,
                1.0 / 6_227_020_800.0,
                1.0 / 1_307_674_368_000.0,
                1.0 / 355_687_428_096_000.0,
            ];
            let v2 = v * v;
            let v4 = v2 * v2;
            // Two short chains instead of one long one.
            let even = ((C[6] * v4 + C[4]) * v4 + C[2]) * v4 + C[0];
            let odd = ((C[7] * v4 + C[5]) * v4 + C[3]) * v4 + C[1];
            let sinh_minus_v = v * v2 * (even + odd * v2);
            let sinh = v + sinh_minus_v;
            let cosh = (1.0 + sinh * sinh).sqrt();
            let cosh_minus_1 = sinh * sinh / (1.0 + cosh);
            Self { sinh, cosh, sinh_minus_v, v_cosh_minus_sinh: v * cosh_minus_1 - sinh_minus_v }
        } else {
            let e = v.exp();
            let (sinh, cosh) = (0.5 * (e - 1.0 / e), 0.5 * (e + 1.0 / e));
            Self { sinh, cosh, sinh_minus_v: sinh - v, v_cosh_minus_sinh: v * cosh - sinh }
        }
    }
}

impl Hyperbolic {
    /// Values after a change of v so small that its square is rounding.
    #[inline]
    pub(super) fn moved(&self, v: f64, change: f64) -> Self {
        Self {
            sinh: self.sinh + change * self.cosh,
            cosh: self.cosh + change * self.sinh,
            sinh_minus_v: self.sinh_minus_v + change * (self.sinh * self.sinh / (1.0 + self.cosh)),
            v_cosh_minus_sinh: self.v_cosh_minus_sinh + change * v * self.sinh,
        }
    }
}

/// Solution of F(v) = 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Root {
    pub(super) v: f64,
    pub(super) hyperbolic: Hyperbolic,
}

/// Root of F for `x = span/L0`, `z = rise/L0` and k, by Newton's method inside a bracket.
#[inline]
pub(super) fn root(x: f64, z: f64, k: f64) -> Root {
    let chord = hypot(x, z);
    let stretch = chord - 1.0;
    let equation = Equation { x, x2: x * x, z2: z * z, k, chord2_minus_1: stretch * (chord + 1.0) };

    let mut v = start(x, z, k, chord, stretch);
    let (mut low, mut high) = (0.0, f64::INFINITY);

    // Robots take 2 or 3 passes. Of a million cables over eight decades of sag, slope and strain, 99.5 % took at most 4
    // and the worst 14. The limit is a guard.
    for _ in 0..80 {
        let here = equation.at(v);
        if here.value > 0.0 {
            high = v;
        } else {
            low = v;
        }

        // Newton's method squares the error: after a step below 1e-8 no further step counts.
        let step = here.step(v);
        if step.abs() <= 1e-8 * v {
            v -= step;
            break;
        }
        v = inside_bracket(v - step, low, high);
    }

    Root { v, hyperbolic: Hyperbolic::of(v) }
}

/// Equation F(v) = 0 of one cable, all lengths over L0.
struct Equation {
    x: f64,
    x2: f64,
    z2: f64,
    k: f64,
    /// x² + z² − 1.
    chord2_minus_1: f64,
}

/// F at a value of v, over L0².
struct EquationValue {
    value: f64,
    /// Derivative of F by v.
    slope: f64,
    /// Part of F by the rise, (z b)².
    vertical: f64,
    /// Derivative of that part by v.
    vertical_slope: f64,
}

impl Equation {
    /// F and its derivatives at v.
    #[inline]
    fn at(&self, v: f64) -> EquationValue {
        let Self { x, x2, z2, k, chord2_minus_1 } = *self;
        let h = Hyperbolic::of(v);
        let across = v + k;
        let (a, inverse_cosh) = (h.sinh / across, 1.0 / h.cosh);
        let tanh = h.sinh * inverse_cosh;
        let along = tanh + k;
        let b = tanh / along;

        // F = (xa)² + (zb)² − 1, written as differences from 1 so that a taut cable keeps its digits.
        let vertical = z2 * b * b;
        let value = if a < 2.0 {
            let one_minus_a = (k - h.sinh_minus_v) / across;
            let one_minus_b = k / along;
            chord2_minus_1 - x2 * one_minus_a * (1.0 + a) - z2 * one_minus_b * (1.0 + b)
        } else {
            (x * a).powi(2) + vertical - 1.0
        };

        let a_by_v = (k * h.cosh + h.v_cosh_minus_sinh) / (across * across);
        let b_by_v = k * inverse_cosh * inverse_cosh / (along * along);
        let vertical_slope = 2.0 * z2 * b * b_by_v;
        let slope = 2.0 * (x * a) * (x * a_by_v) + vertical_slope;
        EquationValue { value, slope, vertical, vertical_slope }
    }
}

impl EquationValue {
    /// Newton's step to the left from v, of F or, for deep sag, of its logarithm: there F grows like e^{2v}, and the
    /// logarithm is nearly straight.
    #[inline]
    fn step(&self, v: f64) -> f64 {
        let Self { value, slope, vertical, vertical_slope } = *self;
        let rest = 1.0 - vertical;
        if v > 1.0 && rest > 0.0 && value.abs() > 0.01 * rest && value > -rest {
            let ratio = value / rest;
            ratio.ln_1p() * (rest + value) / (slope + vertical_slope * ratio)
        } else {
            value / slope
        }
    }
}

/// Next value of v if it is inside the bracket, otherwise a value that is.
#[inline]
fn inside_bracket(next: f64, low: f64, high: f64) -> f64 {
    if next > low && next < high {
        next
    } else if high.is_infinite() {
        2.0 * low + 1.0
    } else if low > 0.0 {
        (low * high).sqrt()
    } else {
        0.1 * high
    }
}

/// Start value for [`root`]: the cubic of the flat cable for small sag, the logarithm for deep sag.
#[inline]
fn start(x: f64, z: f64, k: f64, chord: f64, stretch: f64) -> f64 {
    // Flat: (x/c)² v³/6 + (c − 1) v − k = 0, which is exact for a taut massless cable of any strain.
    let scale = 6.0 * chord * chord / (x * x);
    let (p, q) = (scale * stretch, scale * k);
    let v = if x == 0.0 || !q.is_finite() || !p.is_finite() {
        // Vertical: tanh v = k/(c − 1).
        let tanh = k / stretch;
        return if tanh < 1.0 { tanh.atanh() } else { 1.0 };
    } else if p >= 0.0 {
        let cube_root = q.cbrt();
        if p * cube_root > q { q / p } else { cube_root }
    } else {
        let inextensible = (-p).sqrt();
        let elastic = q / (-2.0 * p);
        let cube_root = if elastic > inextensible { q.cbrt() } else { elastic };
        inextensible + if elastic < cube_root { elastic } else { cube_root }
    };

    if v < 1.5 {
        // The cubic is convex for v > 0 and the start is not left of its root: two steps leave about one per cent.
        let mut v = v;
        for _ in 0..2 {
            let v2 = v * v;
            v = (2.0 * v * v2 + q) / (3.0 * v2 + p);
        }
        v
    } else {
        let b = 1.0 / (1.0 + k);
        let ratio = (1.0 - z * z * b * b).max(1e-300).sqrt() / x;
        let first = (2.0 * ratio).ln().max(0.5);
        let second = (2.0 * ratio * (first + k)).ln().max(0.5);
        (2.0 * ratio * (second + k)).ln().max(0.5)
    }
}
