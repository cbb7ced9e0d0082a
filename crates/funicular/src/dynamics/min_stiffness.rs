//! Least eigenvalue of the static stiffness that a linearisation has.

use super::Dynamics;
use crate::math::symmetric;

impl Dynamics {
    /// Least eigenvalue of the static stiffness D(0) in the platform's coordinates, rotations scaled by the platform's size
    /// [N/m]; not positive where the linearised robot does not return by itself.
    pub fn least_static_stiffness(&self) -> f64 {
        symmetric::eigen(&self.dynamic_stiffness(0.0), self.dof()).0[0]
    }
}
