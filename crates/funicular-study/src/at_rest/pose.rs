//! Poses that a platform can have.

use anyhow::Result;
use funicular::robot::{PlatformMotion, Pose, Robot};
use thiserror::Error;

/// Orientation that is given to a point mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("a point mass has no orientation: give x,y,z without angles")]
pub struct OrientationOfPointMass;

/// Refuses a pose that turns a point mass.
///
/// # Errors
/// [`OrientationOfPointMass`].
pub fn refuse_orientation(is_point_mass: bool, pose: &Pose) -> Result<(), OrientationOfPointMass> {
    if is_point_mass && pose.rot_wp.angle() != 0.0 { Err(OrientationOfPointMass) } else { Ok(()) }
}

/// Refuses a pose that the platform cannot have for any cables.
///
/// # Errors
/// An orientation of a point mass, or a pose out of the plane of a planar platform.
pub fn check_pose(robot: &Robot, pose: &Pose) -> Result<()> {
    let motion = &robot.platform.motion;
    refuse_orientation(*motion == PlatformMotion::PointMass, pose)?;
    Ok(motion.check(pose)?)
}
