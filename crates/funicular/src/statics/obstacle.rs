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
#[derive(Debug, Clone, Copy, PartialEq)]
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
        one_sided(robot, pose, &load).or_else(|| not_spanned(&coordinates, &wrenches, &(reduced / size)))
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
fn not_spanned(coordinates: &Coordinates, wrenches: &[Vec6], load: &Vec6) -> Option<Obstacle> {
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
    let motion = coordinates.expand(&y.normalize());
    Some(Obstacle::NotSpanned {
        translation_w: motion.fixed_rows::<3>(0).into(),
        rotation_w: motion.fixed_rows::<3>(3).into(),
        unbalanced: unbalanced.min(1.0),
    })
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
            Self::NotSpanned { translation_w, rotation_w, unbalanced } => {
                let [translation, rotation] = [translation_w, rotation_w].map(Vec3::norm);
                let motion = if rotation < MINOR {
                    format!("pull the platform along {}", direction(&translation_w.normalize()))
                } else if translation < MINOR {
                    format!("turn the platform about {}", direction(&rotation_w.normalize()))
                } else {
                    format!(
                        "pull the platform along {} while it turns about {}",
                        direction(translation_w),
                        direction(rotation_w)
                    )
                };
                write!(f, "no cable can {motion}, so that {:.2} % of the load stay unbalanced", 100.0 * unbalanced)
            }
        }
    }
}

/// Vector with three decimals for a message.
pub(super) fn direction(vector: &Vec3) -> String {
    // Adding zero turns -0.000 into 0.000.
    let part = |value: f64| (1e3 * value).round() / 1e3 + 0.0;
    format!("({:.3}, {:.3}, {:.3})", part(vector.x), part(vector.y), part(vector.z))
}
