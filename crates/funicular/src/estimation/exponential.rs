//! Exponential of a 12×12 matrix with its first two integrals.

use crate::math::Matrix;

pub(super) type Mat12 = Matrix<12, 12>;

/// Largest norm of A h at which the series begins; with nine terms the rest is below 1e-16.
const MAX_SERIES: f64 = 0.25;

/// Number of terms of the series of Γ₂.
const TERMS: usize = 9;

/// Maximum number of doublings; 2^24 steps of the series are beyond any sampling of a log.
const MAX_DOUBLINGS: u32 = 24;

/// Exponential over a step.
#[derive(Debug, Clone)]
pub(super) struct StepExponential {
    /// E = e^{AΔ}.
    pub(super) whole: Mat12,
    /// e^{AΔ/2}.
    pub(super) half: Mat12,
    /// Γ = ∫ e^{At} dt from 0 to Δ.
    pub(super) once: Mat12,
    /// Γ₂ = ∫ Γ dt.
    pub(super) twice: Mat12,
}

impl StepExponential {
    /// Exponential of `a` over a step [s].
    ///
    /// # References
    /// docs/theory.md, equation (97u).
    pub(super) fn of(a: &Mat12, step: f64) -> Self {
        let size = a.iter().fold(0.0_f64, |size, value| size.max(value.abs())) * 12.0 * step;
        let needed = if size.is_finite() { (size / MAX_SERIES).max(1.0).log2().ceil() } else { 0.0 };
        let doublings = (needed as u32).clamp(1, MAX_DOUBLINGS);
        let h = step / f64::from(2_u32.pow(doublings));

        // Γ₂ = h² Σ (Ah)^k/(k + 2)! by Horner's rule, and the others from it.
        let ah = a * h;
        let mut twice = Mat12::identity();
        for k in (1..=TERMS).rev() {
            twice = Mat12::identity() + ah * twice / (k + 2) as f64;
        }
        twice *= 0.5 * h * h;
        let mut once = Mat12::identity() * h + a * twice;
        let mut whole = Mat12::identity() + a * once;
        let mut half = whole;
        let mut h = h;
        for _ in 0..doublings {
            half = whole;
            twice = twice + once * h + whole * twice;
            once = once + whole * once;
            whole = whole * whole;
            h *= 2.0;
        }
        Self { whole, half, once, twice }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An oscillator of 60 rad/s with known integrals.
    #[test]
    fn an_oscillator_has_its_closed_forms() {
        let (omega, step) = (60.0_f64, 0.05);
        let mut a = Mat12::zeros();
        for i in 0..6 {
            a[(i, i + 6)] = 1.0;
            a[(i + 6, i)] = -omega * omega;
        }
        let found = StepExponential::of(&a, step);
        let (sin, cos) = (omega * step).sin_cos();
        let close = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-12 * expected.abs().max(1.0));
        close(found.whole[(0, 0)], cos);
        close(found.whole[(0, 6)], sin / omega);
        close(found.half[(0, 0)], (0.5 * omega * step).cos());
        close(found.once[(0, 0)], sin / omega);
        close(found.once[(0, 6)], (1.0 - cos) / (omega * omega));
        close(found.twice[(0, 0)], (1.0 - cos) / (omega * omega));
        close(found.twice[(0, 6)], (step - sin / omega) / (omega * omega));
    }
}
