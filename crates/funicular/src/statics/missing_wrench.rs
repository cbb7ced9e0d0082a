//! Wrench that cables within their limits cannot apply, which proves that they do not hold the platform.

use super::obstacle::in_words;
use crate::math::Vec3;
use std::fmt;

/// Part of the balance that no tensions within the limits can provide: a proof that there are none, (39a).
///
/// Every cable takes the tension within its limits that pulls most along the direction. Even so the sum of all cables
/// and of the load points against it, by [`Self::size`]. Tensions that balance the platform would make it zero.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingWrench {
    /// Direction of the missing force, world axes. Together with [`Self::moment_w`] of length 1.
    pub force_w: Vec3,
    /// Direction of the missing moment, world axes, over [`Robot::platform_length`](crate::robot::Robot).
    pub moment_w: Vec3,
    /// Least size of the missing wrench along that direction [N]; moments count over the length of the platform.
    pub size: f64,
    /// Length of the platform, by which moments are divided [m].
    pub length: f64,
    /// Names of the cables that pull most along the direction at their minima.
    pub minimum_of: Vec<String>,
    /// Names of the cables that pull most along it at their maxima.
    pub maximum_of: Vec<String>,
    /// True if the proof holds the exit points of the pulleys at one place; they move by little with the tensions.
    pub holds_exits: bool,
}

/// Share of a direction below which its force or its moment is left out of a message.
const MINOR: f64 = 0.05;

/// Maximum number of cables that a message names; robots have up to 8.
const MAX_NAMED: usize = 8;

impl fmt::Display for MissingWrench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |limit: &str, names: &[String]| {
            let first: Vec<String> = names.iter().take(MAX_NAMED).map(|name| format!("\"{name}\"")).collect();
            let more = if names.len() > MAX_NAMED { ", …" } else { "" };
            let plural = if names.len() == 1 { "" } else { "s" };
            (!names.is_empty()).then(|| format!("cable{plural} {}{more} at the {limit}", first.join(", ")))
        };
        let states: Vec<String> =
            [list("maximum", &self.maximum_of), list("minimum", &self.minimum_of)].into_iter().flatten().collect();
        let wrench = if self.moment_w.norm() < MINOR {
            format!("{:.4} N along {}", self.size, in_words(&self.force_w))
        } else if self.force_w.norm() < MINOR {
            format!("{:.4} N m about {}", self.size * self.length, in_words(&self.moment_w))
        } else {
            let (force_w, moment_w) = (self.force_w * self.size, self.moment_w * (self.size * self.length));
            format!("a force of {} N with a moment of {} N m", in_words(&force_w), in_words(&moment_w))
        };
        let held = if self.holds_exits { ", the exit points on the pulleys held" } else { "" };
        write!(f, "proof{held}: even with {} {wrench} are missing", states.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proof_names_the_missing_force_or_moment_and_the_limits() {
        let of = |force_w: Vec3, moment_w: Vec3| MissingWrench {
            force_w,
            moment_w,
            size: 17.25,
            length: 2.0,
            minimum_of: vec!["3".to_owned()],
            maximum_of: vec!["1".to_owned(), "2".to_owned()],
            holds_exits: false,
        };
        assert_eq!(
            of(Vec3::z(), Vec3::zeros()).to_string(),
            "proof: even with cables \"1\", \"2\" at the maximum and cable \"3\" at the minimum 17.2500 N along \
             (0.000, 0.000, 1.000) (+z) are missing"
        );
        assert!(of(Vec3::zeros(), -Vec3::x()).to_string().contains("34.5000 N m about (-1.000, 0.000, 0.000) (-x)"));
        let both = of(Vec3::x() * 0.6, Vec3::y() * 0.8).to_string();
        assert!(
            both.contains("a force of (10.350, 0.000, 0.000) (+x) N with a moment of (0.000, 27.600, 0.000)"),
            "{both}"
        );
    }
}
