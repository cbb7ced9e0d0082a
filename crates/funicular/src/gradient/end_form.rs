//! End of a cable at its pulley and winch as part of the form of the cable: its motions, and the coefficients of its
//! stiffness over the numbers of the end.

use super::adjoint::CableAdjoint;
use super::scalar::{Field, Vector, add_times, vector};
use super::support_form::SideForces;
use crate::drive::derivatives::end;
use crate::drive::{AnchorEnd, DriveAtRest};
use crate::math::{Mat3, Vec3};
use crate::robot::{Anchor, Winch};
use std::array::from_fn;

/// End at rest: it slips along the cable and moves sideways until its stiffness S holds it.
pub(super) struct EndAtRest {
    /// Directions of both motions, world axes; zero for a motion that the end does not have.
    directions_w: [Vec3; 2],
    /// Motion (σ, v) per displacement of the platform end, world axes.
    by_end: [Vec3; 2],
    /// Motion (σ, v) per motion of the entry point along a drum side from the ground.
    by_side: [f64; 2],
    /// Stiffness k_s along the cable, and its compliance Γ.
    spring: f64,
    compliance: f64,
    /// Stretch at the exit point and between entry point and drum.
    stretch: f64,
    stretch_drum: f64,
    /// Length that the winch pays out per tension.
    winch_compliance: f64,
}

impl EndAtRest {
    /// End of a cable whose span has the stiffness `held`; `None` for an end that is held.
    pub(super) fn of(anchor: &Anchor, drive: Option<&DriveAtRest>, held: &Mat3) -> Option<Self> {
        let end: &AnchorEnd = &drive?.end;
        let along_w = end.along_w?;
        let sideways_w = end.sideways_w.unwrap_or_else(Vec3::zeros);
        let winch_compliance = anchor.winch.as_ref().map_or(0.0, Winch::compliance);
        let spring = end.stiffness[0][0] - end.weight;
        Some(Self {
            directions_w: [along_w, sideways_w],
            by_end: end.motion_by_start(held),
            by_side: end.motion_by_drum_side(held),
            spring,
            compliance: 1.0 / (end.stretch * end.stretch * spring),
            stretch: end.stretch,
            stretch_drum: end.stretch_drum,
            winch_compliance,
        })
    }

    /// Motions (σ, v) for a displacement of the platform end relative to the support, world axes, and a motion of the
    /// entry point along a drum side from the ground.
    pub(super) fn motion<T: Field>(&self, start_w: &Vector<T>, along: T) -> [T; 2] {
        from_fn(|k| super::scalar::dot(start_w, &vector(&self.by_end[k])) + along * self.by_side[k])
    }

    /// Displacement of the end, world axes.
    pub(super) fn displacement<T: Field>(&self, motion: &[T; 2]) -> Vector<T> {
        let mut sum = [T::default(); 3];
        for (direction_w, size) in self.directions_w.iter().zip(motion) {
            add_times(&mut sum, &vector(direction_w), *size);
        }
        sum
    }

    /// Adds `factor` times the coefficients of the stiffness over two motions, in which the entry point moves along a
    /// drum side from the ground. The result are the forces of the drum side on the entry point.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        (a, b): (&[T], &[T]),
        sides: &[T; 2],
        factor: T,
    ) -> SideForces<T> {
        sum.end[end::WEIGHT] += factor * a[0] * b[0];
        sum.end[end::COUPLING] += factor * (a[0] * b[1] + a[1] * b[0]);
        sum.end[end::SIDEWAYS_STIFFNESS] += factor * a[1] * b[1];

        // The drum side stretches by σ, and by the motion of the entry point times the ratio of the stretches.
        let ratio = self.stretch / self.stretch_drum;
        let [stretched_a, stretched_b] = [(a, sides[0]), (b, sides[1])].map(|(moved, side)| moved[0] + side * ratio);
        let along = factor * stretched_a * stretched_b;
        let by_ratio = factor * (stretched_a * sides[1] + stretched_b * sides[0]) * self.spring;
        sum.end[end::STRETCH] += by_ratio * (1.0 / self.stretch_drum);
        sum.end[end::STRETCH_DRUM] += by_ratio * (-ratio / self.stretch_drum);

        // k_s = 1/(λ²Γ), Γ = Γ_r + (1/k)/λ_E².
        sum.end[end::STRETCH] += along * (-2.0 * self.spring / self.stretch);
        let by_compliance = along * (-self.spring / self.compliance);
        sum.end[end::ROPE_COMPLIANCE] += by_compliance;
        sum.end[end::STRETCH_DRUM] += by_compliance * (-2.0 * self.winch_compliance * self.stretch_drum.powi(-3));
        sum.drive.compliance += by_compliance * self.stretch_drum.powi(-2);
        [stretched_a, stretched_b].map(|stretched| stretched * (self.spring * ratio))
    }
}
