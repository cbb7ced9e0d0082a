//! Ranges of the numbers of a robot file.

use std::fmt;

/// Maximum magnitude of any number of a robot file: products of four such numbers stay far inside the range of `f64`.
pub const MAX_MAGNITUDE: f64 = 1e12;

/// Minimum of a quantity that has to be positive, so that quotients stay inside the range of `f64`, too.
pub const MIN_POSITIVE: f64 = 1e-12;

/// Range of the values that a parameter may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Any number, up to 1e12 in magnitude.
    Any,
    /// Zero, or from 1e-12 to 1e12.
    NotNegative,
    /// From 1e-12 to 1e12.
    Positive,
    /// Zero, or from 1e-12 to below a limit.
    Below(f64),
    /// From 1e-12 to a limit.
    UpTo(f64),
    /// Component of a vector whose magnitude is at most this.
    Magnitude(f64),
}

impl Range {
    /// Minimum. For a component of a vector with limited magnitude: the minimum if the other components are zero.
    pub fn minimum(self) -> f64 {
        match self {
            Self::Any => -MAX_MAGNITUDE,
            Self::NotNegative | Self::Below(_) => 0.0,
            Self::Positive | Self::UpTo(_) => MIN_POSITIVE,
            Self::Magnitude(limit) => -limit,
        }
    }

    /// Maximum, or the limit that a number has to stay below.
    pub fn maximum(self) -> f64 {
        match self {
            Self::Any | Self::NotNegative | Self::Positive => MAX_MAGNITUDE,
            Self::Below(limit) | Self::UpTo(limit) | Self::Magnitude(limit) => limit,
        }
    }

    /// True if negative numbers and zero are out of range.
    pub(super) fn is_positive(self) -> bool {
        matches!(self, Self::Positive | Self::UpTo(_))
    }

    /// True if zero is the minimum.
    pub(super) fn is_not_negative(self) -> bool {
        matches!(self, Self::NotNegative | Self::Below(_))
    }

    /// True if negative numbers, and positive numbers below 1e-12, are out of range.
    pub(super) fn is_one_sided(self) -> bool {
        self.is_positive() || self.is_not_negative()
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => f.write_str("any"),
            Self::NotNegative => f.write_str("not negative"),
            Self::Positive => f.write_str("positive"),
            Self::Below(limit) => write!(f, "from 0 to below {limit}"),
            Self::UpTo(limit) => write!(f, "above 0, at most {limit}"),
            Self::Magnitude(limit) => write!(f, "magnitude of the vector up to {limit}"),
        }
    }
}
