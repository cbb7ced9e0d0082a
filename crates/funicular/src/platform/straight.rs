//! Straight line of a cable at a pose.

use super::coordinates::Coordinates;
use crate::math::{Vec3, Vec6};
use crate::robot::{Cable, Pose};

/// Straight line from the platform to the anchor's exit point, with its lever arm, world axes [m].
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightCable {
    /// Lever arm from the platform origin to the attachment.
    pub(crate) lever_w: Vec3,
    /// Attachment to exit point. Computed from the lever arm, so its rounding differs from [`Cable::chord_w`].
    pub(crate) chord_w: Vec3,
}

impl StraightCable {
    /// Line of a cable at a pose.
    #[inline]
    pub(crate) fn at(cable: &Cable, pose: &Pose) -> Self {
        let lever_w = pose.rot_wp * cable.attachment_p;
        let exit_w = cable.anchor.exit_w(&(pose.position_w + lever_w));
        Self { lever_w, chord_w: exit_w - pose.position_w - lever_w }
    }

    /// Reduced wrench of a unit tension; the ends must not coincide.
    #[inline]
    pub(crate) fn unit_wrench(&self, coordinates: &Coordinates) -> Vec6 {
        coordinates.reduce_force(&self.chord_w.normalize(), &self.lever_w)
    }
}
