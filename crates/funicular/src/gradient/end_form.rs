//! End of a cable at its pulley and winch as part of the form of the cable: its motions, and the coefficients of its
//! stiffness over the numbers of the end.

use super::adjoint::CableAdjoint;
use super::scalar::{Field, Vector, add_times, dot, vector};
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
    /// Stiffness S, of which the weight is a part along the cable.
    stiffness: [[f64; 2]; 2],
    weight: f64,
    /// Compliance Γ_r of arc and drum side.
    rope_compliance: f64,
    /// Stretch at the exit point and between entry point and drum.
    stretch: f64,
    stretch_drum: f64,
    /// Length that the winch pays out per tension.
    winch_compliance: f64,
}

/// Factor h of the stiffness of a rope by the loss of its stretch; `None` without loss. With its derivatives by loss
/// factor and damping time.
pub(super) type StretchAt<T> = (Option<T>, [T; 2]);

impl EndAtRest {
    /// End of a cable whose span has the stiffness `held`; `None` for an end that is held.
    pub(super) fn of(anchor: &Anchor, drive: Option<&DriveAtRest>, held: &Mat3) -> Option<Self> {
        let end: &AnchorEnd = &drive?.end;
        let along_w = end.along_w?;
        let sideways_w = end.sideways_w.unwrap_or_else(Vec3::zeros);
        let winch_compliance = anchor.winch.as_ref().map_or(0.0, Winch::compliance);
        Some(Self {
            directions_w: [along_w, sideways_w],
            by_end: end.motion_by_start(held),
            by_side: end.motion_by_drum_side(held),
            stiffness: end.stiffness,
            weight: end.weight,
            rope_compliance: end.rope_compliance,
            stretch: end.stretch,
            stretch_drum: end.stretch_drum,
            winch_compliance,
        })
    }

    /// Stiffness k_s along the cable and its compliance Γ with the factor h of the rope: k_s = 1/(λ²Γ), Γ = Γ_r/h +
    /// (1/k)/λ_E².
    fn spring<T: Field>(&self, stretch: T) -> (T, T) {
        let compliance =
            T::from(self.rope_compliance) / stretch + T::from(self.winch_compliance / self.stretch_drum.powi(2));
        (T::from(self.stretch.powi(-2)) / compliance, compliance)
    }

    /// Motions (σ, v) for a displacement of the platform end relative to the support, world axes, and a motion of the
    /// entry point along a drum side from the ground. `pull` is the force of the span, both ends held, on a
    /// displacement of the platform end, with the factor h of its stiffness.
    pub(super) fn motion<T: Field>(
        &self,
        start_w: &Vector<T>,
        along: T,
        stretch: Option<T>,
        pull: impl Fn(&Vector<T>) -> Vector<T>,
    ) -> [T; 2] {
        let Some(stretch) = stretch else {
            return from_fn(|k| dot(start_w, &vector(&self.by_end[k])) + along * self.by_side[k]);
        };

        // (S + Wᵀ K W)(σ, v) = Wᵀ K u, with the force of the drum side on σ.
        let directions = self.directions_w.map(|of| vector(&of));
        let pulled = directions.map(|of| pull(&of));
        let (spring, _) = self.spring(stretch);
        let own = [[spring + T::from(self.weight), T::from(self.stiffness[0][1])], self.stiffness[1].map(T::from)];
        let [[a, b], [_, c]]: [[T; 2]; 2] = from_fn(|i| from_fn(|j| own[i][j] + dot(&directions[i], &pulled[j])));
        let force = pull(start_w);
        let slip = dot(&directions[0], &force) - along * spring * (self.stretch / self.stretch_drum);
        if self.directions_w[1].norm_squared() <= 0.0 {
            return [slip / a, T::default()];
        }
        let sideways = dot(&directions[1], &force);
        let determinant = a * c - b * b;
        [(c * slip - b * sideways) / determinant, (a * sideways - b * slip) / determinant]
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
    /// drum side from the ground, with the loss of the rope. The result are the forces of the drum side on the entry
    /// point.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        (a, b): (&[T], &[T]),
        sides: &[T; 2],
        (stretch, by_loss): StretchAt<T>,
        factor: T,
    ) -> SideForces<T> {
        let stretch = stretch.unwrap_or_else(|| T::from(1.0));
        let (spring, compliance) = self.spring(stretch);
        sum.end[end::WEIGHT] += factor * a[0] * b[0];
        sum.end[end::COUPLING] += factor * (a[0] * b[1] + a[1] * b[0]);
        sum.end[end::SIDEWAYS_STIFFNESS] += factor * a[1] * b[1];

        // The drum side stretches by σ, and by the motion of the entry point times the ratio of the stretches.
        let ratio = self.stretch / self.stretch_drum;
        let [stretched_a, stretched_b] = [(a, sides[0]), (b, sides[1])].map(|(moved, side)| moved[0] + side * ratio);
        let along = factor * stretched_a * stretched_b;
        let by_ratio = factor * (stretched_a * sides[1] + stretched_b * sides[0]) * spring;
        sum.end[end::STRETCH] += by_ratio * (1.0 / self.stretch_drum);
        sum.end[end::STRETCH_DRUM] += by_ratio * (-ratio / self.stretch_drum);

        let by_compliance = -(along * spring / compliance);
        sum.end[end::STRETCH] += along * spring * (-2.0 / self.stretch);
        sum.end[end::ROPE_COMPLIANCE] += by_compliance / stretch;
        sum.end[end::STRETCH_DRUM] += by_compliance * (-2.0 * self.winch_compliance * self.stretch_drum.powi(-3));
        sum.drive.compliance += by_compliance * self.stretch_drum.powi(-2);
        let by_stretch = -(by_compliance * self.rope_compliance) / (stretch * stretch);
        sum.stretch_loss.iter_mut().zip(by_loss).for_each(|(sum, by)| *sum += by_stretch * by);
        [stretched_a, stretched_b].map(|stretched| stretched * spring * ratio)
    }
}
