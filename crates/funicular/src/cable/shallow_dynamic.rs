//! Dynamic stiffness of a shallow sagging cable, in closed form (Starossek 1991; equations (3) to (9) of the paper).
//!
//! With `γ = (Ω/2)² = ω_c² l² m/(4τ)` the formulas need three entire functions of γ,
//!
//! ```text
//! c = cos √γ,   σ = sin √γ/√γ,   q = (σ − c)/γ,
//! Δ = c + λ² q/4,
//! k_a = (EA/L_e) c/Δ,   k_b = (EA/L_e)(ε/2) γ q/Δ,
//! k_c = (τ/l)[c/σ − γ (σ + λ² q/4)/Δ],   k_o = (τ/l)[c/σ − γ σ/c],
//! ```
//!
//! and are regular at ω = 0, so that γ → 0 needs no special case. They are homogeneous of degree zero in (c, σ, q): the
//! growth of sin and cos with damping cancels. Poles: Δ = 0 (symmetric modes in plane), σ = 0 (antisymmetric modes, in
//! plane and out of plane), c = 0 (symmetric modes out of plane). Derivation: docs/theory.md, equations (20) to (26).

use super::{LocalAxes, LocalStiffness, Sag};
use crate::math::{Complex, roots};
use crate::robot::Damping;
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Sub};

/// Platform end of a cable in the shallow-dynamic model.
#[derive(Debug, Clone, PartialEq)]
pub struct ShallowDynamic {
    /// Sag parameters of the cable.
    pub sag: Sag,
    /// Local axes at the platform end.
    pub axes: LocalAxes,
    /// Damping of the rope.
    pub damping: Damping,
    /// Leave out k_o, as the paper does.
    pub in_plane_only: bool,
    /// Ratio γ/ω² = l² m/(4τ) [s²].
    pub gamma_by_square: f64,
}

/// Entire functions of γ: c, σ and q. `T` is a real number, a complex number, or several numbers side by side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entire<T> {
    pub(crate) gamma: T,
    pub(crate) c: T,
    pub(crate) sigma: T,
    pub(crate) q: T,
}

/// Arithmetic that the formulas need.
pub(crate) trait Number:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
{
}
impl<T> Number for T where
    T: Copy + Default + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T> + Mul<f64, Output = T>
{
}

/// |γ| below which the quotient (σ − c)/γ is computed from its series. At this limit the quotient loses two digits, and
/// the first term left out of the series is 3e-18.
pub(crate) const SERIES_BELOW: f64 = 0.25;

/// Coefficients of q(γ) = Σ (−γ)^n (2n+2)/(2n+3)!.
pub(crate) const Q_SERIES: [f64; 7] = [
    1.0 / 3.0,
    -1.0 / 30.0,
    1.0 / 840.0,
    -1.0 / 45_360.0,
    1.0 / 3_991_680.0,
    -1.0 / 518_918_400.0,
    1.0 / 93_405_312_000.0,
];

/// Local stiffness by the formulas at the head of this file; the scales are EA/L_e, ε/2, τ/l and λ²/4.
#[inline(always)]
pub(crate) fn stiffness<T: Number>(of: Entire<T>, sag: &Sag) -> LocalStiffness<T> {
    let Entire { gamma, c, sigma, q } = of;
    let along = sag.axial_stiffness / sag.effective_length;
    let transverse = sag.tension / sag.chord;
    let sagging = q * (0.25 * sag.lambda2);
    let determinant = c + sagging;
    let string = c / sigma;
    LocalStiffness {
        axial: c / determinant * along,
        coupling: gamma * q / determinant * (0.5 * sag.epsilon * along),
        normal: (string - gamma * (sigma + sagging) / determinant) * transverse,
        out_of_plane: (string - gamma * sigma / c) * transverse,
        across: Default::default(),
    }
}

impl Entire<f64> {
    /// Functions at real γ ≥ 0.
    pub(crate) fn real(gamma: f64) -> Self {
        let h = gamma.sqrt();
        let (s, c) = h.sin_cos();
        if gamma < SERIES_BELOW {
            let q = Q_SERIES.iter().rev().fold(0.0, |sum, coefficient| sum * gamma + coefficient);
            Self { gamma, c, sigma: c + gamma * q, q }
        } else {
            let sigma = s / h;
            Self { gamma, c, sigma, q: (sigma - c) / gamma }
        }
    }

    /// Derivative dq/dγ = (σ − 3q)/(2γ).
    fn q_slope(&self) -> f64 {
        if self.gamma < SERIES_BELOW {
            (1..Q_SERIES.len()).rev().fold(0.0, |sum, n| sum * self.gamma + q_slope_coefficient(n))
        } else {
            (self.sigma - 3.0 * self.q) / (2.0 * self.gamma)
        }
    }
}

