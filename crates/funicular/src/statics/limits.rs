//! Limits of a cable's tension: their defaults, and the distance of a state from them.

use super::equilibrium::CableState;
use super::missing_wrench::MissingWrench;
use super::obstacle::Obstacle;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::robot::{Robot, TensionLimits};
use std::fmt;

/// Default minimum tension as a multiple of the cable's weight, used if the file gives none. A level cable then sags by
/// a twentieth of its chord, which is the limit of shallow-sag models ([`crate::cable::SHALLOW_SAG_LIMIT`]).
const TAUT: f64 = 2.5;

/// Default minimum tension as a fraction of the platform's weight, used if the file gives none. It keeps cables without
/// weight from being slack.
const PART_OF_PLATFORM: f64 = 1e-3;

/// Source of a cable's minimum tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MinimumTension {
    /// Number of the robot file [N].
    Given(f64),
    /// Default: a multiple of the cable's load per length times its chord.
    OfCable { factor: f64 },
    /// Default: a fraction of the platform's weight.
    OfPlatform { factor: f64 },
}

impl MinimumTension {
    /// Multiples of the cable's load and of the platform's weight; the larger of both is the default.
    pub(crate) const DEFAULT_FACTORS: [f64; 2] = [TAUT, PART_OF_PLATFORM];

    /// Source of the minimum of cable `i` with this chord: of the two defaults the larger one.
    pub(crate) fn of(robot: &Robot, i: usize, chord_w: &Vec3) -> Self {
        Self::with_limits(robot, i, robot.cables[i].limits(), chord_w)
    }

    /// Source of the minimum of a cable with other limits than those of the robot.
    fn with_limits(robot: &Robot, i: usize, limits: TensionLimits, chord_w: &Vec3) -> Self {
        if let Some(value) = limits.minimum {
            return Self::Given(value);
        }
        let taut = TAUT * robot.line_load(i, chord_w).size * chord_w.norm();
        if taut >= PART_OF_PLATFORM * robot.platform.mass * robot.gravity_w.norm() {
            Self::OfCable { factor: TAUT }
        } else {
            Self::OfPlatform { factor: PART_OF_PLATFORM }
        }
    }
}

/// Tension range of a cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TensionRange {
    /// Minimum tension anywhere in the cable [N].
    pub minimum: f64,
    /// Maximum tension anywhere in the cable [N]; infinite if the file gives neither a maximum nor a breaking load.
    pub maximum: f64,
}

impl TensionRange {
    /// Limits of cable `i` with this chord, platform to anchor, world axes [m].
    ///
    /// The default of `minimum_tension_n` is the larger of 2.5 times the weight (and other load) of the chord and a
    /// thousandth of the platform's weight; the default of `maximum_tension_n` is the rope's breaking load.
    ///
    /// # Example
    /// ```
    /// # use funicular::{math::Vec3, robot::Robot, statics::TensionRange};
    /// # let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let range = TensionRange::of(&robot, 0, &Vec3::new(4.11, 0.0, 5.48)); // 6.85 m long
    /// assert!((range.minimum - 2.5 * 0.067 * 9.81 * 6.85).abs() < 1e-12); // N
    /// assert_eq!(range.maximum, f64::INFINITY);
    /// # Ok::<(), funicular::robot::spec::SpecError>(())
    /// ```
    pub fn of(robot: &Robot, i: usize, chord_w: &Vec3) -> Self {
        Self::with_limits(robot, i, robot.cables[i].limits(), chord_w)
    }

    /// Limits of a cable for which others are given than those of the robot.
    pub(crate) fn with_limits(robot: &Robot, i: usize, limits: TensionLimits, chord_w: &Vec3) -> Self {
        let minimum = match MinimumTension::with_limits(robot, i, limits, chord_w) {
            MinimumTension::Given(value) => value,
            MinimumTension::OfCable { factor } => factor * robot.line_load(i, chord_w).size * chord_w.norm(),
            MinimumTension::OfPlatform { factor } => factor * robot.platform.mass * robot.gravity_w.norm(),
        };
        Self { minimum, maximum: limits.maximum.unwrap_or(f64::INFINITY) }
    }

    /// Distances of a cable's tensions from these limits.
    pub fn margin(&self, state: &CableState) -> TensionMargin {
        if let Some(span) = &state.hanging {
            return self.margin_of_span(span, state.tension_drum());
        }
        TensionMargin { range: *self, min: state.tension_platform, max: state.tension_anchor }
    }

    /// Distances of the tensions in a free span and at its drum [N] from these limits.
    pub(crate) fn margin_of_span(&self, span: &HangingCable, drum: f64) -> TensionMargin {
        let (min, max) = (span.catenary.min_tension().min(drum), span.catenary.max_tension().max(drum));
        TensionMargin { range: *self, min, max }
    }
}

/// Tensions of a cable compared with their limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TensionMargin {
    /// Limits.
    pub range: TensionRange,
    /// Minimum tension anywhere in the cable [N].
    pub min: f64,
    /// Maximum tension anywhere in the cable [N].
    pub max: f64,
}

