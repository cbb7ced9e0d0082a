//! Quantiles of Student's t and of χ².

use crate::normal::normal_quantile;
use std::f64::consts::FRAC_2_PI;

/// Number of halvings of an interval of t, which gives all digits.
const HALVINGS: usize = 200;

/// Degrees of freedom from which on the normal distribution stands for Student's t: 1.96 is then 1.9602.
const MANY: usize = 10_000;

/// Factor of a deviation whose interval holds 95 %: Student's t for `degrees` of freedom. `None` without degrees.
///
/// # References
/// M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4.
pub(crate) fn student_95(degrees: usize) -> Option<f64> {
    match degrees {
        0 => None,
        degrees if degrees >= MANY => Some(normal_quantile(0.975)),
        degrees => {
            let (mut low, mut high) = (0.0, 100.0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if within(middle, degrees) < 0.95 { low = middle } else { high = middle }
            }
            Some(0.5 * (low + high))
        }
    }
}

/// Probability of an absolute value of Student's t up to `t`.
fn within(t: f64, degrees: usize) -> f64 {
    let angle = (t / (degrees as f64).sqrt()).atan();
    let (sine, cosine) = angle.sin_cos();
    let is_odd = degrees % 2 == 1;
    let (mut term, mut sum) = if is_odd { (cosine, 0.0) } else { (1.0, 0.0) };
    let mut k = usize::from(is_odd);
    while k + 2 <= degrees {
        sum += term;
        k += 2;
        term *= cosine * cosine * (k - 1) as f64 / k as f64;
    }
    if is_odd { FRAC_2_PI * (angle + sine * sum) } else { sine * sum }
}

/// Value that χ² with `degrees` of freedom exceeds with the small probability `p`; within 1 % of the tables.
///
/// # References
/// E. B. Wilson, M. M. Hilferty, The distribution of chi-square, PNAS 17 (1931) 684.
pub(crate) fn chi2_above(p: f64, degrees: usize) -> f64 {
    match degrees {
        1 => normal_quantile(0.5 * p).powi(2),
        2 => -2.0 * p.ln(),
        degrees => {
            let variance = 2.0 / (9.0 * degrees as f64);
            degrees as f64 * (1.0 - variance - normal_quantile(p) * variance.sqrt()).powi(3)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (degrees, expected) in [(1, 12.706), (2, 4.303), (3, 3.182), (7, 2.365), (30, 2.042), (20_000, 1.960)] {
            // Printed digits.
            assert!((student_95(degrees).unwrap() - expected).abs() < 5e-4, "{degrees}");
        }
        for (p, degrees, expected) in [(0.05, 1, 3.841), (0.05, 2, 5.991), (0.01, 5, 15.086), (0.001, 10, 29.588)] {
            assert!((chi2_above(p, degrees) / expected - 1.0).abs() < 0.01, "{degrees}");
        }
    }
}