/// Coefficient of γ^(n−1) in dq/dγ.
fn q_slope_coefficient(n: usize) -> f64 {
    n as f64 * Q_SERIES[n]
}

impl Entire<Complex> {
    /// Functions at complex γ, all three divided by the hyperbolic cosine of the imaginary part of √γ.
    pub(crate) fn complex(gamma: Complex) -> Self {
        let h = gamma.sqrt();
        let (sin, cos) = h.re.sin_cos();
        let tanh = h.im.tanh();
        let (s, c) = (Complex::new(sin, cos * tanh), Complex::new(cos, -sin * tanh));
        if gamma.norm_sqr() < SERIES_BELOW * SERIES_BELOW {
            let q = Q_SERIES.iter().rev().fold(Complex::new(0.0, 0.0), |sum, coefficient| sum * gamma + coefficient);
            let q = q / h.im.cosh();
            Self { gamma, c, sigma: c + gamma * q, q }
        } else {
            let sigma = s / h;
            Self { gamma, c, sigma, q: (sigma - c) / gamma }
        }
    }

    /// Derivative dq/dγ, divided by the hyperbolic cosine of the imaginary part of √γ.
    fn q_slope(&self) -> Complex {
        if self.gamma.norm_sqr() < SERIES_BELOW * SERIES_BELOW {
            let zero = Complex::new(0.0, 0.0);
            let sum = (1..Q_SERIES.len()).rev().fold(zero, |sum, n| sum * self.gamma + q_slope_coefficient(n));
            sum / self.gamma.sqrt().im.cosh()
        } else {
            (self.sigma - self.q * 3.0) / (self.gamma * 2.0)
        }
    }
}

impl ShallowDynamic {
    /// Cable from its sag parameters; its tension is positive.
    pub fn new(sag: Sag, axes: LocalAxes, damping: Damping, in_plane_only: bool) -> Self {
        let gamma_by_square = sag.chord * sag.chord * sag.mass_per_length / (4.0 * sag.tension);
        Self { sag, axes, damping, in_plane_only, gamma_by_square }
    }

    /// Dimensionless undamped frequency Ω = ω l √(m/τ).
    #[inline]
    pub fn dimensionless(&self, omega: f64) -> f64 {
        2.0 * omega * self.gamma_by_square.sqrt()
    }

    /// Undamped stiffness in local axes at ω [rad/s], [N/m].
    pub fn undamped(&self, omega: f64) -> LocalStiffness<f64> {
        let mut k = stiffness(Entire::real(omega * omega * self.gamma_by_square), &self.sag);
        if self.in_plane_only {
            k.out_of_plane = 0.0;
        }
        k
    }

    /// Damped stiffness in local axes at ω [rad/s], [N/m].
    pub fn damped(&self, omega: f64) -> LocalStiffness<Complex> {
        let (re, im) = self.damping.square(omega, self.sag.mass_per_length);
        let mut k = stiffness(Entire::complex(Complex::new(re, im) * self.gamma_by_square), &self.sag);
        if self.in_plane_only {
            k.out_of_plane = Complex::new(0.0, 0.0);
        }
        k
    }

    /// Stiffness at the complex square ω_c² [rad²/s²] and minus its derivative by ω_c² [kg].
    pub(crate) fn at(&self, square: Complex) -> (LocalStiffness<Complex>, LocalStiffness<Complex>) {
        let of = Entire::complex(square * self.gamma_by_square);
        let (mut k, mut mass) = (stiffness(of, &self.sag), self.mass_of(of, of.q_slope()));
        if self.in_plane_only {
            (k.out_of_plane, mass.out_of_plane) = (0.0.into(), 0.0.into());
        }
        (k, mass)
    }

    /// Force on the held platform end in (e, n, b) for a displacement of the far end at ω [rad/s], damped [N].
    ///
    /// # References
    /// docs/theory.md, equation (86).
    pub(crate) fn force_by_far_end(&self, [e, n, b]: &[f64; 3], omega: f64) -> [Complex; 3] {
        let (re, im) = self.damping.square(omega, self.sag.mass_per_length);
        let of = Entire::complex(Complex::new(re, im) * self.gamma_by_square);
        let Entire { gamma, c, sigma, q } = of;
        let along = stiffness(of, &self.sag).axial;
        let turn = gamma * q / c * (0.5 * self.sag.epsilon);

        // The functions are divided by cosh Im √γ, their products by its square: 1/(σc) gets it back.
        let scale = (Complex::new(re, im) * self.gamma_by_square).sqrt().im.cosh().powi(2);
        let across = self.sag.tension / self.sag.chord / (sigma * c * scale);
        let pulled = along * (turn * n - e);
        let out_of_plane = if self.in_plane_only { 0.0.into() } else { across * b };
        [-pulled, across * n - turn * pulled, out_of_plane]
    }

