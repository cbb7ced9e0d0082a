//! Reason why no tensions balance the platform at a pose, whatever their limits: a direction in which no cable pulls.
//!
//! Straight cables balance the load if it lies in the cone of their unit wrenches. If it does not, Farkas' lemma gives
//! a direction y in which no cable pulls and the load has to be balanced: `y·w_i ≤ 0` for every cable and `y·e < 0` for
//! the load, (39d). Of all such directions this one leaves the largest part of the load unbalanced.

use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use crate::math::active_set::Polyhedron;
use crate::math::{Vec3, Vec6};
use crate::platform::{Coordinates, StraightCable, load_wrench, wrench_of};
use crate::robot::{Pose, Robot};
use std::fmt;

/// Reason why no tensions of straight cables balance the platform at a pose, whatever the limits of the tensions.
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// No cable pulls against the force on the platform.
    OneSided {
        /// Force on the platform besides that of the cables, with half of their weight, world axes [N]; without the
        /// components that a guide carries.
        force_w: Vec3,
        /// Likely cause.
        cause: OneSidedCause,
    },
    /// No combination of pulling cables balances the load.
    NotSpanned {
        /// Motion that no cable pulls the platform along: its translation. Together with `rotation_w` of length 1.
        translation_w: Vec3,
        /// Rotation of this motion, times ℓ ([`Robot::platform_length`]).
        rotation_w: Vec3,
        /// Share of the load that the best combination of tensions leaves unbalanced, 0 to 1.
        unbalanced: f64,
        /// Names of the cables that come nearest to pulling along this motion: at a right angle to it, or nearly.
        nearest: Vec<String>,
        /// Names of the cables that pull most against this motion: they would have to push.
        opposed: Vec<String>,
    },
}

/// Likely cause of cables that all pull with the load.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OneSidedCause {
    /// Gravity has a positive z component.
    GravityUp,
    /// The attachments are farther from each other than the anchors.
    EndsSwapped,
    /// The load on the platform acts against gravity and is larger than the weight.
    LoadLifts,
    /// The attachments are above the anchors.
    AboveAnchors,
    /// The load acts sideways, and the anchors are on the same side.
    SameSide,
}

/// Cosine of the angle between a chord and the direction against the load below which a cable does not count as pulling
/// against the load: rounding of unit vectors.
const LEVEL: f64 = 1e-12;

/// Cosine of the angle between the load and gravity below which the load counts as sideways, 60°.
const SIDEWAYS: f64 = 0.5;

/// Share of the load that has to stay unbalanced; less is rounding. The directions of cables have an error of 1e-16,
/// and a pose whose balance has a condition number above 1e10 is refused as singular.
const MIN_UNBALANCED: f64 = 1e-9;

/// Difference of the cosines between cables and a motion below which they count as equal: printed digits of symmetric
/// robots have 1e-3.
const SAME_COSINE: f64 = 1e-3;

/// Maximum number of cables that a message names.
const MAX_NAMED: usize = 3;

/// Component of a direction over the largest one, above which it is named too: two axes at 45° have 1, an axis within
/// 27° of a direction stands for it alone.
const NAMED_COMPONENT: f64 = 0.5;

/// Component of a unit vector above which it is along the axis to the printed digits, and not mostly.
const ALONG_AXIS: f64 = 0.9995;

/// Share of a motion below which its translation or its rotation is left out of a message.
const MINOR: f64 = 0.05;

impl Obstacle {
    /// Obstacle at a pose; `None` if straight cables can balance the load with tensions that are large enough, or
    /// without any load.
    pub(super) fn at(robot: &Robot, pose: &Pose, model: StaticModel) -> Option<Self> {
        let coordinates = Coordinates::of(robot);

        // Load, with half of each cable's weight.
        let mut load = load_wrench(robot, pose);
        let mut wrenches: Vec<Vec6> = Vec::with_capacity(robot.cables.len());
        for cable in LoadedCable::all(robot, pose, model) {
            let line = StraightCable::at(cable.cable, pose);
            load += wrench_of(&(cable.load.vector_w() * (0.5 * line.chord_w.norm())), &line.lever_w);
            wrenches.push(line.unit_wrench(&coordinates));
        }

        let reduced = coordinates.reduce(&load);
        let size = reduced.norm();
        if size == 0.0 || !size.is_finite() {
            return None;
        }
        one_sided(robot, pose, &load).or_else(|| not_spanned(robot, &coordinates, &wrenches, &(reduced / size)))
    }
}

