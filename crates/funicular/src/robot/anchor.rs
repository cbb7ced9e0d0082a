//! Anchor end of a cable: the point at which the cable leaves its carrier, and the cable length beyond that point.
//!
//! The analyses ask an anchor three questions and never which kind it is: where the cable leaves it towards the
//! platform ([`Anchor::exit_w`]), how much of a straight cable lies beyond that point ([`Anchor::length_beyond`]), and
//! which point of the world the robot file names ([`Anchor::reference_w`]). The first two depend on the cable's end at
//! the platform: a pulley turns towards it, and the cable wraps around the pulley. A fixed point answers with
//! constants.
//!
//! The length of a straight cable, [`Cable::straight_length`](super::Cable::straight_length), changes with the
//! attachment by the unit vector along the free span. This holds for every anchor that the cable leaves tangentially,
//! so lever arms and unit wrenches follow from the chord alone.

use crate::math::Vec3;

/// Anchor end of a cable. World axes, metres.
///
/// # Example
/// ```
/// use funicular::{math::Vec3, robot::Anchor};
///
/// let anchor = Anchor::Fixed { point_w: Vec3::new(0.0, 0.0, 3.0) };
/// let attachment_w = Vec3::new(1.0, 0.0, 0.0);
/// assert_eq!(anchor.exit_w(&attachment_w), Vec3::new(0.0, 0.0, 3.0)); // m
/// assert_eq!(anchor.length_beyond(&attachment_w), 0.0); // m
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    /// Fixed point, whatever the direction of the cable: an eye, or a pulley of negligible size.
    Fixed {
        /// The point [m].
        point_w: Vec3,
    },
}

impl Anchor {
    /// Point of the world that the robot file names as `anchor_m` [m].
    #[inline]
    pub fn reference_w(&self) -> Vec3 {
        match self {
            Self::Fixed { point_w } => *point_w,
        }
    }

    /// Point at which the free span of the cable begins if the cable ends at `_attachment_w` on the platform [m].
    #[inline]
    pub fn exit_w(&self, _attachment_w: &Vec3) -> Vec3 {
        match self {
            Self::Fixed { point_w } => *point_w,
        }
    }

    /// Length of a straight, unstrained cable between the exit point and the point from which unstrained lengths are
    /// counted, if the cable ends at `_attachment_w` on the platform [m]. Zero for a fixed point.
    #[inline]
    pub fn length_beyond(&self, _attachment_w: &Vec3) -> f64 {
        match self {
            Self::Fixed { .. } => 0.0,
        }
    }

    /// The anchor after a rotation of the world about its origin.
    #[must_use]
    pub fn rotated(&self, rotation: &crate::math::Rotation) -> Self {
        match self {
            Self::Fixed { point_w } => Self::Fixed { point_w: rotation * point_w },
        }
    }
}

impl From<Vec3> for Anchor {
    /// A fixed point.
    fn from(point_w: Vec3) -> Self {
        Self::Fixed { point_w }
    }
}
