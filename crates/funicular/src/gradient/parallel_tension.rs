//! Derivatives of the tension of a cable parallel to its chord.

use super::GradientError;
use super::adjoint::CableAdjoint;
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::CableState;
use crate::statics::derivatives::{StaticDerivativeError, load_of};

/// Sine of the angle between chord and load below which the parallel tension of a cable with weight is not
/// differentiated: the formula divides by the sine twice.
const MIN_SINE_OF_CHORD: f64 = 1e-5;

/// Derivatives of the parallel tension τ of a cable, (10a), by length, force, load per length and chord.
pub(super) struct ParallelTension {
    pub(super) by_length: f64,
    pub(super) force_w: Vec3,
    load_w: Vec3,
    chord_w: Vec3,
}

impl ParallelTension {
    /// τ = |f × q| |d|/|d × q|, or the tension of a cable without load.
    pub(super) fn of(robot: &Robot, i: usize, state: &CableState) -> Result<Self, GradientError> {
        let hanging = state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?;
        let by_length = hanging.catenary.parallel_tension_by_length();
        let (f, q, d) = (state.force_on_platform_w, load_of(state), state.chord_w());
        if q == Vec3::zeros() {
            let zero = Vec3::zeros();
            return Ok(Self { by_length, force_w: f.normalize(), load_w: zero, chord_w: zero });
        }

        let (pulled, turned) = (f.cross(&q), d.cross(&q));
        if turned.norm() < MIN_SINE_OF_CHORD * d.norm() * q.norm() {
            return Err(GradientError::Vertical { cable: robot.cables[i].name.clone() });
        }
        let tau = pulled.norm() * d.norm() / turned.norm();
        let (a, b) = (pulled.normalize(), turned.normalize());
        Ok(Self {
            by_length,
            force_w: q.cross(&a) * (tau / pulled.norm()),
            load_w: (a.cross(&f) / pulled.norm() - b.cross(&d) / turned.norm()) * tau,
            chord_w: (d / d.norm_squared() - q.cross(&b) / turned.norm()) * tau,
        })
    }

    /// Adds `factor` times the coefficients of τ.
    pub(super) fn add(&self, sum: &mut CableAdjoint<f64>, factor: f64) {
        for k in 0..3 {
            sum.force[k] += self.force_w[k] * factor;
            sum.load[k] += self.load_w[k] * factor;
            sum.chord[k] += self.chord_w[k] * factor;
        }
    }
}
