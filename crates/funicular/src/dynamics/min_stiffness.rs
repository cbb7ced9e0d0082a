//! Minimum eigenvalue of the static stiffness of a linearisation.

use super::Dynamics;
use crate::math::symmetric;

impl Dynamics {
    /// Minimum eigenvalue of the static stiffness D(0) in the platform's coordinates, with rotations scaled by the
    /// platform's size [N/m]. It is not positive if the linearised robot does not return to its equilibrium.
    pub fn min_static_stiffness(&self) -> f64 {
        symmetric::eigen(&self.dynamic_stiffness(0.0), self.dof()).0[0]
    }
}
