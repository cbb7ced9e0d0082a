//! Pieces of a cable beyond the exit point: the arc on the wheel, the drum side, and the length that the winch yields.

use super::end_force_w;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::math::dual::{Real, dot};
use crate::robot::{Anchor, PulleyContact, Wheel};

/// Nodes and weights of the 6-point Gauss rule on [−1, 1]; the other three nodes mirror these. The tension changes
/// along the arc by the weight of a piece as long as the wheel, a smooth and small change: six points give all digits.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_4),
];

/// Minimum of the squared stretch λ²: a cable that would be compressed to a third of its length at the entry point has
/// no meaning, but a search may pass such a place.
const MIN_SQUARED_STRETCH: f64 = 0.1;

/// Numbers on which the pieces of a cable beyond the exit point depend.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given<T> {
    /// Force of the span at the exit point towards the platform, world axes [N].
    pub(super) force_w: [T; 3],
    /// Load per unstrained length, world axes [N/m].
    pub(super) load_w: [T; 3],
    /// EA [N].
    pub(super) axial_stiffness: T,
    /// Place on the wheel; `None` without a pulley.
    pub(super) wheel: Option<Wheel<T>>,
    /// Length from the entry point to the drum [m], and length that the winch pays out per tension [m/N]; `None`
    /// without a winch.
    pub(super) winch: Option<(T, T)>,
}

impl Given<f64> {
    /// Numbers of a span that ends at the anchor's point, or at the exit point of `contact`.
    pub(super) fn of(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Self {
        Self {
            force_w: end_force_w(span).into(),
            load_w: span.load_w().into(),
            axial_stiffness: span.catenary.rope().axial_stiffness,
            wheel: contact.map(PulleyContact::wheel),
            winch: anchor.winch.as_ref().map(|winch| (winch.drum_side_length, winch.compliance())),
        }
    }
}

/// Pieces of a cable beyond the exit point, for a free span and a place on the wheel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beyond<T = f64> {
    /// Force of the span at the exit point towards the platform, world axes [N].
    pub(super) force_w: [T; 3],
    /// Tension at the exit point [N].
    pub(super) tension: T,
    /// Stretch λ = 1 + T/EA at the exit point.
    pub(super) stretch: T,
    /// Tension at the entry point [N].
    pub(super) tension_entry: T,
    /// Unstrained length on the wheel [m].
    pub(super) arc_length: T,
    /// Unstrained length from the entry point to the drum [m], less the length that the winch yields.
    pub(super) drum_side_length: T,
    /// Length that the winch yields [m].
    pub(super) winch_yield: T,
    /// Stretch λ_E between entry point and drum.
    pub(super) stretch_entry: T,
    /// Compliance Γ: minus the derivative of the unstrained length beyond the exit point by ψ [m/N], its part Γ_r of
    /// arc and drum side, and the part of the drum side alone.
    pub(super) compliance: T,
    pub(super) rope_compliance: T,
    pub(super) drum_side_compliance: T,
    /// Moment of the length on the wheel about the swivel axis, `M_a = ∫ r (1 − cos θ) ds` [m²].
    pub(super) moment: T,
    /// Sideways kink κ [rad] of a balanced swivel.
    pub(super) kink: T,
    /// Potential energy [J] of arc, drum side and winch; heights counted from the entry point.
    pub(super) energy: T,
}

impl Beyond {
    /// Pieces of a span that ends at the anchor's point, or at the exit point of `contact`.
    pub(super) fn of(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Self {
        Self::at(&Given::of(span, anchor, contact))
    }

    /// Sideways kink κ of a balanced swivel [rad], without the integrals over the arc where the load does not turn the
    /// swivel.
    pub(super) fn kink_of(span: &HangingCable, anchor: &Anchor, contact: &PulleyContact) -> f64 {
        let turned = span.load_w().dot(&contact.sideways_w) != 0.0;
        if turned { Self::of(span, anchor, Some(contact)).kink } else { 0.0 }
    }

    /// Unstrained length beyond the exit point [m].
    pub(super) fn length(&self) -> f64 {
        self.arc_length + self.drum_side_length
    }
}

impl<T: Real> Beyond<T> {
    /// Pieces for given numbers.
    ///
    /// # References
    /// docs/theory.md, equations (64) to (67).
    pub(super) fn at(given: &Given<T>) -> Self {
        let Given { force_w, axial_stiffness: ea, wheel, winch, .. } = *given;
        let zero = T::from(0.0);
        let tension = dot(&force_w, &force_w).sqrt();
        let stretch = T::from(1.0) + tension / ea;

        let mut beyond = Self {
            force_w,
            tension,
            stretch,
            tension_entry: tension,
            arc_length: zero,
            drum_side_length: zero,
            winch_yield: zero,
            stretch_entry: stretch,
            compliance: zero,
            rope_compliance: zero,
            drum_side_compliance: zero,
            moment: zero,
            kink: zero,
            energy: zero,
        };

        if let Some(wheel) = &wheel {
            beyond.add_arc(given, wheel);
        }
        if let Some(winch) = winch {
            beyond.add_drum_side(ea, winch);
        }
        beyond.compliance = beyond.compliance + beyond.rope_compliance;

        beyond
    }

