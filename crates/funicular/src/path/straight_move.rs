//! Straight moves between two poses.

use crate::math::{Rotation, Vec3};
use crate::robot::Pose;

/// Turn [rad] that is the rounding of equal orientations.
const NO_TURN: f64 = 1e-13;

/// Move along a straight line with one turn about a fixed axis, both in proportion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightMove {
    from: Pose,
    /// Translation [m], world axes.
    pub(crate) translation_w: Vec3,
    /// Rotation vector [rad], world axes.
    pub(crate) turn_w: Vec3,
}

impl StraightMove {
    /// Move from one pose to another by the shorter turn.
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let turn_w = (to.rot_wp * from.rot_wp.inverse()).scaled_axis();
        let turn_w = if turn_w.norm() > NO_TURN { turn_w } else { Vec3::zeros() };
        Self { from: *from, translation_w: to.position_w - from.position_w, turn_w }
    }

    /// Pose at a fraction of the move.
    pub fn pose(&self, fraction: f64) -> Pose {
        Pose {
            position_w: self.from.position_w + self.translation_w * fraction,
            rot_wp: Rotation::from_scaled_axis(self.turn_w * fraction) * self.from.rot_wp,
        }
    }

    /// Bound of the way of a point of the platform at a distance from its origin, over the fraction [m].
    pub(crate) fn way(&self, lever: f64) -> f64 {
        self.translation_w.norm() + self.turn_w.norm() * lever
    }
}