/// Obstacle of cables that all pull with the force on the platform.
fn one_sided(robot: &Robot, pose: &Pose, load: &Vec6) -> Option<Obstacle> {
    let force = robot.platform.motion.allowed(load);
    let force_w = Vec3::new(force[0], force[1], force[2]);
    let along = force_w.try_normalize(0.0)?;
    let pulls = |chord_w: Vec3| -along.dot(&chord_w) > LEVEL * chord_w.norm();
    if robot.cables.iter().any(|cable| pulls(cable.chord_w(pose))) {
        return None;
    }

    let downward = -robot.up_w().dot(&along);
    let cause = if robot.gravity_w.norm() == 0.0 || downward.abs() < SIDEWAYS {
        OneSidedCause::SameSide
    } else if downward < 0.0 {
        OneSidedCause::LoadLifts
    } else if robot.gravity_w.z > 0.0 {
        OneSidedCause::GravityUp
    } else if spread(robot.cables.iter().map(|cable| cable.attachment_p))
        > spread(robot.cables.iter().map(|cable| cable.anchor.reference_w()))
    {
        OneSidedCause::EndsSwapped
    } else {
        OneSidedCause::AboveAnchors
    };
    Some(Obstacle::OneSided { force_w, cause })
}

/// Maximum distance of points from their mean [m].
pub(crate) fn spread(points: impl Iterator<Item = Vec3> + Clone) -> f64 {
    let count = points.clone().count().max(1) as f64;
    let mean = points.clone().sum::<Vec3>() / count;
    points.fold(0.0, |most: f64, point| most.max((point - mean).norm()))
}

/// Obstacle of a load outside the cone of the unit wrenches; all of them reduced, the load of length 1.
fn not_spanned(robot: &Robot, coordinates: &Coordinates, wrenches: &[Vec6], load: &Vec6) -> Option<Obstacle> {
    // The shortest y with y·w_i ≤ 0 and y·e ≤ −1 is along the unbalanced part of the load, and its length is
    // the inverse of that part.
    let n = coordinates.count();
    let mut sides = Polyhedron::new(n);
    for wrench in wrenches {
        sides.add(wrench.iter().take(n), -1.0, None, 0.0);
    }
    sides.add(load.iter().take(n), -1.0, None, 1.0);
    let mut found = [0.0; 6];
    sides.nearest(&mut found[..n], MIN_UNBALANCED)?;

    let y = Vec6::from(found);
    let unbalanced = 1.0 / y.norm();
    if unbalanced.is_nan() || unbalanced < MIN_UNBALANCED {
        return None;
    }
    let along = y.normalize();
    let (nearest, opposed) = nearest_and_opposed(robot, wrenches, &along);
    let motion = coordinates.expand(&along);
    Some(Obstacle::NotSpanned {
        translation_w: motion.fixed_rows::<3>(0).into(),
        rotation_w: motion.fixed_rows::<3>(3).into(),
        unbalanced: unbalanced.min(1.0),
        nearest,
        opposed,
    })
}

/// Names of the cables that come nearest to pulling along a motion of length 1, and of those that pull most against it.
/// If all cables are at the same angle to it, they are the nearest.
fn nearest_and_opposed(robot: &Robot, wrenches: &[Vec6], along: &Vec6) -> (Vec<String>, Vec<String>) {
    let cosine = |wrench: &Vec6| if wrench.norm() > 0.0 { along.dot(wrench) / wrench.norm() } else { 0.0 };
    let cosines: Vec<f64> = wrenches.iter().map(cosine).collect();
    let (most, least) =
        cosines.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(most, least), of| (of.max(most), of.min(least)));

    let named = |is_chosen: &dyn Fn(f64) -> bool| -> Vec<String> {
        let chosen = robot.cables.iter().zip(&cosines).filter(|(_, cosine)| is_chosen(**cosine));
        chosen.map(|(cable, _)| cable.name.clone()).collect()
    };
    let nearest = named(&|cosine| cosine > most - SAME_COSINE);
    let opposed = if most - least > SAME_COSINE && least < -SAME_COSINE {
        named(&|cosine| cosine < least + SAME_COSINE)
    } else {
        Vec::new()
    };
    (nearest, opposed)
}