    /// Minus the derivative of the undamped stiffness by ω² [kg]: the moving mass of the cable per unit motion of its
    /// end. As a 3×3 matrix it is positive semidefinite.
    pub fn effective_mass(&self, omega: f64) -> LocalStiffness<f64> {
        let of = Entire::real(omega * omega * self.gamma_by_square);
        let mut mass = self.mass_of(of, of.q_slope());
        if self.in_plane_only {
            mass.out_of_plane = 0.0;
        }
        mass
    }

    /// Derivatives of the quotients at the head of this file, with c' = −σ/2, σ' = −q/2 and q' given. Like the
    /// quotients they are homogeneous of degree zero in (c, σ, q, q').
    fn mass_of<T: Number>(&self, of: Entire<T>, q_by: T) -> LocalStiffness<T> {
        let Entire { gamma, c, sigma, q } = of;
        let (c_by, sigma_by) = (sigma * -0.5, q * -0.5);
        let weight = 0.25 * self.sag.lambda2;
        let (d, d_by) = (c + q * weight, c_by + q_by * weight);
        let (p, p_by) = (sigma + q * weight, sigma_by + q_by * weight);
        let along = self.sag.axial_stiffness / self.sag.effective_length * self.gamma_by_square;
        let transverse = self.sag.tension / self.sag.chord * self.gamma_by_square;
        let quotient = |n: T, n_by: T, d: T, d_by: T| (n_by * d - n * d_by) / (d * d);
        let string_by = quotient(c, c_by, sigma, sigma_by);
        LocalStiffness {
            axial: quotient(c, c_by, d, d_by) * -along,
            coupling: quotient(gamma * q, q + gamma * q_by, d, d_by) * (-along * 0.5 * self.sag.epsilon),
            normal: (string_by - quotient(gamma * p, p + gamma * p_by, d, d_by)) * -transverse,
            out_of_plane: (string_by - quotient(gamma * sigma, sigma + gamma * sigma_by, c, c_by)) * -transverse,
            across: Default::default(),
        }
    }

    /// Number of clamped-clamped frequencies below ω [rad/s]: J0 of Wittrick and Williams.
    ///
    /// The number out of plane is ⌊Ω/π⌋. In plane it is one less while ω has passed the string value of a symmetric
    /// root, but not the root itself, which sag has raised (k_a < 0).
    pub fn clamped_modes_below(&self, omega: f64) -> usize {
        let string = (self.dimensionless(omega) / PI).floor();
        let of = Entire::real(omega * omega * self.gamma_by_square);
        let determinant = of.c + 0.25 * self.sag.lambda2 * of.q;
        // The count gives the sign of cos(Ω/2), so that both agree where the cosine vanishes.
        let cosine_is_positive = matches!(string.rem_euclid(4.0) as u8, 0 | 3);
        let raised = self.sag.lambda2 > 0.0 && (determinant > 0.0) != cosine_is_positive;
        let in_plane = string as usize - usize::from(raised);
        in_plane + if self.in_plane_only { 0 } else { string as usize }
    }

    /// Clamped-clamped frequencies below ω [rad/s], ascending, with multiplicity.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<f64> {
        let root_scale = self.gamma_by_square.sqrt();
        if root_scale == 0.0 {
            return Vec::new();
        }

        let last = omega * root_scale;
        let mut halves = Vec::new();

        // Half angles h = Ω/2: antisymmetric modes jπ, symmetric modes of the string (j − ½)π.
        for j in 1..=(last / FRAC_PI_2).floor() as usize {
            let h = j as f64 * FRAC_PI_2;
            if !self.in_plane_only {
                halves.push(h);
            }
            if j % 2 == 0 {
                halves.push(h);
            } else {
                halves.push(self.symmetric_root(h));
            }
        }