    /// Adds the arc on the wheel.
    #[inline]
    fn add_arc(&mut self, given: &Given<T>, wheel: &Wheel<T>) {
        let Given { load_w, axial_stiffness: ea, .. } = *given;
        let exit = wheel.offset_w(wheel.wrap);
        let at_exit = self.tension * 0.5 * (T::from(1.0) + self.stretch);
        for (angle, arc) in arc_nodes(wheel) {
            let offset = wheel.offset_w(angle);
            let lift: [T; 3] = std::array::from_fn(|k| exit[k] - offset[k]);
            let potential = at_exit + dot(&load_w, &lift);
            let stretch = stretch_of(potential, ea);
            let tension = tension_of(potential, stretch);
            // Unstrained length of the piece that belongs to the node.
            let length = arc / stretch;
            self.arc_length = self.arc_length + length;
            self.rope_compliance = self.rope_compliance + length / (ea * stretch * stretch);
            self.moment = self.moment + length * dot(&offset, &wheel.center_w);
            self.energy = self.energy + length * (tension * 0.5 * tension / ea - dot(&load_w, &offset));
        }

        // Entry point.
        let potential = at_exit + dot(&load_w, &exit);
        self.stretch_entry = stretch_of(potential, ea);
        self.tension_entry = tension_of(potential, self.stretch_entry);

        let lever = wheel.distance_from_axis() * self.tension;
        if lever.value() > 0.0 {
            self.kink = (-dot(&load_w, &wheel.sideways_w) * self.moment / lever).arcsin();
        }
    }

    /// Adds the drum side of a length and the winch, which yields by an unstrained length per tension at the entry
    /// point.
    #[inline]
    fn add_drum_side(&mut self, ea: T, (length, by_tension): (T, T)) {
        let tension = self.tension_entry;
        self.winch_yield = tension * by_tension;
        self.drum_side_length = (length - self.winch_yield) / self.stretch_entry;
        let squared = self.stretch_entry * self.stretch_entry;
        self.drum_side_compliance = self.drum_side_length / (ea * squared);
        self.rope_compliance = self.rope_compliance + self.drum_side_compliance;
        self.compliance = self.compliance + by_tension / squared;
        self.energy = self.energy + tension * 0.5 * tension * (self.drum_side_length / ea + by_tension);
    }
}

impl Beyond {
    /// Integral of the place on the rim, measured from the entry point, over the compliance of the arc, world axes
    /// [m²/N].
    pub(super) fn compliance_moment(&self, load_w: &Vec3, axial_stiffness: f64, wheel: &Wheel<f64>) -> Vec3 {
        let exit = Vec3::from(wheel.offset_w(wheel.wrap));
        let at_exit = self.tension * 0.5 * (1.0 + self.stretch);
        let of_node = |(angle, arc): (f64, f64)| {
            let offset = Vec3::from(wheel.offset_w(angle));
            let stretch = stretch_of(at_exit + load_w.dot(&(exit - offset)), axial_stiffness);
            offset * (arc / (axial_stiffness * stretch.powi(3)))
        };
        arc_nodes(wheel).map(of_node).sum()
    }
}

/// Points of the rim with the length of arc that belongs to each, for integrals over the arc: angles from the entry
/// point [rad], and lengths [m].
pub(crate) fn arc_nodes<T: Real>(wheel: &Wheel<T>) -> impl Iterator<Item = (T, T)> + use<T> {
    let (half, radius) = (wheel.wrap * 0.5, wheel.radius);
    let both = |(node, weight): (f64, f64)| [(node, weight), (-node, weight)];
    GAUSS.into_iter().flat_map(both).map(move |(node, weight)| (half * (1.0 + node), half * weight * radius))
}

/// Tension from the entry point of a span to its drum [N].
pub(crate) fn tension_at_drum(span: &HangingCable, contact: Option<&PulleyContact>) -> f64 {
    let ea = span.catenary.rope().axial_stiffness;
    let tension = end_force_w(span).norm();
    let Some(contact) = contact else { return tension };
    let potential = tension * 0.5 * (2.0 + tension / ea) + span.load_w().dot(&contact.exit_offset_w());
    tension_of(potential, stretch_of(potential, ea))
}

/// Tension [N] of ψ and the stretch λ: T = 2ψ/(1 + λ).
pub(crate) fn tension_of<T: Real>(potential: T, stretch: T) -> T {
    potential * 2.0 / (T::from(1.0) + stretch)
}

/// Stretch λ = √(1 + 2ψ/EA).
pub(crate) fn stretch_of<T: Real>(potential: T, axial_stiffness: T) -> T {
    let squared = T::from(1.0) + potential * 2.0 / axial_stiffness;
    if squared.value() >= MIN_SQUARED_STRETCH { squared.sqrt() } else { T::from(MIN_SQUARED_STRETCH).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::legendre::gauss;

    #[test]
    fn the_nodes_and_weights_are_those_of_the_rule() {
        for (ours, computed) in GAUSS.iter().zip(&gauss(6)[3..]) {
            assert!((ours.0 - computed.0).abs() < 1e-15 && (ours.1 - computed.1).abs() < 1e-15);
        }
    }
}