impl Obstacle {
    /// Advice for a message about this obstacle.
    pub(super) fn advice(&self) -> &'static str {
        match self {
            Self::OneSided { cause: OneSidedCause::GravityUp, .. } => "check the sign of `gravity_m_s2`",
            Self::OneSided { cause: OneSidedCause::EndsSwapped, .. } => {
                "check whether `anchor_m` and `attachment_m` are swapped"
            }
            Self::OneSided { cause: OneSidedCause::LoadLifts, .. } => "check the sign of `force_n`",
            Self::OneSided { cause: OneSidedCause::SameSide, .. } => "choose a pose between the anchors",
            Self::OneSided { cause: OneSidedCause::AboveAnchors, .. } => {
                "choose a pose below the anchors, or check the signs of z"
            }
            Self::NotSpanned { .. } => "choose another pose, or attach a cable that pulls there",
        }
    }
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OneSided { force_w, cause } => {
                let cause = match cause {
                    OneSidedCause::GravityUp => {
                        "`gravity_m_s2` points up, along +z, and the platform is on the wrong side of its anchors"
                    }
                    OneSidedCause::EndsSwapped => "the attachments are farther from each other than the anchors",
                    OneSidedCause::LoadLifts => "the load lifts the platform, and all cables pull up",
                    OneSidedCause::SameSide => "all anchors are on the side to which the load acts",
                    OneSidedCause::AboveAnchors => "all cables pull down, because no anchor is above its attachment",
                };
                let along = direction(&force_w.normalize());
                write!(f, "no cable pulls against the load of {:.4} N along {along}: {cause}", force_w.norm())
            }
            Self::NotSpanned { translation_w, rotation_w, unbalanced, nearest, opposed } => {
                let [translation, rotation] = [translation_w, rotation_w].map(Vec3::norm);
                let motion = if rotation < MINOR {
                    format!("pull the platform along {}", in_words(&translation_w.normalize()))
                } else if translation < MINOR {
                    format!("turn the platform about {}", in_words(&rotation_w.normalize()))
                } else {
                    format!(
                        "pull the platform along {} while it turns about {}",
                        in_words(translation_w),
                        in_words(rotation_w)
                    )
                };
                write!(f, "no cable can {motion}: {:.2} % of the load cannot be balanced", 100.0 * unbalanced)?;
                match (nearest.is_empty(), opposed.is_empty()) {
                    (true, _) => Ok(()),
                    (false, true) => write!(f, "; {} nearest to it", cables(nearest, "comes", "come")),
                    (false, false) => write!(
                        f,
                        "; {} nearest to it, and {} to push",
                        cables(nearest, "comes", "come"),
                        cables(opposed, "would have", "would have")
                    ),
                }
            }
        }
    }
}

/// Vector for a message, with the axes that it is near to: `(-0.443, 0.012, 0.101) (mostly -x)`.
pub(super) fn in_words(vector: &Vec3) -> String {
    let size = vector.norm();
    let largest = vector.amax();
    let mut axes: Vec<(f64, String)> = vector
        .iter()
        .zip(["x", "y", "z"])
        .filter(|(part, _)| part.abs() > NAMED_COMPONENT * largest)
        .map(|(part, axis)| (part.abs(), format!("{}{axis}", if *part < 0.0 { '-' } else { '+' })))
        .collect();
    axes.sort_by(|(one, _), (other, _)| other.total_cmp(one));

    let mostly = if largest > ALONG_AXIS * size { "" } else { "mostly " };
    let names: Vec<String> = axes.into_iter().map(|(_, name)| name).collect();
    format!("{} ({mostly}{})", direction(vector), names.join(", "))
}

/// Cables by their names, with a verb: `cable "1" comes`, `cables "1", "2" come`.
fn cables(names: &[String], one: &str, several: &str) -> String {
    let shown: Vec<String> = names.iter().take(MAX_NAMED).map(|name| format!("\"{name}\"")).collect();
    let more = if names.len() > MAX_NAMED { ", …" } else { "" };
    let (noun, verb) = if names.len() == 1 { ("cable", one) } else { ("cables", several) };
    format!("{noun} {}{more} {verb}", shown.join(", "))
}

/// Vector with three decimals for a message.
pub(super) fn direction(vector: &Vec3) -> String {
    // Adding zero turns -0.000 into 0.000.
    let part = |value: f64| (1e3 * value).round() / 1e3 + 0.0;
    format!("({:.3}, {:.3}, {:.3})", part(vector.x), part(vector.y), part(vector.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_said_in_words_too() {
        for (vector, words) in [
            ([-0.9, 0.1, 0.2], "(-0.900, 0.100, 0.200) (mostly -x)"),
            ([0.0, 0.6, 0.0], "(0.000, 0.600, 0.000) (+y)"),
            ([0.492, 0.0, 0.589], "(0.492, 0.000, 0.589) (mostly +z, +x)"),
        ] {
            assert_eq!(in_words(&Vec3::from(vector)), words);
        }
    }

    #[test]
    fn a_message_names_the_cables_that_come_nearest_and_those_that_would_have_to_push() {
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let of = |nearest: &[&str], opposed: &[&str]| Obstacle::NotSpanned {
            translation_w: -Vec3::x(),
            rotation_w: Vec3::zeros(),
            unbalanced: 0.25,
            nearest: names(nearest),
            opposed: names(opposed),
        };
        assert_eq!(
            of(&["1", "2"], &["5"]).to_string(),
            "no cable can pull the platform along (-1.000, 0.000, 0.000) (-x): 25.00 % of the load cannot be \
             balanced; cables \"1\", \"2\" come nearest to it, and cable \"5\" would have to push"
        );
        assert!(of(&["1"], &[]).to_string().ends_with("; cable \"1\" comes nearest to it"));
        assert!(of(&["1", "2", "3", "4"], &[]).to_string().contains("cables \"1\", \"2\", \"3\", … come nearest"));
    }
}
