//! Numbers as polynomials of time: values with their first two derivatives along a motion, for formulas that are
//! written once for numbers and for numbers with derivatives.

use super::dual::Real;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Polynomial `a + b t + c t²` in time, higher powers left out, of a number (row 0) and, with N = 2, of its derivative
/// by a further variable (row 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Jet<const N: usize> {
    pub(crate) rows: [[f64; 3]; N],
}

impl<const N: usize> Jet<N> {
    /// Polynomial of time with these coefficients, which does not depend on the further variable.
    pub(crate) fn of_time(coefficients: [f64; 3]) -> Self {
        Self { rows: from_fn(|row| if row == 0 { coefficients } else { [0.0; 3] }) }
    }

    /// Coefficients of the number.
    pub(crate) fn coefficients(&self) -> [f64; 3] {
        self.rows[0]
    }

    /// Function of this number with its value and its first three derivatives.
    #[inline(always)]
    fn function(self, [value, first, second, third]: [f64; 4]) -> Self {
        let [_, b, c] = self.rows[0];
        let half = 0.5 * b * b;
        let slope = [first, second * b, second * c + third * half];
        Self {
            rows: from_fn(|row| {
                if row == 0 { [value, first * b, first * c + second * half] } else { product(&slope, &self.rows[row]) }
            }),
        }
    }

    /// Numbers from each pair of coefficients.
    #[inline(always)]
    fn mixed(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self { rows: from_fn(|row| from_fn(|k| of(self.rows[row][k], other.rows[row][k]))) }
    }
}

/// Product of two polynomials up to t².
#[inline(always)]
fn product(one: &[f64; 3], other: &[f64; 3]) -> [f64; 3] {
    [
        one[0] * other[0],
        one[0] * other[1] + one[1] * other[0],
        one[0] * other[2] + one[1] * other[1] + one[2] * other[0],
    ]
}

impl<const N: usize> From<f64> for Jet<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self::of_time([value, 0.0, 0.0])
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.mixed(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.mixed(other, |a, b| a - b)
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let of = |row: usize| {
            let one = product(&self.rows[0], &other.rows[row]);
            if row == 0 {
                return one;
            }
            let two = product(&self.rows[row], &other.rows[0]);
            from_fn(|k| one[k] + two[k])
        };
        Self { rows: from_fn(of) }
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { rows: self.rows.map(|row| row.map(|coefficient| coefficient * factor)) }
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = other.value().recip();
        let square = inverse * inverse;
        self * other.function([inverse, -square, 2.0 * square * inverse, -6.0 * square * square])
    }
}

impl<const N: usize> Real for Jet<N> {
    fn value(self) -> f64 {
        self.rows[0][0]
    }

    fn sqrt(self) -> Self {
        let (x, root) = (self.value(), self.value().sqrt());
        self.function([root, 0.5 / root, -0.25 / (root * x), 0.375 / (root * x * x)])
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value().sin_cos();
        (self.function([sin, cos, -sin, -cos]), self.function([cos, -sin, -cos, sin]))
    }

    fn tan(self) -> Self {
        let tangent = self.value().tan();
        let slope = 1.0 + tangent * tangent;
        self.function([tangent, slope, 2.0 * tangent * slope, (2.0 + 6.0 * tangent * tangent) * slope])
    }

    fn arcsin(self) -> Self {
        let sine = self.value().clamp(-1.0, 1.0);
        let square = 1.0 - sine * sine;
        let slope = if square > 0.0 { square.sqrt().recip() } else { 0.0 };
        let cube = slope * slope * slope;
        self.function([sine.asin(), slope, sine * cube, (1.0 + 2.0 * sine * sine) * cube * slope * slope])
    }

    fn sinh_cosh(self) -> (Self, Self) {
        let (sinh, cosh) = self.value().sinh_cosh();
        (self.function([sinh, cosh, sinh, cosh]), self.function([cosh, sinh, cosh, sinh]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula<T: Real>(x: T, y: T) -> T {
        let (sin, cos) = (x * y).sin_cos();
        let (sinh, cosh) = (x - y * 0.3).sinh_cosh();
        (sin * 2.0 - cos / y + (x * x + y).sqrt() * x.tan()) * (x * 0.3).arcsin() - sinh / cosh * y
    }

    /// Derivatives by Richardson's extrapolation of central differences: the error of the seventh order is 1e-12, and
    /// rounding over the square of the step 1e-10.
    #[test]
    fn coefficients_are_those_of_differences() {
        let (x, y) = ([0.7, 0.4, -0.9], [1.3, -0.2, 0.5]);
        let at = |c: &[f64; 3], t: f64| c[0] + t * (c[1] + t * c[2]);
        let of = |t: f64, s: f64| formula(at(&x, t) + s, at(&y, t) - 0.5 * s);
        let mut number = [Jet::<2>::of_time(x), Jet::of_time(y)];
        (number[0].rows[1][0], number[1].rows[1][0]) = (1.0, -0.5);
        let found = formula(number[0], number[1]);
        // The same operations give the same bits.
        let bits = |row: [f64; 3]| row.map(f64::to_bits);
        assert_eq!(bits(formula(Jet::<1>::of_time(x), Jet::of_time(y)).rows[0]), bits(found.rows[0]));

        let h = 3e-3;
        let differences = |of: &dyn Fn(f64) -> f64| {
            let pair = |k: f64| [of(k * h) - of(-k * h), of(k * h) - 2.0 * of(0.0) + of(-k * h)];
            let [one, two, three] = [pair(1.0), pair(2.0), pair(3.0)];
            let first = (45.0 * one[0] - 9.0 * two[0] + three[0]) / (60.0 * h);
            let second = (270.0 * one[1] - 27.0 * two[1] + 2.0 * three[1]) / (180.0 * h * h);
            [of(0.0), first, 0.5 * second]
        };
        let slope = |t: f64| differences(&|s| of(t, s))[1];
        for (found, wanted) in [(found.rows[0], differences(&|t| of(t, 0.0))), (found.rows[1], differences(&slope))] {
            for (k, (a, b)) in found.iter().zip(wanted).enumerate() {
                assert!((a - b).abs() < [1e-12, 1e-10, 1e-7][k], "{k}: {a} {b}");
            }
        }
    }
}
