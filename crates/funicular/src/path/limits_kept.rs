//! Parts of the limits of speed, acceleration and jerk that a motion uses, and their largest values over time.

use super::course::MotionLimits;
use super::{PathPoint, Side, parts};

/// Number of parts of every phase at whose ends the motion is looked at, before the largest value is narrowed down. A
/// phase of a course is a polynomial; on a circle it may pass several turns.
const LOOKS: usize = 96;

/// Number of narrowings by the golden ratio: 0.618³² is 2e-7 of two parts, which leaves 1e-13 of a smooth peak.
const NARROWINGS: usize = 32;

/// Excess of a limit that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Used parts of the limits of the translation and of the turn, the larger one of each derivative; 1 is all.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct UsedParts {
    /// Part of the speeds.
    pub speed: f64,
    /// Part of the accelerations.
    pub acceleration: f64,
    /// Part of the jerks.
    pub jerk: f64,
}

impl UsedParts {
    /// True if no limit is exceeded.
    pub fn are_kept(&self) -> bool {
        self.numbers().iter().all(|part| *part <= 1.0 + ROUNDING)
    }

    /// Factor of the time with which all limits are kept, at least one.
    pub(super) fn time_factor(&self) -> f64 {
        self.speed.max(self.acceleration.sqrt()).max(self.jerk.cbrt()).max(1.0)
    }

    pub(super) fn larger(&self, other: &Self) -> Self {
        Self {
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
        }
    }

    fn numbers(&self) -> [f64; 3] {
        [self.speed, self.acceleration, self.jerk]
    }
}

impl MotionLimits {
    /// Parts of the limits that a motion uses.
    pub fn used_by(&self, point: &PathPoint) -> UsedParts {
        let part = |of: &crate::math::Vec6, linear: f64, angular: f64| {
            let [translation, rotation] = parts(of).map(|part| part.norm());
            (translation / linear).max(rotation / angular)
        };
        UsedParts {
            speed: part(&point.velocity_w, self.speed, self.angular_speed),
            acceleration: part(&point.acceleration_w, self.acceleration, self.angular_acceleration),
            jerk: part(&point.jerk_w, self.jerk, self.angular_jerk),
        }
    }

    /// Limits of acceleration and jerk divided by what a motion uses of them, if that is more than all.
    pub(super) fn lowered(&self, used: &UsedParts) -> Self {
        let (acceleration, jerk) = (used.acceleration.max(1.0), used.jerk.max(1.0));
        Self {
            acceleration: self.acceleration / acceleration,
            angular_acceleration: self.angular_acceleration / acceleration,
            jerk: self.jerk / jerk,
            angular_jerk: self.angular_jerk / jerk,
            ..*self
        }
    }
}

/// Largest used parts over the time between the first and the last corner: both sides of every corner, and the peaks
/// between them.
pub(super) fn largest(corners: &[f64], used: impl Fn(f64, Side) -> UsedParts) -> UsedParts {
    let mut found = UsedParts::default();
    for pair in corners.windows(2) {
        let step = (pair[1] - pair[0]) / LOOKS as f64;
        let side = |k: usize| if k == LOOKS { Side::Before } else { Side::After };
        let looks: Vec<UsedParts> = (0..=LOOKS).map(|k| used(pair[0] + step * k as f64, side(k))).collect();
        let peaks: [f64; 3] = std::array::from_fn(|of| {
            let part = |k: &usize| looks[*k].numbers()[of];
            let best = (0..=LOOKS).max_by(|a, b| part(a).total_cmp(&part(b))).unwrap_or(0);
            if best == 0 || best == LOOKS {
                return part(&best);
            }
            let middle = pair[0] + step * best as f64;
            peak([middle - step, middle + step], |time| used(time, Side::After).numbers()[of]).max(part(&best))
        });
        let [speed, acceleration, jerk] = peaks;
        found = found.larger(&UsedParts { speed, acceleration, jerk });
    }
    found
}

/// Largest value of a function with one peak in an interval.
fn peak([mut from, mut to]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    for _ in 0..NARROWINGS {
        let (low, high) = (to - GOLDEN * (to - from), from + GOLDEN * (to - from));
        if value(low) > value(high) { to = high } else { from = low }
    }
    value(0.5 * (from + to))
}
