//! Rotations: roll, pitch, yaw in degrees as users write them; rotation vectors for the steps of the solvers.

use super::{Mat3, Rotation, RotationMatrix, Vec3};

/// Rotation `R = Rz(yaw) Ry(pitch) Rx(roll)`, angles in degrees.
pub fn from_roll_pitch_yaw_deg(roll: f64, pitch: f64, yaw: f64) -> Rotation {
    Rotation::from_euler_angles(roll.to_radians(), pitch.to_radians(), yaw.to_radians())
}

/// Rotation whose axes, three unit vectors at right angles, are the columns of a matrix.
pub(crate) fn from_axes(axes: &Mat3) -> Rotation {
    Rotation::from_rotation_matrix(&RotationMatrix::from_matrix_unchecked(*axes))
}

/// Angles (roll, pitch, yaw) in degrees of `R = Rz(yaw) Ry(pitch) Rx(roll)`.
pub fn to_roll_pitch_yaw_deg(rot_wp: &Rotation) -> [f64; 3] {
    let (roll, pitch, yaw) = rot_wp.euler_angles();
    [roll.to_degrees(), pitch.to_degrees(), yaw.to_degrees()]
}

/// Turns `rot_wp` by the rotation vector `turn_w` (rad, world axes).
pub fn turned(rot_wp: &Rotation, turn_w: &Vec3) -> Rotation {
    let mut turned = Rotation::from_scaled_axis(*turn_w) * rot_wp;
    turned.renormalize_fast();
    turned
}

/// Quaternion (w, x, y, z) with w ≥ 0, so that each rotation has one printed form.
pub fn quaternion_wxyz(rot_wp: &Rotation) -> [f64; 4] {
    let q = rot_wp.quaternion();
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    [sign * q.w, sign * q.i, sign * q.j, sign * q.k]
}
