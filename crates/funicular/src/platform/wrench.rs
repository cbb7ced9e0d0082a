//! Wrenches on the platform and the stiffness of forces at lever arms, about the platform origin, in world axes.

use crate::math::{Mat3, Mat6, Vec3, Vec6, skew};
use crate::robot::{Load, Pose, Robot};

/// Wrench (force, moment about the platform origin) of a force at a lever arm.
pub(crate) fn wrench_of(force: &Vec3, lever: &Vec3) -> Vec6 {
    let moment = lever.cross(force);
    Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Wrenches of the three columns of a matrix of forces at a lever arm.
pub(crate) fn wrench_columns(forces: &Mat3, lever: &Vec3) -> [Vec6; 3] {
    std::array::from_fn(|j| wrench_of(&forces.column(j).into_owned(), lever))
}

/// Wrench of gravity, wind and load on the platform about its origin, at a pose.
pub(crate) fn load_wrench(robot: &Robot, pose: &Pose) -> Vec6 {
    let Load { force_w, moment_w, point_p } = &robot.load;
    wrench_of(&robot.force_at_mass_centre_w(), &(pose.rot_wp * robot.platform.center_of_mass_p))
        + wrench_of(force_w, &(pose.rot_wp * point_p))
        + Vec6::new(0.0, 0.0, 0.0, moment_w.x, moment_w.y, moment_w.z)
}

/// Size of the load on the platform [N]: weight, force, and moment over ℓ.
pub(crate) fn load_size(robot: &Robot) -> f64 {
    let Load { force_w, moment_w, .. } = &robot.load;
    robot.force_at_mass_centre_w().norm() + force_w.norm() + moment_w.norm() / robot.platform_length()
}

/// Sum of the platform's weight and load and of cable forces at their lever arms, as a wrench about the platform
/// origin; and the sum of the magnitudes of all these forces [N], the reference for residuals.
pub(crate) fn balance(robot: &Robot, pose: &Pose, forces: impl Iterator<Item = (Vec3, Vec3)>) -> (Vec6, f64) {
    forces.fold((load_wrench(robot, pose), load_size(robot)), |(wrench, scale), (force, lever)| {
        (wrench + wrench_of(&force, &lever), scale + force.norm())
    })
}

/// Adds `Jᵀ K J` of a 3×3 stiffness at a lever arm, `J = [I, −[r]×]`.
pub(crate) fn add_congruent(total: &mut Mat6, stiffness: &Mat3, lever: &Vec3) {
    let cross = skew(lever);
    let coupling = stiffness * cross;
    let mut add = |row: usize, column: usize, block: &Mat3| {
        let mut view = total.fixed_view_mut::<3, 3>(row, column);
        view += block;
    };
    add(0, 0, stiffness);
    add(0, 3, &-coupling);
    add(3, 0, &(cross * stiffness));
    add(3, 3, &-(cross * coupling));
}

/// Adds the stiffness of a dead force at a lever arm, `−[f]×[r]×` in the rotation block (theory, section 3).
pub(crate) fn add_lever_term(total: &mut Mat6, force: &Vec3, lever: &Vec3) {
    let mut view = total.fixed_view_mut::<3, 3>(3, 3);
    view -= skew(force) * skew(lever);
}

/// Adds the stiffness of weight and load at a pose: the stiffness of dead forces, and half of the moment's, `½[m]×` in
/// the rotation block, which makes the sum symmetric (theory, section 14).
pub(crate) fn add_load_terms(total: &mut Mat6, robot: &Robot, pose: &Pose) {
    let Load { force_w, moment_w, point_p } = &robot.load;
    add_lever_term(total, &robot.force_at_mass_centre_w(), &(pose.rot_wp * robot.platform.center_of_mass_p));
    add_lever_term(total, force_w, &(pose.rot_wp * point_p));
    let mut view = total.fixed_view_mut::<3, 3>(3, 3);
    view += skew(moment_w) * 0.5;
}
