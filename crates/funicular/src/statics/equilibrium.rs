//! An equilibrium as plain data: pose, cables, residual, stability.

use super::model::StaticModel;
use crate::catenary::space::HangingCable;
use crate::math::{Mat3, Vec3};
use crate::robot::Pose;

/// One cable at equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct CableState {
    /// Attachment in the world [m].
    pub attachment_w: Vec3,
    /// Lever arm from the platform origin to the attachment, world axes [m].
    pub lever_w: Vec3,
    /// Point at which the cable leaves its anchor, in the world [m].
    pub anchor_w: Vec3,
    /// Unstrained length [m]; of an ideal cable its length.
    pub unstrained_length: f64,
    /// Force of the cable on the platform, world axes [N].
    pub force_on_platform_w: Vec3,
    /// Tension at the platform end [N].
    pub tension_platform: f64,
    /// Tension at the anchor [N].
    pub tension_anchor: f64,
    /// The curve; none for an ideal cable.
    pub hanging: Option<HangingCable>,
}

impl CableState {
    /// Chord, attachment to anchor, world axes [m].
    pub fn chord_w(&self) -> Vec3 {
        self.anchor_w - self.attachment_w
    }

    /// Length of the chord [m].
    pub fn chord(&self) -> f64 {
        self.chord_w().norm()
    }

    /// Static stiffness of the platform end, 3×3, world axes [N/m]; none for an ideal cable.
    pub fn tangent_w(&self) -> Option<Mat3> {
        self.hanging.as_ref().map(HangingCable::tangent_w)
    }

    /// No force between the ends: a massless cable longer than its chord, or one that hangs straight down as a loop.
    pub fn is_slack(&self) -> bool {
        let no_force = |h: &HangingCable| h.catenary.parallel_tension() <= 0.0;
        self.hanging.as_ref().map_or(self.tension_platform == 0.0, no_force)
    }
}

/// A static equilibrium of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Pose of the platform.
    pub pose: Pose,
    /// The model it was found with.
    pub model: StaticModel,
    /// The cables, in file order.
    pub cables: Vec<CableState>,
    /// What is left of the wrench: the larger of force and moment/ℓ over the sum of all tensions and the weight. Zero
    /// where no load acts and all tensions together are rounding, see [`carries_nothing`].
    pub residual: f64,
    /// Iterations taken.
    pub iterations: usize,
    /// Whether it is stable.
    pub stability: Stability,
}

/// What the static stiffness says of an equilibrium: the signs of the eigenvalues of its symmetric part, which is the work
/// that a small displacement takes. In wind it is the symmetric part of [`tangent_with_drag`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// Every small displacement is opposed; the least eigenvalue of the scaled stiffness S K S [N/m].
    Stable {
        /// Least eigenvalue [N/m].
        min_stiffness: f64,
    },
    /// Some displacement is not opposed.
    Unstable {
        /// Least eigenvalue [N/m]; negative, or exactly zero where it is rounding: then the equilibrium is indifferent.
        min_stiffness: f64,
        /// Number of directions that are not opposed.
        directions: usize,
    },
    /// An ideal robot is rigid; the question does not arise.
    Rigid,
}

/// Scaled residual below which an equilibrium counts as found; rounding leaves 1e-15 to 1e-12.
pub const RESIDUAL_LIMIT: f64 = 1e-10;

/// Largest scaled residual that rounding excuses. Very stiff cables under a very small load have a residual that no pose
/// in floating point brings below [`RESIDUAL_LIMIT`]; up to this one the tensions are right to six digits, which is more
/// than any input has. Beyond it rounding would soon be all there is, and the place no more than a guess.
pub const MAX_RESIDUAL_OF_ROUNDING: f64 = 1e-6;
