//! Flexible support of anchors: a post, a mast or a part of the frame that yields to the cables.
//!
//! All anchors on one support move together, by one displacement e ∈ R³. The points of a robot file are those without
//! forces of cables: at rest the support yields to them (docs/theory.md, section 18).

use super::{Anchor, Robot};
use crate::math::{Mat3, Vec3};

/// Flexible support of one or more anchors.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// Name in the robot file.
    pub name: String,
    /// Stiffness against a displacement of its anchors, world axes, symmetric and positive definite [N/m].
    pub stiffness_w: Mat3,
    /// Mass that moves with its anchors [kg]; zero for a spring.
    pub mass: f64,
    /// Damping ratio of the support alone: its stiffness in vibration is `(1 + 2iζ)` times that at rest.
    pub damping_ratio: f64,
    /// Place of the drums of its cables.
    pub drum: DrumPlace,
}

/// Place of the drums of cables whose anchors are on a support.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DrumPlace {
    /// The drums move with the support.
    #[default]
    OnSupport,
    /// The drums stay where they are, so that a motion of the support stretches the drum sides.
    OnGround,
}

impl DrumPlace {
    /// Name in a robot file.
    pub fn name(self) -> &'static str {
        match self {
            Self::OnSupport => "on-support",
            Self::OnGround => "on-ground",
        }
    }

    /// Values in a robot file with their meanings.
    pub(super) const WORDS: &[(&str, &str)] = &[
        ("on-support", "the drums move with the support"),
        ("on-ground", "the drums stay where they are: a motion of the support stretches the drum sides"),
    ];
}

impl Support {
    /// Direction of the drum side of an anchor on this support, at its entry point towards the platform, if the drum is
    /// on the ground; unit vector, world axes. `None` if the drum moves with the support: without a pulley the file
    /// does not say where the drum side comes from.
    pub(crate) fn drum_side_from_ground(&self, anchor: &Anchor) -> Option<Vec3> {
        let from_ground = self.drum == DrumPlace::OnGround && anchor.drum_side_length() > 0.0;
        anchor.pulley.as_ref().filter(|_| from_ground).map(|pulley| pulley.entry_direction_w)
    }
}

impl Robot {
    /// Robot with rigid anchors at the displaced positions. `displacements_w` is the displacement of each support [m,
    /// world axes]. It moves the anchors and, for drums on the ground, changes the lengths of the drum sides.
    #[must_use]
    pub(crate) fn displaced(&self, displacements_w: &[Vec3]) -> Self {
        let mut robot = self.clone();
        for cable in &mut robot.cables {
            let Some(support) = cable.anchor.support.take() else { continue };
            cable.anchor.displace(&self.supports[support], &displacements_w[support]);
        }
        robot
    }

    /// True if the far end of a cable may move in vibration: over a pulley, to a winch or on a flexible support. Also
    /// true for a robot whose supports are held.
    pub(crate) fn has_moving_ends(&self) -> bool {
        !self.supports.is_empty() || self.cables.iter().any(|cable| !cable.anchor.is_fixed())
    }

    /// True if an anchor is on a support that yields.
    pub fn has_supports(&self) -> bool {
        self.cables.iter().any(|cable| cable.anchor.support.is_some())
    }
}

impl Anchor {
    /// Moves the anchor with its support.
    pub(crate) fn displace(&mut self, support: &Support, displacement_w: &Vec3) {
        self.point_w += displacement_w;
        let from_ground = support.drum_side_from_ground(self);
        if let (Some(direction_w), Some(winch)) = (from_ground, &mut self.winch) {
            winch.drum_side_length = (direction_w * winch.drum_side_length + displacement_w).norm();
        }
    }
}