        let mut frequencies: Vec<f64> = halves.into_iter().map(|h| h / root_scale).filter(|f| *f < omega).collect();
        frequencies.sort_by(f64::total_cmp);
        frequencies
    }

    /// Symmetric root in plane, h = Ω/2, that belongs to the string's root `string` = (j − ½)π: the solution of Δ = 0
    /// in (string, string + π), `tan h = h − (4/λ²) h³` (Irvine and Caughey 1974).
    fn symmetric_root(&self, string: f64) -> f64 {
        let weight = 0.25 * self.sag.lambda2;
        if weight == 0.0 {
            return string;
        }
        // At both ends cos h = 0 and Δ = (λ²/4) sin h/h³, with opposite signs. There cos is replaced by its exact zero.
        let end = |h: f64| weight * h.sin() / h.powi(3);
        let f = |h: f64| {
            let of = Entire::real(h * h);
            of.c + weight * of.q
        };
        roots::brent(string, end(string), string + PI, end(string + PI), f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fig2(xi: f64) -> ShallowDynamic {
        let sag = Sag::new(6.848, 36f64.to_radians().cos(), 77.6, 20e9 * 1.2566e-5, 0.067, 0.067 * 9.81);
        let axes = LocalAxes::of_chord(
            &crate::math::Vec3::zeros(),
            &crate::math::Vec3::new(36f64.to_radians().cos(), 0.0, 36f64.to_radians().sin()),
            &crate::math::Vec3::z(),
        );
        ShallowDynamic::new(sag, axes, Damping::Ratio(xi), false)
    }

    #[test]
    fn at_rest_it_is_the_static_sag() {
        let cable = fig2(0.0);
        let k = cable.undamped(0.0);
        let still = super::super::shallow_static::stiffness(&cable.sag);
        assert!((k.axial / still.axial - 1.0).abs() < 1e-15);
        assert_eq!(k.coupling.to_bits(), 0.0_f64.to_bits());
        assert!((k.normal / still.normal - 1.0).abs() < 1e-15);
        assert!((k.out_of_plane / still.out_of_plane - 1.0).abs() < 1e-15);
    }

    #[test]
    fn both_entries_agree_where_damping_vanishes_and_across_the_series_limit() {
        let cable = fig2(0.0);
        for i in 1..400 {
            let omega = 0.05 * f64::from(i);
            let (real, complex) = (cable.undamped(omega), cable.damped(omega));
            let close = |a: f64, b: Complex| (b - a).norm() <= 1e-11 * (1.0 + a.abs());
            assert!(close(real.axial, complex.axial), "{omega}");
            assert!(close(real.coupling, complex.coupling), "{omega}");
            assert!(close(real.normal, complex.normal), "{omega}");
            assert!(close(real.out_of_plane, complex.out_of_plane), "{omega}");
        }
    }

    #[test]
    fn effective_mass_is_the_differenced_stiffness() {
        let cable = fig2(0.0);
        for omega in [0.5, 3.0, 7.0, 12.0, 17.0, 25.0, 40.0, 61.0] {
            let step = 1e-4 * omega;
            let (above, below) = (cable.undamped(omega + step), cable.undamped(omega - step));
            let mass = cable.effective_mass(omega);
            let by_square = |a: f64, b: f64| -(a - b) / (4.0 * omega * step);
            for (exact, a, b) in [
                (mass.axial, above.axial, below.axial),
                (mass.coupling, above.coupling, below.coupling),
                (mass.normal, above.normal, below.normal),
                (mass.out_of_plane, above.out_of_plane, below.out_of_plane),
            ] {
                // The error of a central difference comes from the third derivative; away from poles it is below 1e-5.
                assert!((exact - by_square(a, b)).abs() < 2e-5 * exact.abs().max(1e-3), "{omega}: {exact}");
            }
            let (in_plane, determinant) = (mass.axial, mass.axial * mass.normal - mass.coupling * mass.coupling);
            assert!(in_plane > 0.0 && determinant > 0.0 && mass.out_of_plane > 0.0, "mass is positive at {omega}");
        }
    }

    #[test]
    fn the_count_of_clamped_modes_equals_their_list() {
        for lambda2 in [0.0, 0.01, 1.0, 7.57, 39.0, 40.0, 158.0, 1000.0, 1e6] {
            let mut cable = fig2(0.0);
            cable.sag.lambda2 = lambda2;
            for i in 1..600 {
                let omega = 0.313 * f64::from(i);
                let listed = cable.clamped_frequencies_below(omega).len();
                assert_eq!(cable.clamped_modes_below(omega), listed, "λ² {lambda2}, ω {omega}");
            }
        }
    }

    #[test]
    fn strong_damping_does_not_overflow() {
        let mut cable = fig2(0.0);
        cable.damping = Damping::Viscous(1e6);
        let k = cable.damped(1e4);
        assert!(k.axial.norm().is_finite() && k.normal.norm().is_finite() && k.out_of_plane.norm().is_finite());
    }
}
