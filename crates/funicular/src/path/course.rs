//! Course of a motion over time within limits of speed, acceleration and jerk.

use super::profile::SAME_CORNER;
use super::{PathError, Profile, Side};

/// Limits of the motion of the platform. Infinite by default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Speed of the origin [m/s].
    pub speed: f64,
    /// Magnitude of its acceleration [m/s²].
    pub acceleration: f64,
    /// Magnitude of the rate of its acceleration [m/s³].
    pub jerk: f64,
    /// Magnitude of the angular velocity [rad/s].
    pub angular_speed: f64,
    /// Magnitude of the angular acceleration [rad/s²].
    pub angular_acceleration: f64,
    /// Magnitude of its rate [rad/s³].
    pub angular_jerk: f64,
}

impl Default for MotionLimits {
    fn default() -> Self {
        let none = f64::INFINITY;
        Self {
            speed: none,
            acceleration: none,
            jerk: none,
            angular_speed: none,
            angular_acceleration: none,
            angular_jerk: none,
        }
    }
}

/// Form of a course from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CourseForm {
    /// Fifteen phases in which the jerk is constant, rises or falls in a straight line: it nowhere jumps. The rates of
    /// the lengths of cables are then continuous.
    #[default]
    ContinuousJerk,
    /// Seven phases of constant jerk, the fastest course within the limits.
    JerkLimited,
    /// Polynomial of the fifth degree: no acceleration at both ends, where the jerk jumps.
    Quintic,
    /// Polynomial of the seventh degree: neither acceleration nor jerk at both ends.
    Septic,
}

impl CourseForm {
    /// All forms.
    pub const ALL: [Self; 4] = [Self::ContinuousJerk, Self::JerkLimited, Self::Quintic, Self::Septic];

    /// Name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::ContinuousJerk => "continuous-jerk",
            Self::JerkLimited => "jerk-limited",
            Self::Quintic => "quintic",
            Self::Septic => "septic",
        }
    }

    /// True if a duration alone gives the course: a polynomial.
    pub fn is_polynomial(self) -> bool {
        matches!(self, Self::Quintic | Self::Septic)
    }
}

/// Course from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Course {
    Phases(Profile),
    Polynomial { degree: Degree, duration: f64 },
}

/// Polynomial from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Degree {
    /// `τ³(10 − 15τ + 6τ²)`.
    Five,
    /// `τ⁴(35 − 84τ + 70τ² − 20τ³)`.
    Seven,
}

impl Degree {
    /// Largest rate, and magnitudes of its first and second derivative, in the time 1.
    ///
    /// Fifth degree: at τ = 1/2, at τ = 1/2 ± √3/6, at both ends. Seventh: at τ = 1/2, at τ = 1/2 ± √5/10, at τ = 1/2.
    fn peaks(self) -> [f64; 3] {
        match self {
            Self::Five => [1.875, 5.773_502_691_896_258, 60.0],
            Self::Seven => [2.1875, 7.513_188_404_399_293, 52.5],
        }
    }

    /// Derivative that jumps at both ends.
    fn order_of_corners(self) -> usize {
        match self {
            Self::Five => 3,
            Self::Seven => 4,
        }
    }

    /// Value and three derivatives at τ from 0 to 1.
    fn at(self, tau: f64) -> [f64; 4] {
        let left = 1.0 - tau;
        let both = tau * left;
        match self {
            Self::Five => [
                tau.powi(3) * (10.0 - tau * (15.0 - 6.0 * tau)),
                30.0 * both.powi(2),
                60.0 * both * (1.0 - 2.0 * tau),
                60.0 - 360.0 * both,
            ],
            Self::Seven => [
                tau.powi(4) * (35.0 - tau * (84.0 - tau * (70.0 - 20.0 * tau))),
                140.0 * both.powi(3),
                420.0 * both.powi(2) * (1.0 - 2.0 * tau),
                840.0 * both * (1.0 - 5.0 * both),
            ],
        }
    }
}

