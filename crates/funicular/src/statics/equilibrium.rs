//! Equilibrium as plain data: pose, cables, residual, stability.

use super::model::StaticModel;
use crate::catenary::space::HangingCable;
use crate::drive::{self, DriveAtRest};
use crate::math::{Mat3, Vec3};
use crate::robot::Pose;

/// State of one cable at equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct CableState {
    /// Attachment in the world [m].
    pub attachment_w: Vec3,
    /// Lever arm from the platform origin to the attachment, world axes [m].
    pub lever_w: Vec3,
    /// Point at which the cable leaves its anchor, with a pulley the exit point, in the world [m].
    pub anchor_w: Vec3,
    /// Unstrained length [m], from the attachment to the anchor or, with a winch, to the drum; for an ideal cable its
    /// length.
    pub unstrained_length: f64,
    /// Force of the cable on the platform, world axes [N].
    pub force_on_platform_w: Vec3,
    /// Tension at the platform end [N].
    pub tension_platform: f64,
    /// Tension at the anchor, with a pulley at the exit point [N].
    pub tension_anchor: f64,
    /// Curve of the free span; none for an ideal cable.
    pub hanging: Option<HangingCable>,
    /// State of pulley, drum side and winch; none for a fixed anchor and for an ideal cable.
    pub drive: Option<Box<DriveAtRest>>,
    /// Displacement of the anchor with its flexible support, world axes [m]; zero on a rigid frame.
    pub displacement_w: Vec3,
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

    /// Unstrained length of the free span [m]: without arc and drum side.
    pub fn free_length(&self) -> f64 {
        self.hanging.as_ref().map_or(self.unstrained_length, |hanging| hanging.catenary.rope().unstrained_length)
    }

    /// Tension at the drum [N]; that at the anchor without a drive.
    pub fn tension_drum(&self) -> f64 {
        self.drive.as_ref().map_or(self.tension_anchor, |drive| drive.tension_drum)
    }

    /// Static stiffness of the platform end, 3×3, world axes [N/m]; none for an ideal cable.
    pub fn tangent_w(&self) -> Option<Mat3> {
        self.hanging.as_ref().map(|span| drive::tangent_w(span, self.drive.as_deref()))
    }

    /// Derivative of the force on the platform with respect to the unstrained length, world axes [N/m]; none for an
    /// ideal cable.
    pub fn force_by_length_w(&self) -> Option<Vec3> {
        self.hanging.as_ref().map(|span| drive::force_by_length_w(span, self.drive.as_deref()))
    }

    /// True if the cable carries no force between its ends: a massless cable longer than its chord, or one that hangs
    /// straight down as a loop.
    pub fn is_slack(&self) -> bool {
        let no_force = |h: &HangingCable| h.catenary.parallel_tension() <= 0.0;
        self.hanging.as_ref().map_or(self.tension_platform == 0.0, no_force)
    }
}

/// Static equilibrium of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Pose of the platform.
    pub pose: Pose,
    /// Static model of the cables.
    pub model: StaticModel,
    /// The cables, in file order.
    pub cables: Vec<CableState>,
    /// Scaled residual: the larger of remaining force and moment/ℓ, over the sum of all tensions and the weight. Zero
    /// if no load acts and all tensions together are rounding, see [`is_unloaded`].
    pub residual: f64,
    /// Number of iterations.
    pub iterations: usize,
    /// Stability.
    pub stability: Stability,
}

/// Stability of an equilibrium by the signs of the eigenvalues of the static stiffness' symmetric part, which gives the
/// work of a small displacement. In wind it is the symmetric part of [`tangent_with_drag`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// Every small displacement meets resistance; with the minimum eigenvalue of the scaled stiffness S K S [N/m].
    Stable {
        /// Minimum eigenvalue [N/m].
        min_stiffness: f64,
    },
    /// Some displacement meets no resistance.
    Unstable {
        /// Minimum eigenvalue [N/m]; negative, or exactly zero if it is rounding: then the equilibrium is indifferent.
        min_stiffness: f64,
        /// Number of directions without resistance.
        directions: usize,
    },
    /// A robot with ideal cables is rigid; stability has no meaning for it.
    Rigid,
}

/// Scaled residual below which an equilibrium counts as found; rounding leaves 1e-15 to 1e-12.
pub const RESIDUAL_LIMIT: f64 = 1e-10;

/// Maximum scaled residual accepted because of rounding. Very stiff cables under a very small load have a residual that
/// no pose in floating point brings below [`RESIDUAL_LIMIT`]. Up to this value the tensions are right to six digits,
/// more than any input has. Beyond it nearly everything would be rounding, and the pose no more than a guess.
pub const MAX_RESIDUAL_OF_ROUNDING: f64 = 1e-6;
