//! Eight complex numbers side by side, and elementary functions of eight real ones.

use super::{LANES, Lane};
use crate::math::Complex;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// Eight complex numbers side by side, real and imaginary parts in one lane each.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Complexes {
    pub(crate) re: Lane,
    pub(crate) im: Lane,
}

impl Complexes {
    pub(crate) const ZERO: Self = Self { re: [0.0; LANES], im: [0.0; LANES] };

    #[inline(always)]
    pub(crate) fn real(value: f64) -> Self {
        Self { re: [value; LANES], im: [0.0; LANES] }
    }

    #[inline(always)]
    pub(crate) fn lane(&self, i: usize) -> Complex {
        Complex::new(self.re[i], self.im[i])
    }

    #[inline(always)]
    pub(crate) fn set_lane(&mut self, i: usize, value: Complex) {
        self.re[i] = value.re;
        self.im[i] = value.im;
    }

    #[inline(always)]
    pub(crate) fn norm_sqr(&self) -> Lane {
        from_fn(|i| self.re[i] * self.re[i] + self.im[i] * self.im[i])
    }

    #[inline(always)]
    pub(crate) fn inverse(&self) -> Self {
        let n: Lane = from_fn(|i| 1.0 / (self.re[i] * self.re[i] + self.im[i] * self.im[i]));
        Self { re: from_fn(|i| self.re[i] * n[i]), im: from_fn(|i| -self.im[i] * n[i]) }
    }

    /// Adds `factor * k` to `self`, k the same complex number in all lanes.
    #[inline(always)]
    pub(crate) fn add_product(&mut self, factor: &Self, k: Complex) {
        for i in 0..LANES {
            self.re[i] += factor.re[i] * k.re - factor.im[i] * k.im;
            self.im[i] += factor.re[i] * k.im + factor.im[i] * k.re;
        }
    }

    /// Adds `factor * k` to `self`, k real.
    #[inline(always)]
    pub(crate) fn add_scaled(&mut self, factor: &Self, k: f64) {
        for i in 0..LANES {
            self.re[i] += factor.re[i] * k;
            self.im[i] += factor.im[i] * k;
        }
    }
}

impl Add for Complexes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: from_fn(|i| self.re[i] + other.re[i]), im: from_fn(|i| self.im[i] + other.im[i]) }
    }
}

impl Sub for Complexes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: from_fn(|i| self.re[i] - other.re[i]), im: from_fn(|i| self.im[i] - other.im[i]) }
    }
}

impl Mul for Complexes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            re: from_fn(|i| self.re[i] * other.re[i] - self.im[i] * other.im[i]),
            im: from_fn(|i| self.re[i] * other.im[i] + self.im[i] * other.re[i]),
        }
    }
}

impl Div for Complexes {
    type Output = Self;
    #[inline(always)]
    #[expect(clippy::suspicious_arithmetic_impl, reason = "one real division per lane")]
    fn div(self, other: Self) -> Self {
        self * other.inverse()
    }
}

impl Mul<f64> for Complexes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        Self { re: from_fn(|i| self.re[i] * k), im: from_fn(|i| self.im[i] * k) }
    }
}

impl AddAssign for Complexes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Complexes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Maximum |x| of [`sin_cos`], up to which the three-part reduction keeps every digit.
pub(crate) const SIN_COS_LIMIT: f64 = 1e5;

/// Sine and cosine for 0 ≤ x ≤ [`SIN_COS_LIMIT`], within 2 units in the last place of 1.
#[inline(always)]
pub(crate) fn sin_cos(x: Lane) -> (Lane, Lane) {
    // π/2 in three parts; the first two have 33 bits, so that their multiples are exact (Cody and Waite 1980).
    const A: f64 = 1.570_796_326_734_125_6;
    const B: f64 = 6.077_100_506_303_966e-11;
    const C: f64 = 2.022_266_248_795_950_6e-21;
    // Adding 1.5·2⁵² rounds to an integer; the low bits of the sum are those of this integer.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const SIN: [f64; 7] = [
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5_040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
    ];
    const COS: [f64; 8] = [
        -0.5,
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
        1.0 / 20_922_789_888_000.0,
    ];

    let (mut sine, mut cosine) = ([0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        // x = nπ/2 + r.
        let shifted = x[i] * std::f64::consts::FRAC_2_PI + ROUND;
        let quadrant = shifted.to_bits();
        let n = shifted - ROUND;
        let r = ((x[i] - n * A) - n * B) - n * C;

        // Both series in r².
        let r2 = r * r;
        let mut s = SIN[6];
        let mut c = COS[7];
        c = c * r2 + COS[6];
        for k in (0..6).rev() {
            s = s * r2 + SIN[k];
            c = c * r2 + COS[k];
        }

        let s = r + r * r2 * s;
        let c = 1.0 + r2 * c;
        // Quadrants 1 and 3 exchange the two; sine is negative in 2 and 3, cosine in 1 and 2.
        let odd = quadrant & 1 == 1;
        let (first, second) = if odd { (c, s) } else { (s, c) };
        let sine_sign = (quadrant & 2) << 62;
        let cosine_sign = (quadrant.wrapping_add(1) & 2) << 62;
        sine[i] = f64::from_bits(first.to_bits() ^ sine_sign);
        cosine[i] = f64::from_bits(second.to_bits() ^ cosine_sign);
    }
    (sine, cosine)
}

/// Maximum |x| of [`tanh`].
pub(crate) const TANH_LIMIT: f64 = 1.0;

/// Hyperbolic tangent for |x| ≤ 1 with a relative error below 1e-15: ninth convergent of Lambert's continued fraction.
#[inline(always)]
pub(crate) fn tanh(x: Lane) -> Lane {
    from_fn(|i| {
        let x2 = x[i] * x[i];
        let numerator = (((x2 + 990.0) * x2 + 135_135.0) * x2 + 4_729_725.0) * x2 + 34_459_425.0;
        let denominator = (((45.0 * x2 + 13_860.0) * x2 + 945_945.0) * x2 + 16_216_200.0) * x2 + 34_459_425.0;
        x[i] * numerator / denominator
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_the_library() {
        for step in 0..200_000 {
            let x: Lane = from_fn(|i| f64::from(step) * 0.013 + i as f64 * 1.7e-3 + f64::from(step % 7) * 14_000.0);
            let (s, c) = sin_cos(x);
            for i in 0..LANES {
                let (sine, cosine) = x[i].sin_cos();
                assert!((s[i] - sine).abs() < 5e-16 && (c[i] - cosine).abs() < 5e-16, "{}: {} {}", x[i], s[i], sine);
            }
        }
    }

    #[test]
    fn hyperbolic_tangent_agrees_with_the_library() {
        for step in -1000..=1000 {
            let x = f64::from(step) / 1000.0;
            let t = tanh([x; LANES])[0];
            assert!((t - x.tanh()).abs() <= 1e-15 * x.abs(), "{x}");
        }
    }
}
