//! Degrees of freedom of a fit, and the χ² that noise alone gives.

use super::model::IdentifiedModel;
use crate::normal::NOISE_DEVIATIONS;
use funicular::math::least_squares::Minimum;

/// Number of residuals less the number of unknowns. Values that are left out do not count.
pub(super) fn degrees_of_freedom(model: &IdentifiedModel<'_>, found: &Minimum) -> usize {
    // A value of a response has two residuals: real and imaginary part.
    let left_out = 2 * model.left_out.iter().filter(|left_out| **left_out).count();
    found.residuals.len().saturating_sub(left_out + model.unknowns.len())
}

/// Minimum and maximum of χ² per degree of freedom that noise alone gives, three standard deviations to either side of
/// 1. The minimum may be negative.
pub(super) fn noise_range(degrees: f64) -> [f64; 2] {
    // χ² has the variance 2 per degree of freedom.
    let tolerance = NOISE_DEVIATIONS * (2.0 / degrees).sqrt();
    [1.0 - tolerance, 1.0 + tolerance]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_noise_is_three_deviations_of_chi_squared() {
        // χ² of 200 degrees of freedom has the expectation 200 and the standard deviation 20.
        let [low, high] = noise_range(200.0);
        assert!((200.0 * low - 140.0).abs() < 1e-12 && (200.0 * high - 260.0).abs() < 1e-12, "{low} {high}");
    }
}
