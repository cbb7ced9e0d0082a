//! Dual numbers: values with their derivatives by several variables, for formulas that are written once for numbers and
//! for numbers with derivatives.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Real number, or a real number with its derivatives.
pub(crate) trait Real:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
{
    /// Value without derivatives.
    fn value(self) -> f64;

    /// Square root.
    fn sqrt(self) -> Self;

    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);

    /// Tangent.
    fn tan(self) -> Self;

    /// Angle whose sine this is; beyond ±1 that of the limit.
    fn arcsin(self) -> Self;

    /// Hyperbolic sine and cosine.
    fn sinh_cosh(self) -> (Self, Self);
}

impl Real for f64 {
    fn value(self) -> f64 {
        self
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    fn tan(self) -> Self {
        self.tan()
    }

    fn arcsin(self) -> Self {
        self.clamp(-1.0, 1.0).asin()
    }

    fn sinh_cosh(self) -> (Self, Self) {
        let sinh = self.sinh();
        (sinh, (1.0 + sinh * sinh).sqrt())
    }
}

/// Number with its derivatives by N variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dual<const N: usize> {
    pub(crate) value: f64,
    pub(crate) by: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// Variable number `index` with a value.
    pub(crate) fn variable(value: f64, index: usize) -> Self {
        let mut by = [0.0; N];
        by[index] = 1.0;
        Self { value, by }
    }

    /// Function of this number with its value and its slope.
    fn function(self, value: f64, slope: f64) -> Self {
        Self { value, by: self.by.map(|by| by * slope) }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    fn from(value: f64) -> Self {
        Self { value, by: [0.0; N] }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, by: from_fn(|i| self.by[i] + other.by[i]) }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, by: from_fn(|i| self.by[i] - other.by[i]) }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    fn neg(self) -> Self {
        self * -1.0
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, by: mixed(&self.by, other.value, &other.by, self.value) }
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self.function(self.value * factor, factor)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let (value, inverse) = (self.value / other.value, other.value.recip());
        Self { value, by: mixed(&self.by, inverse, &other.by, -value * inverse) }
    }
}

impl<const N: usize> Real for Dual<N> {
    fn value(self) -> f64 {
        self.value
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.function(root, 0.5 / root)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.function(sin, cos), self.function(cos, -sin))
    }

    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.function(tangent, 1.0 + tangent * tangent)
    }

    fn arcsin(self) -> Self {
        let sine = self.value.clamp(-1.0, 1.0);
        let slope = if sine.abs() < 1.0 { (1.0 - sine * sine).sqrt().recip() } else { 0.0 };
        self.function(sine.asin(), slope)
    }

    fn sinh_cosh(self) -> (Self, Self) {
        let (sinh, cosh) = self.value.sinh_cosh();
        (self.function(sinh, cosh), self.function(cosh, sinh))
    }
}

/// Derivatives `a x + b y` of a product or a quotient.
fn mixed<const N: usize>(a: &[f64; N], x: f64, b: &[f64; N], y: f64) -> [f64; N] {
    from_fn(|i| a[i] * x + b[i] * y)
}

/// Scalar product.
#[inline(always)]
pub(crate) fn dot<T: Real>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Sum `a x + b y` of two vectors.
#[inline(always)]
pub(crate) fn combined<T: Real>(a: &[T; 3], x: T, b: &[T; 3], y: T) -> [T; 3] {
    from_fn(|i| a[i] * x + b[i] * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula<T: Real>(x: T, y: T) -> T {
        let (sin, cos) = (x * y).sin_cos();
        let (sinh, cosh) = (x - y).sinh_cosh();
        (sin * 2.0 - cos / y + (x * x + y).sqrt() * x.tan()) * (x * 0.3).arcsin() - x * sinh / cosh
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let (x, y) = (0.7, 1.3);
        let found = formula(Dual::<2>::variable(x, 0), Dual::variable(y, 1));
        assert!((found.value - formula(x, y)).abs() < 1e-15);
        let h = 1e-4;
        let slope = |of: &dyn Fn(f64) -> f64| (8.0 * (of(h) - of(-h)) - (of(2.0 * h) - of(-2.0 * h))) / (12.0 * h);
        // Rounding over the step; the fifth order is 1e-16.
        assert!((found.by[0] - slope(&|d| formula(x + d, y))).abs() < 1e-11);
        assert!((found.by[1] - slope(&|d| formula(x, y + d))).abs() < 1e-11);
    }
}
