//! Vectors in space over real and complex numbers: modes are real, responses and damped modes complex.

use crate::math::{Complex, Vec3};
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Real or complex number.
pub(super) trait Field:
    Copy
    + Default
    + From<f64>
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
{
    /// Number of real parts.
    const PARTS: usize;

    /// Real part with this number.
    fn part(self, part: usize) -> f64;

    /// Number with these real parts.
    fn of_parts(part: impl Fn(usize) -> f64) -> Self;
}

impl Field for f64 {
    const PARTS: usize = 1;

    fn part(self, _: usize) -> f64 {
        self
    }

    fn of_parts(part: impl Fn(usize) -> f64) -> Self {
        part(0)
    }
}

impl Field for Complex {
    const PARTS: usize = 2;

    fn part(self, part: usize) -> f64 {
        if part == 0 { self.re } else { self.im }
    }

    fn of_parts(part: impl Fn(usize) -> f64) -> Self {
        Self::new(part(0), part(1))
    }
}

/// Vector in space.
pub(super) type Vector<T> = [T; 3];

/// Vector of real components.
pub(super) fn vector<T: Field>(v: &Vec3) -> Vector<T> {
    from_fn(|i| v[i].into())
}

/// Product without conjugation.
#[inline(always)]
pub(super) fn dot<T: Field>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product.
#[inline(always)]
pub(super) fn cross<T: Field>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Sum.
#[inline(always)]
pub(super) fn add<T: Field>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    from_fn(|i| a[i] + b[i])
}

/// Difference `a − b`.
#[inline(always)]
pub(super) fn less<T: Field>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    from_fn(|i| a[i] - b[i])
}

/// Product with a number.
#[inline(always)]
pub(super) fn times<T: Field>(a: &Vector<T>, factor: T) -> Vector<T> {
    from_fn(|i| a[i] * factor)
}

/// Sum of products `a factor` added to a vector.
#[inline(always)]
pub(super) fn add_times<T: Field>(sum: &mut Vector<T>, a: &Vector<T>, factor: T) {
    for (sum, a) in sum.iter_mut().zip(a) {
        *sum += *a * factor;
    }
}

/// Real vector added to a vector.
pub(super) fn add_real(sum: &mut Vector<f64>, value: Vec3) {
    sum.iter_mut().zip(value.iter()).for_each(|(sum, value)| *sum += value);
}

/// Symmetric part of the outer product `a bᵀ`.
pub(super) fn symmetric_outer<T: Field>(a: &Vector<T>, b: &Vector<T>) -> [Vector<T>; 3] {
    from_fn(|i| from_fn(|j| (a[i] * b[j] + a[j] * b[i]) * 0.5))
}
