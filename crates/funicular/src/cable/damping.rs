//! Damping of a rope as a complex frequency of its cable, motion e^{+iωt}: `ω_c² = ω²(1 − 2iξ)` with a constant ratio,
//! `ω_c² = ω² − iωc/m` with a viscous coefficient (docs/theory.md, section 4). A cable without mass has no frequency of
//! its own, so it has no damping either. The loss of its stretch is a complex factor of its axial stiffness.

use crate::math::Complex;
use crate::robot::{Damping, StretchLoss};

impl Damping {
    /// Real and imaginary part of the square `ω_c²` of the cable's complex frequency [rad²/s²] at ω [rad/s], for a mass
    /// per length [kg/m].
    #[inline]
    pub fn square(self, omega: f64, mass_per_length: f64) -> (f64, f64) {
        let square = omega * omega;
        match self {
            Self::Ratio(xi) => (square, -2.0 * xi * square),
            Self::Viscous(c) => (square, over_mass(-omega * c, mass_per_length)),
        }
    }

    /// Square of the cable's complex frequency `ω_c²` at a complex ω of positive real part, and its derivative by ω.
    pub(crate) fn square_with_slope(self, omega: Complex, mass_per_length: f64) -> (Complex, Complex) {
        match self {
            Self::Ratio(xi) => {
                let loss = Complex::new(1.0, -2.0 * xi);
                (omega * omega * loss, 2.0 * omega * loss)
            }
            Self::Viscous(c) => {
                let rate = Complex::new(0.0, over_mass(c, mass_per_length));
                (omega * (omega - rate), 2.0 * omega - rate)
            }
        }
    }

    /// Derivatives of `ω_c²` at a complex ω by the mass per length [kg/m], and by the damping ratio or the viscous
    /// damping per length.
    pub(crate) fn square_by_values(self, omega: Complex, mass_per_length: f64) -> [Complex; 2] {
        match self {
            Self::Ratio(_) => [Complex::new(0.0, 0.0), omega * omega * Complex::new(0.0, -2.0)],
            Self::Viscous(c) => {
                let by_damping = omega * Complex::new(0.0, -over_mass(1.0, mass_per_length));
                [by_damping * -over_mass(c, mass_per_length), by_damping]
            }
        }
    }

    /// Complex ω [rad/s] at which `ω_c²` is the square of an undamped frequency; its real or imaginary part is
    /// positive.
    pub(crate) fn zero(self, undamped: f64, mass_per_length: f64) -> Complex {
        match self {
            Self::Ratio(xi) => undamped / Complex::new(1.0, -2.0 * xi).sqrt(),
            Self::Viscous(c) => {
                let half = over_mass(c, 2.0 * mass_per_length);
                Complex::new(0.0, half) + Complex::from(undamped * undamped - half * half).sqrt()
            }
        }
    }

    /// Damping ratio of a vibration of the cable alone, at ω > 0 [rad/s].
    pub(crate) fn ratio_at(self, omega: f64, mass_per_length: f64) -> f64 {
        match self {
            Self::Ratio(xi) => xi,
            Self::Viscous(c) => over_mass(c, 2.0 * mass_per_length * omega),
        }
    }

    /// Damping of a rope per length that is `stretch` times its unstrained length: a viscous coefficient acts on the
    /// same piece of rope.
    pub(crate) fn per_length_over(self, stretch: f64) -> Self {
        match self {
            Self::Ratio(_) => self,
            Self::Viscous(c) => Self::Viscous(c / stretch),
        }
    }

    /// Damping multiplied by `fraction`.
    pub(crate) fn times(self, fraction: f64) -> Self {
        match self {
            Self::Ratio(xi) => Self::Ratio(xi * fraction),
            Self::Viscous(c) => Self::Viscous(c * fraction),
        }
    }
}

impl StretchLoss {
    /// True if the stretch has a loss.
    pub fn is_some(self) -> bool {
        self.factor != 0.0 || self.time != 0.0
    }

    /// Loss `h − 1 = iη + iωτ` at a complex ω of positive real part, and its derivative by ω; zero at rest.
    pub(crate) fn at(self, omega: Complex) -> (Complex, Complex) {
        let (i, is_at_rest) = (Complex::i(), omega == Complex::new(0.0, 0.0));
        let factor = if is_at_rest { 0.0 } else { self.factor };
        (i * (factor + omega * self.time), i * self.time)
    }

    /// Derivatives of the loss `h − 1` at a complex ω by the loss factor and by the damping time.
    pub(crate) fn by_values(omega: Complex) -> [Complex; 2] {
        [Complex::i(), Complex::i() * omega]
    }

    /// Loss factor Im h/Re h at ω [rad/s], ω > 0.
    pub(crate) fn factor_at(self, omega: f64) -> f64 {
        self.factor + omega * self.time
    }
}

/// Quotient by a mass; zero for a cable without mass.
#[inline]
fn over_mass(value: f64, mass: f64) -> f64 {
    if mass > 0.0 { value / mass } else { 0.0 }
}