impl Course {
    /// Fastest course of a motion by this way of the origin [m] and this angle [rad] within limits.
    ///
    /// # Errors
    /// [`PathError::NoLimit`].
    pub(super) fn within(limits: &MotionLimits, form: CourseForm, way: f64, turn: f64) -> Result<Self, PathError> {
        let straight = [limits.speed / way, limits.acceleration / way, limits.jerk / way];
        let turning = [limits.angular_speed / turn, limits.angular_acceleration / turn, limits.angular_jerk / turn];
        for (part, of, given) in [(way, "translation", straight), (turn, "turn", turning)] {
            // The time of a polynomial follows from any one limit.
            let is_limited = if form.is_polynomial() {
                given.iter().any(|limit| limit.is_finite())
            } else {
                given[0].is_finite() && given[1].is_finite()
            };
            if part > 0.0 && !is_limited {
                return Err(PathError::NoLimit { of });
            }
        }

        let [rate, acceleration, jerk] = std::array::from_fn(|k| straight[k].min(turning[k]));
        let polynomial = |degree: Degree| {
            let [of_rate, of_acceleration, of_jerk] = degree.peaks();
            let times = [of_rate / rate, (of_acceleration / acceleration).sqrt(), (of_jerk / jerk).cbrt()];
            Self::Polynomial { degree, duration: times.into_iter().fold(0.0, f64::max) }
        };
        Ok(match form {
            CourseForm::ContinuousJerk => Self::Phases(Profile::continuous_jerk(rate, acceleration, jerk)),
            CourseForm::JerkLimited => Self::Phases(Profile::limited(rate, acceleration, jerk)),
            CourseForm::Quintic => polynomial(Degree::Five),
            CourseForm::Septic => polynomial(Degree::Seven),
        })
    }

    pub(super) fn duration(&self) -> f64 {
        match self {
            Self::Phases(profile) => profile.duration(),
            Self::Polynomial { duration, .. } => *duration,
        }
    }

    /// The course with all times multiplied by a positive factor.
    pub(super) fn slowed(&self, factor: f64) -> Self {
        match self {
            Self::Phases(profile) => Self::Phases(profile.slowed(factor)),
            Self::Polynomial { degree, duration } => Self::Polynomial { degree: *degree, duration: duration * factor },
        }
    }

    /// Time in which it slows down at its end, at most half of its duration [s].
    pub(super) fn slowing(&self) -> f64 {
        match self {
            Self::Phases(profile) => profile.slowing().min(0.5 * profile.duration()),
            Self::Polynomial { duration, .. } => 0.5 * duration,
        }
    }

    /// Times at which a derivative jumps [s], ascending, with the order of this derivative.
    pub(super) fn corners(&self) -> Vec<(f64, usize)> {
        let (times, order) = match self {
            Self::Phases(profile) => (profile.corner_times(), profile.order_of_corners()),
            Self::Polynomial { degree, duration } => (vec![0.0, *duration], degree.order_of_corners()),
        };
        times.into_iter().map(|time| (time, order)).collect()
    }

    /// Part that is done just before or just after a time [s], with three derivatives.
    pub(super) fn at(&self, time: f64, side: Side) -> [f64; 4] {
        match self {
            Self::Phases(profile) => profile.beside(time, side),
            Self::Polynomial { degree, duration } => {
                let tau = time / duration;
                let is_on = |end: f64| (tau - end).abs() <= SAME_CORNER;
                let is_before = tau <= 0.0 || is_on(0.0);
                let is_beyond = tau >= 1.0 || is_on(1.0);
                match (is_before, is_beyond, side) {
                    (true, _, Side::After) if is_on(0.0) => {}
                    (_, true, Side::Before) if is_on(1.0) => {}
                    (true, ..) => return [0.0; 4],
                    (_, true, _) => return [1.0, 0.0, 0.0, 0.0],
                    (false, false, _) => {}
                }
                let [done, rate, second, third] = degree.at(tau.clamp(0.0, 1.0));
                [done, rate / duration, second / duration.powi(2), third / duration.powi(3)]
            }
        }
    }
}
