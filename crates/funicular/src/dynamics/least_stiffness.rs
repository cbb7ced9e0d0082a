//! Least eigenvalue of the static stiffness that a linearisation has.

use super::Dynamics;
use crate::math::inertia;

impl Dynamics {
    /// Least eigenvalue of the static stiffness D(0) in the platform's coordinates, rotations scaled by the platform's size
    /// [N/m]; not positive where the linearised robot does not return by itself.
    pub fn least_static_stiffness(&self) -> f64 {
        inertia::eigen(&self.dynamic_stiffness(0.0), self.freedoms()).0[0]
    }
}
