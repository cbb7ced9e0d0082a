//! Coordinates of the platform: its degrees of freedom, and the length ℓ that gives translations and rotations the same
//! unit.

use super::wrench::wrench_of;
use crate::math::{Mat6, Vec3, Vec6, symmetric_part};
use crate::robot::{PlatformMotion, Pose, Robot};

/// Motion of a platform and its length ℓ, [`Robot::platform_length`].
///
/// Scaled quantities have one unit throughout: moments are divided by ℓ, rotations multiplied by ℓ. Reduced quantities
/// are scaled and given in the coordinates of the platform's degrees of freedom, zero beyond their number
/// ([`PlatformMotion::reduced`]).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinates {
    motion: PlatformMotion,
    ell: f64,
}

impl Coordinates {
    /// Coordinates of a robot's platform.
    pub(crate) fn of(robot: &Robot) -> Self {
        Self { motion: robot.platform.motion, ell: robot.platform_length() }
    }

    /// Motion of the platform.
    pub(crate) fn motion(&self) -> PlatformMotion {
        self.motion
    }

    /// Number of degrees of freedom.
    pub(crate) fn count(&self) -> usize {
        self.motion.count()
    }

    /// Length ℓ [m].
    pub(crate) fn ell(&self) -> f64 {
        self.ell
    }

    /// Larger of force and moment/ℓ of a wrench [N]; components that the platform cannot follow do not count.
    #[inline]
    pub(crate) fn wrench_size(&self, wrench: &Vec6) -> f64 {
        let wrench = self.motion.allowed(wrench);
        wrench.fixed_rows::<3>(0).norm().max(wrench.fixed_rows::<3>(3).norm() / self.ell)
    }

    /// Reduced wrench of a wrench (N, N m).
    #[inline]
    pub(crate) fn reduce(&self, wrench: &Vec6) -> Vec6 {
        let scaled = Vec6::from_fn(|i, _| if i < 3 { wrench[i] } else { wrench[i] / self.ell });
        self.motion.reduced(&scaled)
    }

    /// Reduced wrench of a force at a lever arm [m].
    #[inline]
    pub(crate) fn reduce_force(&self, force: &Vec3, lever: &Vec3) -> Vec6 {
        self.motion.reduced(&wrench_of(force, &(lever / self.ell)))
    }

    /// Scaled motion or wrench of six components with these reduced coordinates.
    #[inline]
    pub(crate) fn expand(&self, reduced: &Vec6) -> Vec6 {
        self.motion.expanded(reduced)
    }

    /// Scaled matrix `S M S` with `S = diag(1, 1, 1, 1/ℓ, 1/ℓ, 1/ℓ)`.
    #[inline]
    pub(crate) fn scale_matrix(&self, matrix: &Mat6) -> Mat6 {
        let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / self.ell };
        Mat6::from_fn(|i, j| matrix[(i, j)] * scale(i) * scale(j))
    }

    /// Reduced matrix of a matrix over motions.
    #[inline]
    pub(crate) fn reduce_matrix(&self, matrix: &Mat6) -> Mat6 {
        self.motion.reduced_matrix(&self.scale_matrix(matrix))
    }

    /// Reduced matrix of the symmetric part of a matrix over motions.
    #[inline]
    pub(crate) fn reduce_symmetric(&self, matrix: &Mat6) -> Mat6 {
        self.reduce_matrix(&symmetric_part(matrix))
    }

    /// Projection of an unscaled matrix over motions on the motions that the platform has; zero for the others.
    pub(crate) fn allowed_matrix(&self, matrix: &Mat6) -> Mat6 {
        self.motion.expanded_matrix(&self.motion.reduced_matrix(matrix))
    }

    /// Translation [m] and rotation [rad] of a small reduced motion.
    #[inline]
    pub(crate) fn translation_and_rotation(&self, step: &Vec6) -> [Vec3; 2] {
        let step = self.expand(step);
        [Vec3::new(step[0], step[1], step[2]), Vec3::new(step[3], step[4], step[5]) / self.ell]
    }

    /// Pose after a small reduced motion: translations in metres, rotations times ℓ.
    #[inline]
    pub(crate) fn moved(&self, pose: &Pose, step: &Vec6) -> Pose {
        let [translation, rotation] = self.translation_and_rotation(step);
        pose.moved(&translation, &rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Plane;
    use proptest::prelude::*;

    fn all(ell: f64) -> [Coordinates; 3] {
        let plane = Plane::new(Vec3::new(1.0, -2.0, 0.5), 0.0).unwrap();
        [PlatformMotion::Rigid, PlatformMotion::PointMass, PlatformMotion::Planar(plane)]
            .map(|motion| Coordinates { motion, ell })
    }

    proptest! {
        /// Work does not depend on the coordinates in which it is computed: the wrench times the motion in metres and
        /// radians, and the reduced wrench times the step that made the motion.
        #[test]
        fn reduced_wrenches_do_the_work_of_wrenches_along_a_move(
            wrench in prop::array::uniform6(-1.0_f64..1.0),
            step in prop::array::uniform6(-1.0_f64..1.0),
            ell in 0.1_f64..10.0,
        ) {
            let (wrench, pose) = (Vec6::from(wrench), Pose::new([0.3, -0.2, 1.0], [10.0, 20.0, -30.0]));
            for coordinates in all(ell) {
                // Small, so that the rotation vector between the poses is that of the step; restricted to its
                // coordinates.
                let step = coordinates.reduce(&(Vec6::from(step) * 1e-3));
                let moved = coordinates.moved(&pose, &step);
                let turn = (moved.rot_wp * pose.rot_wp.inverse()).scaled_axis();
                let p = moved.position_w - pose.position_w;
                let work = wrench.dot(&Vec6::new(p.x, p.y, p.z, turn.x, turn.y, turn.z));
                let reduced = coordinates.reduce(&wrench).dot(&step);
                // Rounding of positions and quaternions of size one.
                prop_assert!((work - reduced).abs() < 1e-14, "{work} {reduced}");
            }
        }

        /// A rank-one matrix is reduced like the wrench that it is made of.
        #[test]
        fn matrices_are_reduced_as_wrenches_are(wrench in prop::array::uniform6(-1.0_f64..1.0), ell in 0.1_f64..10.0) {
            let wrench = Vec6::from(wrench);
            for coordinates in all(ell) {
                let reduced = coordinates.reduce(&wrench);
                let whole = coordinates.reduce_symmetric(&(wrench * wrench.transpose()));
                let difference = whole - reduced * reduced.transpose();
                // Entries up to 1/ℓ², a few roundings each.
                prop_assert!(difference.amax() < 1e-14 * (1.0 + ell.powi(-2)), "{difference}");
            }
        }
    }
}