/// Lower or upper limit of a tension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Minimum tension.
    Minimum,
    /// Maximum tension.
    Maximum,
}

impl Limit {
    /// Name in files: `minimum` or `maximum`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Minimum => "minimum",
            Self::Maximum => "maximum",
        }
    }
}

/// Relative distance within which a limit counts as reached.
const REACHED: f64 = 1e-6;

/// Rounding of a margin over the tension. The search for tensions ends when a step changes them by less than 1e-10 of
/// their size (`CONVERGED` in `tension/search.rs`), which bounds it. Observed at robots of the library and others: up
/// to 1e-14. A violation that matters, see [`REACHED`], is four decades larger.
const MARGIN_ROUNDING: f64 = 1e-10;

impl TensionMargin {
    /// Distance from the nearer limit [N], negative beyond it. A tension that is beyond its limit by rounding alone has
    /// the distance zero.
    pub fn distance(&self) -> f64 {
        let distance = (self.min - self.range.minimum).min(self.range.maximum - self.max);
        let rounding = MARGIN_ROUNDING * self.max.abs();
        if (-rounding..0.0).contains(&distance) { 0.0 } else { distance }
    }

    /// Relative margin: [`Self::distance`] over the distance between the limits; at most one half, negative beyond a
    /// limit; `None` without a maximum.
    pub fn relative(&self) -> Option<f64> {
        let breadth = self.range.maximum - self.range.minimum;
        (breadth > 0.0 && breadth.is_finite()).then(|| self.distance() / breadth)
    }

    /// Limit that is reached or exceeded, within a millionth.
    pub fn reached(&self) -> Option<Limit> {
        if self.min <= self.range.minimum * (1.0 + REACHED) {
            Some(Limit::Minimum)
        } else if self.max >= self.range.maximum * (1.0 - REACHED) {
            Some(Limit::Maximum)
        } else {
            None
        }
    }
}

/// Maximum number of cables that a message names.
const MAX_NAMES: usize = 8;

/// Violation of the limits by the best tensions, and the limits concerned.
///
/// The best tensions are those with the minimum violation. A limit is named if every set of best tensions violates it
/// by the full amount `by`: it stays in the way whichever of them is chosen. So a symmetric robot names all cables that
/// symmetry makes alike. These limits are also those whose value the amount depends on (Goldman and Tucker 1956).
#[derive(Debug, Clone, PartialEq)]
pub struct LimitViolation {
    /// Minimum force [N] by which all limits would have to be widened for a solution within them to exist.
    pub by: f64,
    /// Cables whose minimum prevents a solution.
    pub minimum_of: Vec<String>,
    /// Cables whose maximum prevents a solution.
    pub maximum_of: Vec<String>,
    /// Reason why no tensions of straight cables balance the platform even without limits, if there is one.
    pub obstacle: Option<Box<Obstacle>>,
    /// Proof that no tensions within the limits balance the platform: the wrench that they leave; `None` without one.
    pub missing: Option<Box<MissingWrench>>,
}

impl fmt::Display for LimitViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |what: &str, names: &[String]| {
            let first: Vec<String> = names.iter().take(MAX_NAMES).map(|name| format!("\"{name}\"")).collect();
            let more = match names.len().saturating_sub(MAX_NAMES) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let plural = if names.len() == 1 { "" } else { "s" };
            (!names.is_empty()).then(|| format!("the {what} of cable{plural} {}{more}", first.join(", ")))
        };
        let limits = [list("minimum", &self.minimum_of), list("maximum", &self.maximum_of)];
        let limits: Vec<String> = limits.into_iter().flatten().collect();
        write!(f, "by {:.4} N", self.by)?;
        if !limits.is_empty() {
            write!(f, ", because of {}", limits.join(" and "))?;
        }
        self.missing.as_ref().map_or(Ok(()), |missing| write!(f, "; {missing}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_of_rounding_is_zero_and_a_real_violation_is_not() {
        let margin =
            |min: f64, max: f64| TensionMargin { range: TensionRange { minimum: 50.0, maximum: 2000.0 }, min, max };
        // Rows of maps have had -1e-13 to -2e-12 N.
        for rounding in [1e-13, 2e-12, 1e-9] {
            assert!(margin(50.0 - rounding, 300.0).distance().to_bits() == 0);
            assert!(margin(60.0, 2000.0 + rounding).distance().to_bits() == 0);
            assert_eq!(margin(50.0 - rounding, 300.0).relative(), Some(0.0));
        }
        assert!((margin(50.0 - 1e-5, 300.0).distance() + 1e-5).abs() < 1e-12);
        assert!((margin(60.0, 2000.0 + 1e-5).distance() + 1e-5).abs() < 1e-12);
        // Distances within the limits stay as they are.
        assert!(margin(50.0 + 1e-9, 300.0).distance() > 0.0);
    }
}
