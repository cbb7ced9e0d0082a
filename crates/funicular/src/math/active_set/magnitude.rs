//! Numbers of the active-set method: plain ones, and numbers of two magnitudes for a point that lies far above.

use super::{ConstraintSet, ROUNDING};
use std::ops::{Add, Div, Mul, Sub};

/// Relative rounding of slopes and of parts of multipliers.
const FLAT: f64 = 1e-14;

/// Number type of coordinates, violations and multipliers: plain numbers, or numbers of two magnitudes.
pub(crate) trait Magnitude:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
    const ZERO: Self;

    /// Violation: amount by which a sum of terms, each a factor times a coordinate, is below `level`. `None` if it is
    /// at most `tolerance` or rounding. NaN is a violation, because there is no such point.
    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self>;

    /// Multiplier reduced by `by`, at least zero.
    fn less(self, by: Self) -> Self;

    /// True if the number, or a part of it, is NaN.
    fn is_nan(&self) -> bool;

    /// Number itself, or the near part of two magnitudes.
    fn near(self) -> f64;

    /// Adds a number to the near part.
    fn plus_near(self, by: f64) -> Self;

    /// Removes rounding from a point that lies on all active inequalities.
    fn settle(x: &mut [Self], constraints: &mut impl ConstraintSet);
}

impl Magnitude for f64 {
    const ZERO: Self = 0.0;

    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self> {
        let (mut lack, mut size) = (level, level.abs());
        for (a, x) in terms {
            lack -= a * x;
            size += (a * x).abs();
        }
        (lack > tolerance.max(ROUNDING * size) || lack.is_nan()).then_some(lack)
    }

    #[inline]
    fn less(self, by: Self) -> Self {
        (self - by).max(0.0)
    }

    #[inline]
    fn is_nan(&self) -> bool {
        Self::is_nan(*self)
    }

    #[inline]
    fn near(self) -> f64 {
        self
    }

    #[inline]
    fn plus_near(self, by: f64) -> Self {
        self + by
    }

    fn settle(_: &mut [Self], _: &mut impl ConstraintSet) {}
}

/// Number `far · L + near` with an L larger than every number: the far parts are compared first.
///
/// The highest point of a polyhedron is the point nearest to one high enough above. The necessary height depends on the
/// flattest edge, and so large a number would leave no digits to the others; so L stays a symbol.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) struct TwoMagnitudes {
    pub(super) far: f64,
    pub(super) near: f64,
}

impl Add for TwoMagnitudes {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { far: self.far + other.far, near: self.near + other.near }
    }
}

impl Sub for TwoMagnitudes {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { far: self.far - other.far, near: self.near - other.near }
    }
}

impl Mul<f64> for TwoMagnitudes {
    type Output = Self;

    #[inline]
    fn mul(self, by: f64) -> Self {
        Self { far: self.far * by, near: self.near * by }
    }
}

impl Div<f64> for TwoMagnitudes {
    type Output = Self;

    #[inline]
    fn div(self, by: f64) -> Self {
        Self { far: self.far / by, near: self.near / by }
    }
}

impl Magnitude for TwoMagnitudes {
    const ZERO: Self = Self { far: 0.0, near: 0.0 };

    fn lack(terms: impl Iterator<Item = (f64, Self)>, level: f64, tolerance: f64) -> Option<Self> {
        let (mut lack, mut sizes) = (Self { far: 0.0, near: level }, Self { far: 0.0, near: level.abs() });
        for (a, x) in terms {
            lack = lack - x * a;
            // The far part was a unit vector at the start: its rounding stays that of one.
            sizes = sizes + Self { far: a.abs(), near: (a * x.near).abs() };
        }
        if lack.far.abs() <= FLAT * sizes.far {
            lack.far = 0.0;
        }
        let violated = lack.far > 0.0 || lack.far == 0.0 && lack.near > tolerance.max(ROUNDING * sizes.near);
        (violated || lack.is_nan()).then_some(lack)
    }

    #[inline]
    fn less(self, by: Self) -> Self {
        let mut left = self - by;
        if left.far.abs() <= FLAT * self.far.abs() {
            left.far = 0.0;
        }
        if left < Self::ZERO { Self::ZERO } else { left }
    }

    #[inline]
    fn is_nan(&self) -> bool {
        self.far.is_nan() || self.near.is_nan()
    }

    #[inline]
    fn near(self) -> f64 {
        self.near
    }

    #[inline]
    fn plus_near(self, by: f64) -> Self {
        Self { far: self.far, near: self.near + by }
    }

    /// The far part is the component of the vertical outside the span of the active normals.
    fn settle(x: &mut [Self], constraints: &mut impl ConstraintSet) {
        constraints.split_vertical();
        x.iter_mut().zip(constraints.rest()).for_each(|(x, rest)| x.far = *rest);
    }
}
