//! Derivatives of the tension of a cable parallel to its chord.

use super::GradientError;
use super::adjoint::CableAdjoint;
use super::scalar::add_real;
use crate::drive::derivatives::place;
use crate::math::Vec3;
use crate::robot::Robot;
use crate::statics::CableState;
use crate::statics::derivatives::{CablePartials, StaticDerivativeError, load_of};

/// Minimum sine of the angle between chord and load for which the parallel tension of a cable with weight is
/// differentiated: the formula divides by the sine twice.
const MIN_SINE_OF_CHORD: f64 = 1e-5;

/// Derivatives of the parallel tension τ of a cable, (10a), with respect to length, force, load per length and chord.
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
        if partials.drive.is_some() {
            let mut coefficients = CableAdjoint::default();
            tension.add(&mut coefficients, 1.0);
            tension.by_length = by_length(&coefficients, partials);
        }
        Ok(tension)
    }

    /// Derivatives with respect to force, load per length and chord; the derivative with respect to the length is
    /// given.
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
        add_real(&mut sum.force, self.force_w * factor);
        add_real(&mut sum.load, self.load_w * factor);
        add_real(&mut sum.chord, self.chord_w * factor);
    }
}

/// Derivative of a scalar of the state of one cable with respect to the unstrained length of the cable. Every quantity
/// of the state adapts to the length.
pub(super) fn by_length(cable: &CableAdjoint<f64>, partials: &CablePartials) -> f64 {
    let Some(drive) = &partials.drive else {
        return cable.length + cable.free_length + partials.force_by_length_w.dot(&Vec3::from(cable.force));
    };
    let by = &drive.by_outer;
    let rows = by.force_w.iter().chain(&by.chord_w).chain([&by.free_length]).chain(&by.end);
    let coefficients = cable.force.iter().chain(&cable.chord).chain([&cable.free_length]).chain(&cable.end);
    cable.length + coefficients.zip(rows).map(|(coefficient, row)| coefficient * row[place::LENGTH]).sum::<f64>()
}
