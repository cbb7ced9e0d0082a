//! Course of a motion over time within limits of speed, acceleration and jerk.

use super::{PathError, Profile};

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
    /// Seven phases of constant jerk, the fastest course within the limits.
    #[default]
    JerkLimited,
    /// Polynomial of the fifth degree: no acceleration at both ends.
    Quintic,
}

impl CourseForm {
    /// All forms.
    pub const ALL: [Self; 2] = [Self::JerkLimited, Self::Quintic];

    /// Name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::JerkLimited => "jerk-limited",
            Self::Quintic => "quintic",
        }
    }
}

/// Course from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Course {
    JerkLimited(Profile),
    Quintic { duration: f64 },
}

/// Largest rate, and magnitudes of its first and second derivative, of the quintic course in the time 1: at τ = 1/2, at
/// τ = 1/2 ± √3/6, at τ = 0.
const QUINTIC_PEAKS: [f64; 3] = [1.875, 5.773_502_691_896_258, 60.0];

impl Course {
    /// Fastest course of a motion by this way of the origin [m] and this angle [rad] within limits.
    ///
    /// # Errors
    /// [`PathError::NoLimit`].
    pub(super) fn within(limits: &MotionLimits, form: CourseForm, way: f64, turn: f64) -> Result<Self, PathError> {
        let straight = [limits.speed / way, limits.acceleration / way, limits.jerk / way];
        let turning = [limits.angular_speed / turn, limits.angular_acceleration / turn, limits.angular_jerk / turn];
        for (part, of, given) in [(way, "translation", straight), (turn, "turn", turning)] {
            if part > 0.0 && !(given[0].is_finite() && given[1].is_finite()) {
                return Err(PathError::NoLimit { of });
            }
        }

        let [rate, acceleration, jerk] = std::array::from_fn(|k| straight[k].min(turning[k]));
        Ok(match form {
            CourseForm::JerkLimited => Self::JerkLimited(Profile::limited(rate, acceleration, jerk)),
            CourseForm::Quintic => {
                let [of_rate, of_acceleration, of_jerk] = QUINTIC_PEAKS;
                let times = [of_rate / rate, (of_acceleration / acceleration).sqrt(), (of_jerk / jerk).cbrt()];
                Self::Quintic { duration: times.into_iter().fold(0.0, f64::max) }
            }
        })
    }

    pub(super) fn duration(&self) -> f64 {
        match self {
            Self::JerkLimited(profile) => profile.duration(),
            Self::Quintic { duration } => *duration,
        }
    }

    /// The course with all times multiplied by a positive factor.
    pub(super) fn slowed(&self, factor: f64) -> Self {
        match self {
            Self::JerkLimited(profile) => Self::JerkLimited(profile.slowed(factor)),
            Self::Quintic { duration } => Self::Quintic { duration: duration * factor },
        }
    }

    /// Time in which it slows down at its end [s].
    pub(super) fn slowing(&self) -> f64 {
        match self {
            Self::JerkLimited(profile) => profile.slowing(),
            Self::Quintic { duration } => 0.5 * duration,
        }
    }

    /// Times at which the jerk jumps [s].
    pub(super) fn corner_times(&self) -> Vec<f64> {
        match self {
            Self::JerkLimited(profile) => profile.corner_times().collect(),
            Self::Quintic { duration } => vec![0.0, *duration],
        }
    }

    /// Part that is done at a time [s], with three derivatives.
    pub(super) fn at(&self, time: f64) -> [f64; 4] {
        match self {
            Self::JerkLimited(profile) => std::array::from_fn(|order| profile.derivative(time, order)),
            Self::Quintic { duration } => {
                let tau = time / duration;
                if tau <= 0.0 || tau >= 1.0 {
                    return [f64::from(u8::from(tau >= 1.0)), 0.0, 0.0, 0.0];
                }
                let left = 1.0 - tau;
                [
                    tau.powi(3) * (10.0 - tau * (15.0 - 6.0 * tau)),
                    30.0 * (tau * left).powi(2) / duration,
                    60.0 * tau * left * (1.0 - 2.0 * tau) / duration.powi(2),
                    (60.0 - 360.0 * tau * left) / duration.powi(3),
                ]
            }
        }
    }
}
