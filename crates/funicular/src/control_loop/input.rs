//! Input of a call: motion of the platform and external load.

use super::state::LoopFault;
use crate::math::{Quaternion, Rotation, Vec3, Vec6};
use crate::path::PathPoint;
use crate::robot::{Pose, Robot};

/// Maximum size of a number of the input, in its unit: far beyond any robot, and far below the numbers at which squares
/// overflow.
pub const MAX_INPUT: f64 = 1e9;

/// Maximum distance of the length of a quaternion from one: more is not rounding of a program, but another quantity.
pub const MAX_QUATERNION_ERROR: f64 = 1e-3;

/// Motion of the platform, and external load on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopInput {
    /// Pose, velocity and acceleration; the jerk counts in the rates of lengths over a path.
    pub motion: PathPoint,
    /// External force on the platform at its origin, world axes [N], besides the load of the robot file.
    pub force_w: Vec3,
    /// External moment about that origin, world axes [N m].
    pub moment_w: Vec3,
}

impl LoopInput {
    /// Platform at rest without external load.
    pub fn at_rest(pose: &Pose) -> Self {
        Self::moving(PathPoint::at_rest(pose))
    }

    /// Platform in motion without external load.
    pub fn moving(motion: PathPoint) -> Self {
        Self { motion, force_w: Vec3::zeros(), moment_w: Vec3::zeros() }
    }

    /// External wrench on the platform about its origin.
    pub(super) fn wrench(&self) -> Vec6 {
        let (f, m) = (&self.force_w, &self.moment_w);
        Vec6::new(f.x, f.y, f.z, m.x, m.y, m.z)
    }

    /// Refuses numbers that are not finite or too large, and poses that the platform cannot have.
    pub(super) fn check(&self, robot: &Robot) -> Result<(), LoopFault> {
        let motion = &self.motion;
        let rotation = motion.pose.rot_wp.coords;
        let rates = motion.velocity_w.iter().chain(&motion.acceleration_w).chain(&motion.jerk_w);
        let places = motion.pose.position_w.iter().chain(&rotation);
        let mut numbers = places.chain(rates).chain(&self.force_w).chain(&self.moment_w);
        if !numbers.all(|number| number.abs() <= MAX_INPUT) {
            return Err(LoopFault::BadInput);
        }
        check_pose(robot, &motion.pose)
    }
}

/// Refuses poses that the platform cannot have, or at which a cable has no direction.
pub(super) fn check_pose(robot: &Robot, pose: &Pose) -> Result<(), LoopFault> {
    if robot.platform.motion.check(pose).is_err() {
        return Err(LoopFault::ImpossiblePose);
    }
    for (i, cable) in robot.cables.iter().enumerate() {
        if crate::statics::distance_inside_pulley(cable, pose).is_some() {
            return Err(LoopFault::InsidePulley { cable: i });
        }
        if cable.chord_w(pose).norm() == 0.0 {
            return Err(LoopFault::ImpossiblePose);
        }
    }
    Ok(())
}

/// Pose from a position [m] and a quaternion (w, x, y, z) of either sign; `None` if a number is not finite or larger
/// than [`MAX_INPUT`], or the length of the quaternion differs from one by more than [`MAX_QUATERNION_ERROR`].
///
/// # Example
/// ```
/// use funicular::control_loop::pose_from_quaternion;
///
/// let half = std::f64::consts::FRAC_1_SQRT_2;
/// let pose = pose_from_quaternion([0.0, 0.0, 1.0], [half, 0.0, 0.0, half]).unwrap();
/// assert!((pose.rot_wp.scaled_axis().z - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// assert!(pose_from_quaternion([0.0; 3], [0.0; 4]).is_none());
/// ```
pub fn pose_from_quaternion(position_w: [f64; 3], quaternion_wxyz: [f64; 4]) -> Option<Pose> {
    if !position_w.iter().chain(&quaternion_wxyz).all(|number| number.abs() <= MAX_INPUT) {
        return None;
    }
    let [w, x, y, z] = quaternion_wxyz;
    let quaternion = Quaternion::new(w, x, y, z);
    let is_rotation = (quaternion.norm() - 1.0).abs() <= MAX_QUATERNION_ERROR;
    is_rotation.then(|| Pose { position_w: Vec3::from(position_w), rot_wp: Rotation::from_quaternion(quaternion) })
}
