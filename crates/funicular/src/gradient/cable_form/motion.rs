//! Motions of the points of a cable with its ends: slow, with the same change of the tension all along it, or
//! vibrating.

use super::sums;
use super::vibrating::{FamilyAmplitude, Vibrating};
use super::{CableAt, CableForm, CableMotion, CablePoint, Inertia};
use crate::gradient::scalar::{Field, Vector, add, add_times, cross, dot, less, times, vector};
use crate::gradient::support_form::Carrier;

impl CableForm {
    /// Motion with the platform (translation of its origin and rotation, world axes) at a frequency. `near` are
    /// amplitudes that do not follow from the end, `forces` act on the motions of the drive besides its own; none if
    /// empty. `carrier` is the motion with a flexible support.
    pub(in crate::gradient) fn motion<T: Field>(
        &self,
        (v, theta): (&Vector<T>, &Vector<T>),
        carrier: Option<&Carrier<T>>,
        at: &CableAt<T>,
        near: &[FamilyAmplitude<T>],
        forces: &[T],
    ) -> CableMotion<T> {
        let end_w = add(v, &cross(theta, &vector(&self.lever_w)));
        match &self.inertia {
            Inertia::Modes(vibrating) => {
                let far = carrier.map(|carrier| (self.local(&carrier.displacement_w), carrier.along));
                self.vibrating_motion(vibrating, (&self.local(&end_w), theta), far.as_ref(), at, near, forces)
            }
            Inertia::None | Inertia::Massless => self.slow_motion(&end_w, theta, carrier, at.stretch),
        }
    }

    /// Motion of a cable without mass, whose tension vector changes by the same amount all along the cable.
    fn slow_motion<T: Field>(
        &self,
        end_w: &Vector<T>,
        theta: &Vector<T>,
        carrier: Option<&Carrier<T>>,
        stretch: Option<T>,
    ) -> CableMotion<T> {
        let end = self.local(end_w);
        let (relative_w, mut elongation, along) = match carrier {
            Some(carrier) => {
                let far = self.local(&carrier.displacement_w);
                (less(end_w, &carrier.displacement_w), less(&end, &far), carrier.along)
            }
            None => (*end_w, end, T::default()),
        };
        let pull = |moved_w: &Vector<T>| self.world(&self.static_force(&self.local(moved_w), stretch));
        let at_end = self.end.as_ref().map_or_else(Default::default, |of| of.motion(&relative_w, along, stretch, pull));
        if let Some(of) = &self.end {
            let followed_w = of.displacement(&at_end);
            (0..3).for_each(|k| elongation[k] += dot(&followed_w, &vector(&self.axes_w[k])) * -1.0);
        }

        let force = self.static_force(&elongation, stretch);
        let far_force = times(&force, T::from(-1.0));
        let tension = vec![far_force; self.points.len()];
        let displacement = match self.inertia {
            Inertia::Massless => {
                let strains: Vec<Vector<T>> = self
                    .points
                    .iter()
                    .zip(&tension)
                    .map(|(point, change)| self.strain(point, change, stretch))
                    .collect();
                let (gathered, _) = self.gathered(&sums::by_axes(&strains));
                gathered.iter().map(|moved| add(&end, moved)).collect()
            }
            _ => Vec::new(),
        };
        let (end_force_w, end) = (self.world(&force), at_end.to_vec());
        CableMotion { displacement, tension, end_force_w, theta: *theta, end, far_force }
    }

    /// Motion of a cable that vibrates, in its axes: with the platform end, with the far end and along the drum side on
    /// a flexible support, and with the rotation of the platform.
    fn vibrating_motion<T: Field>(
        &self,
        vibrating: &Vibrating,
        (end, theta): (&Vector<T>, &Vector<T>),
        far: Option<&(Vector<T>, T)>,
        at: &CableAt<T>,
        near: &[FamilyAmplitude<T>],
        forces: &[T],
    ) -> CableMotion<T> {
        // Momentum: δN(s) = δN(0) − ω_c² m ∫₀ˢ δp ds.
        let (displacement, motions) = vibrating.displacement(end, far, at, near, forces);
        let (mut gathered, mut whole) = self.gathered(&displacement);
        let displacement = sums::vectors(&displacement, self.points.len());
        let factor = -(at.square * self.mass_per_length);
        for sum in gathered.iter_mut().chain([&mut whole]) {
            *sum = times(sum, factor);
        }

        // The strains of δN along the cable add up to the motion of the far end less that of the platform end.
        let mut moved = far.map_or(*end, |(far, _)| less(end, far));
        if let Some(drive) = &vibrating.drive {
            for (motion, direction) in &drive.directions {
                (0..3).for_each(|k| moved[k] += -(motions[*motion] * direction[k]));
            }
        }
        for (point, gathered) in self.points.iter().zip(&gathered) {
            add_times(&mut moved, &self.strain(point, gathered, at.stretch), T::from(point.weight));
        }
        let force = self.static_force(&moved, at.stretch);
        let tension = gathered.iter().map(|gathered| less(gathered, &force)).collect();
        let far_force = less(&whole, &force);
        CableMotion { displacement, tension, end_force_w: self.world(&force), theta: *theta, end: motions, far_force }
    }

    /// Strain δp' of a change of the tension vector at a point.
    pub(super) fn strain<T: Field>(&self, point: &CablePoint, change: &Vector<T>, stretch: Option<T>) -> Vector<T> {
        let [h, v] = point.direction;
        let along = change[0] * h + change[1] * v;
        let (by_stretch, by_turn) = (1.0 / self.axial_stiffness, 1.0 / point.tension);
        let both = by_stretch + by_turn;
        let mut strain =
            [change[0] * both - along * (h * by_turn), change[1] * both - along * (v * by_turn), change[2] * both];
        if let Some(stretch) = stretch {
            let more = self.more_compliance(stretch) * along;
            strain[0] += more * h;
            strain[1] += more * v;
        }
        strain
    }

    /// Integrals of a vector, whose components at the points stand axis by axis, from the platform end to every point
    /// and over the whole cable [m].
    fn gathered<T: Field>(&self, values: &[T]) -> (Vec<Vector<T>>, Vector<T>) {
        sums::integrals(&self.elements, values, self.points.len())
    }

    /// Force that moves the platform end slowly, in the axes of the cable.
    ///
    /// # References
    /// docs/theory.md, equation (27e): with loss, `(1 + K F)⁻¹ K` with the further flexibility F.
    pub(super) fn static_force<T: Field>(&self, end: &Vector<T>, stretch: Option<T>) -> Vector<T> {
        let [hh, hv, vv, out] = self.stiffness;
        let force = [end[0] * hh + end[1] * hv, end[0] * hv + end[1] * vv, end[2] * out];
        let Some(stretch) = stretch else { return force };

        let more = self.more_compliance(stretch);
        let [[a, b], [_, c]] = self.direction_integrals;
        let entry = |diagonal: f64, of: f64| more * of + T::from(diagonal);
        let [[p, q], [r, s]] = [
            [entry(1.0, hh * a + hv * b), entry(0.0, hh * b + hv * c)],
            [entry(0.0, hv * a + vv * b), entry(1.0, hv * b + vv * c)],
        ];
        let determinant = p * s - q * r;
        [(s * force[0] - q * force[1]) / determinant, (p * force[1] - r * force[0]) / determinant, force[2]]
    }
}
