//! Mass and damping of the platform.

use crate::math::{Mat3, Mat6, skew};
use crate::robot::{Platform, Pose};

/// Mass matrix of the platform about its origin at a pose, world axes [kg, kg m, kg m²].
pub(crate) fn mass_matrix(platform: &Platform, pose: &Pose) -> Mat6 {
    let rot = pose.rot_wp.to_rotation_matrix();
    let com = skew(&(rot * platform.center_of_mass_p));
    let mut mass = Mat6::zeros();
    let mut put = |row, column, block: Mat3| mass.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
    put(0, 0, Mat3::identity() * platform.mass);
    let inertia_w = rot.matrix() * platform.inertia_p * rot.matrix().transpose();
    put(0, 3, -com * platform.mass);
    put(3, 0, com * platform.mass);
    put(3, 3, inertia_w - com * com * platform.mass);
    mass
}

/// Viscous damping matrix of the platform about its origin at a pose, world axes [N s/m, N s, N m s]. The dampers act
/// along the platform's axes.
pub(crate) fn damping_matrix(platform: &Platform, pose: &Pose) -> Mat6 {
    let rot = pose.rot_wp.to_rotation_matrix();
    let mut damping = Mat6::zeros();
    for (at, along_p) in [(0, platform.translational_damping_p), (3, platform.rotational_damping_p)] {
        let block = rot.matrix() * Mat3::from_diagonal(&along_p) * rot.matrix().transpose();
        damping.fixed_view_mut::<3, 3>(at, at).copy_from(&block);
    }
    damping
}
