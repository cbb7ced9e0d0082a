//! Derivatives of the tension of a cable parallel to its chord.

use super::GradientError;
use super::adjoint::CableAdjoint;
use crate::drive::derivatives::{DriveDerivatives, Row, place};
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::CableState;
use crate::statics::derivatives::{CablePartials, StaticDerivativeError, load_of};

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
    pub(super) fn of(
        robot: &Robot,
        i: usize,
        state: &CableState,
        partials: &CablePartials,
    ) -> Result<Self, GradientError> {
        let hanging = state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?;
        let mut tension = Self::at_state(robot, i, state, hanging.catenary.parallel_tension_by_length())?;
        // Over a pulley the length of the cable changes the chord, too.
        if let Some(drive) = &partials.drive {
            let by_length = |rows: &[Row; 3]| Vec3::from_fn(|k, _| rows[k][place::LENGTH]);
            let DriveDerivatives { force_w, chord_w, .. } = &drive.by_outer;
            tension.by_length = tension.force_w.dot(&by_length(force_w)) + tension.chord_w.dot(&by_length(chord_w));
        }
        Ok(tension)
    }

    /// Derivatives by force, load per length and chord; that by the length is given.
    fn at_state(robot: &Robot, i: usize, state: &CableState, by_length: f64) -> Result<Self, GradientError> {
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
