//! Zeros of functions of one variable inside a bracket.

/// Root of `f` in `[low, high]` whose end values have opposite signs (Brent 1973, chapter 4): bisection, secant and
/// inverse quadratic interpolation, whichever is safe. Stops at four units in the last place of the root.
///
/// If an end value is zero, that end is the root. Infinite values count by their sign only. Takes at most 200
/// evaluations.
///
/// # References
/// R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall 1973.
pub(crate) fn brent(low: f64, f_low: f64, high: f64, f_high: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (low, f_low, high, f_high);
    let (mut c, mut fc) = (a, fa);
    let (mut step, mut before) = (b - a, b - a);

    for _ in 0..200 {
        // The root lies between b, the best, and c.
        if fb * fc.signum() > 0.0 {
            (c, fc) = (a, fa);
            step = b - a;
            before = step;
        }
        if fc.abs() < fb.abs() {
            (a, fa) = (b, fb);
            (b, fb) = (c, fc);
            (c, fc) = (a, fa);
        }

        // The end.
        let tolerance = 2.0 * f64::EPSILON * b.abs();
        let half = 0.5 * (c - b);
        if half.abs() <= tolerance || fb == 0.0 {
            return b;
        }

        // A secant or a parabola through the last points, or the midpoint.
        if before.abs() >= tolerance && fa.abs() > fb.abs() && fa.is_finite() {
            let s = fb / fa;
            let secant_only = (a - c).abs() <= 0.0;
            let (mut p, mut q) = if secant_only {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
            };
            if p > 0.0 {
                q = -q;
            }
            p = p.abs();
            if 2.0 * p < (3.0 * half * q - (tolerance * q).abs()).min((before * q).abs()) {
                before = step;
                step = p / q;
            } else {
                step = half;
                before = half;
            }
        } else {
            step = half;
            before = half;
        }
        (a, fa) = (b, fb);
        b += if step.abs() > tolerance { step } else { tolerance.copysign(half) };
        fb = f(b);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_steep_flat_and_jumping_functions_give_their_root() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 5] = [
            (|x| x * x - 2.0, 0.0, 2.0, std::f64::consts::SQRT_2),
            (|x| (x - 1.0).powi(9), 0.0, 3.0, 1.0),
            (|x| x.exp() - 1e300, 0.0, 709.0, 300.0 * std::f64::consts::LN_10),
            (|x| if x < 0.3 { -1e-30 } else { 1e30 }, 0.0, 1.0, 0.3),
            (|x| 1e-12 - 1.0 / (x - 5.0), 5.0 + 1e-9, 1e15, 1e12 + 5.0),
        ];
        for (i, (f, low, high, root)) in cases.into_iter().enumerate() {
            let found = brent(low, f(low), high, f(high), f);
            // (x − 1)⁹ is flat to rounding within 1e-2 of its root; the others are simple.
            let tolerance = if i == 1 { 2e-2 } else { 1e-14 * root };
            assert!((found - root).abs() <= tolerance, "case {i}: {found} for {root}");
        }
    }

    #[test]
    fn an_end_of_zero_is_the_root() {
        assert_eq!(brent(0.0, 0.0, 1.0, 1.0, |x| x).to_bits(), 0.0_f64.to_bits());
        assert_eq!(brent(-1.0, -1.0, 0.0, 0.0, |x| x).to_bits(), 0.0_f64.to_bits());
    }
}
