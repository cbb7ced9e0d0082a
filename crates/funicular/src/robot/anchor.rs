//! Anchor end of a cable: the point at which the cable leaves the frame of the robot, and the drive behind it.
//!
//! A cable runs drum → entry point → wheel of the pulley → exit point → attachment on the platform. The analyses ask an
//! anchor where a straight cable leaves it towards the platform ([`Anchor::exit_w`]), how much of a straight cable lies
//! beyond that point ([`Anchor::length_beyond`]), and which point of the world the robot file names
//! ([`Anchor::reference_w`]). The first two depend on the cable's end at the platform: a pulley turns towards it, and
//! the cable wraps around the pulley. Where the cable sags or stretches, [`crate::drive`] finds its exit point.
//!
//! The length of a straight cable, [`Cable::straight_length`](super::Cable::straight_length), changes with the
//! attachment by the unit vector along the free span. This holds for every anchor that the cable leaves tangentially,
//! so lever arms and unit wrenches follow from the chord alone.

use super::pulley::{Pulley, PulleyContact};
use super::winch::Winch;
use crate::math::{Rotation, Vec3};

/// Anchor end of a cable. World axes, metres.
///
/// # Example
/// ```
/// use funicular::{math::Vec3, robot::Anchor};
///
/// let anchor = Anchor::from(Vec3::new(0.0, 0.0, 3.0));
/// let attachment_w = Vec3::new(1.0, 0.0, 0.0);
/// assert_eq!(anchor.exit_w(&attachment_w), Vec3::new(0.0, 0.0, 3.0)); // m
/// assert_eq!(anchor.length_beyond(&attachment_w), 0.0); // m
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Anchor {
    /// Point at which the cable leaves the frame [m]. With a pulley: the entry point, at which the cable coming from
    /// the drum touches the wheel.
    pub point_w: Vec3,
    /// Swivelling pulley at this point; without it the cable turns about the point itself.
    pub pulley: Option<Pulley>,
    /// Winch behind this point; without it the cable ends here, or on a rigid drum beside it.
    pub winch: Option<Winch>,
    /// Index of the flexible support that carries this anchor, in [`Robot::supports`](super::Robot::supports); `None`
    /// for a rigid frame. The point is then its place without forces.
    pub support: Option<usize>,
}

impl Anchor {
    /// Point of the world that the robot file names as `anchor_m` [m].
    #[inline]
    pub fn reference_w(&self) -> Vec3 {
        self.point_w
    }

    /// True for a fixed end of the cable, without a pulley and without a winch.
    #[inline]
    pub fn is_fixed(&self) -> bool {
        self.pulley.is_none() && self.winch.is_none()
    }

    /// Place of a straight cable on the pulley if the cable ends at `attachment_w` on the platform; `None` without a
    /// pulley.
    pub fn contact(&self, attachment_w: &Vec3) -> Option<PulleyContact> {
        self.pulley.as_ref().map(|pulley| pulley.contact(&(attachment_w - self.point_w)))
    }

    /// Point at which the free span of a straight cable begins if the cable ends at `attachment_w` on the platform [m].
    #[inline]
    pub fn exit_w(&self, attachment_w: &Vec3) -> Vec3 {
        match self.contact(attachment_w) {
            None => self.point_w,
            Some(contact) => self.point_w + contact.exit_offset_w(),
        }
    }

    /// Length of a straight, unstrained cable between the exit point and the point from which unstrained lengths are
    /// counted, if the cable ends at `attachment_w` on the platform [m]: the arc on the wheel and the length between
    /// entry point and drum. Zero for a fixed point.
    #[inline]
    pub fn length_beyond(&self, attachment_w: &Vec3) -> f64 {
        if self.is_fixed() {
            return 0.0;
        }
        self.contact(attachment_w).map_or(0.0, |contact| contact.arc()) + self.drum_side_length()
    }

    /// Length from the drum to the entry point [m]; zero without a winch.
    pub fn drum_side_length(&self) -> f64 {
        self.winch.as_ref().map_or(0.0, |winch| winch.drum_side_length)
    }

    /// The anchor after a rotation of the world about its origin.
    #[must_use]
    pub fn rotated(&self, rotation: &Rotation) -> Self {
        let mut turned = self.clone();
        turned.point_w = rotation * self.point_w;
        if let Some(pulley) = &mut turned.pulley {
            pulley.entry_direction_w = rotation * pulley.entry_direction_w;
        }
        turned
    }
}

impl From<Vec3> for Anchor {
    /// A fixed point: an eye, or a pulley of negligible size.
    fn from(point_w: Vec3) -> Self {
        Self { point_w, pulley: None, winch: None, support: None }
    }
}
