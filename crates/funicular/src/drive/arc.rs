//! Pieces of a cable beyond the exit point: the arc on the wheel, the drum side, and the length that the winch yields.

use super::end_force_w;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::robot::{Anchor, PulleyContact};

/// Nodes and weights of the 6-point Gauss rule on [−1, 1]; the other three nodes mirror these. The tension changes along
/// the arc by the weight of a piece as long as the wheel, a smooth and small change: six points give all digits.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_4),
];

/// Minimum of the squared stretch λ²: a cable that would be compressed to a third of its length at the entry point has
/// no meaning, but a search may pass such a place.
const MIN_SQUARED_STRETCH: f64 = 0.1;

/// Pieces of a cable beyond the exit point, for a free span and a place on the wheel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beyond {
    /// Force of the span at the exit point towards the platform, world axes [N].
    pub(super) force_w: Vec3,
    /// Tension at the exit point [N].
    pub(super) tension: f64,
    /// Stretch λ = 1 + T/EA at the exit point.
    pub(super) stretch: f64,
    /// Tension at the entry point [N].
    pub(super) tension_entry: f64,
    /// Unstrained length on the wheel [m].
    pub(super) arc_length: f64,
    /// Unstrained length from the entry point to the drum [m], less the length that the winch yields.
    pub(super) drum_side_length: f64,
    /// Length that the winch yields [m].
    pub(super) winch_yield: f64,
    /// Stretch λ_E between entry point and drum.
    pub(super) stretch_entry: f64,
    /// Compliance Γ: minus the derivative of the unstrained length beyond the exit point by ψ [m/N], and its part Γ_r of
    /// arc and drum side.
    pub(super) compliance: f64,
    pub(super) rope_compliance: f64,
    /// Moment of the length on the wheel about the swivel axis, `M_a = ∫ r (1 − cos θ) ds` [m²].
    pub(super) moment: f64,
    /// Sideways kink κ [rad] of a balanced swivel.
    pub(super) kink: f64,
    /// Potential energy [J] of arc, drum side and winch; heights counted from the entry point.
    pub(super) energy: f64,
}

impl Beyond {
    /// Pieces of a span that ends at the anchor's point, or at the exit point of `contact`.
    ///
    /// # References
    /// docs/theory.md, equations (64) to (67).
    pub(super) fn of(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Self {
        let ea = span.catenary.rope().axial_stiffness;
        let load_w = span.load_w();
        let force_w = end_force_w(span);
        let tension = force_w.norm();
        let stretch = 1.0 + tension / ea;
        let potential = tension * 0.5 * (1.0 + stretch);

        let mut beyond = Self {
            force_w,
            tension,
            stretch,
            tension_entry: tension,
            arc_length: 0.0,
            drum_side_length: 0.0,
            winch_yield: 0.0,
            stretch_entry: stretch,
            compliance: 0.0,
            rope_compliance: 0.0,
            moment: 0.0,
            kink: 0.0,
            energy: 0.0,
        };

        // Arc on the wheel.
        let mut stretch_entry = stretch;
        if let Some(contact) = contact {
            let exit = contact.exit_offset_w();
            for (angle, arc) in arc_nodes(contact) {
                let offset = contact.offset_w(angle);
                let potential = potential + load_w.dot(&(exit - offset));
                let stretch = stretch_of(potential, ea);
                let tension = tension_of(potential, stretch);
                // Unstrained length of the piece that belongs to the node.
                let length = arc / stretch;
                beyond.arc_length += length;
                beyond.rope_compliance += length / (ea * stretch * stretch);
                beyond.moment += length * offset.dot(&contact.center_w);
                beyond.energy += length * (0.5 * tension * tension / ea - load_w.dot(&offset));
            }
            let potential = potential + load_w.dot(&exit);
            stretch_entry = stretch_of(potential, ea);
            beyond.tension_entry = tension_of(potential, stretch_entry);

            let lever = contact.distance_from_axis() * tension;
            let sine = if lever > 0.0 { -load_w.dot(&contact.sideways_w) * beyond.moment / lever } else { 0.0 };
            beyond.kink = sine.clamp(-1.0, 1.0).asin();
        }

        // Drum side and winch.
        beyond.stretch_entry = stretch_entry;
        if let Some(winch) = &anchor.winch {
            let (tension, by_tension) = (beyond.tension_entry, winch.compliance());
            beyond.winch_yield = tension * by_tension;
            beyond.drum_side_length = (winch.drum_side_length - beyond.winch_yield) / stretch_entry;
            let squared = stretch_entry * stretch_entry;
            beyond.rope_compliance += beyond.drum_side_length / (ea * squared);
            beyond.compliance += by_tension / squared;
            beyond.energy += 0.5 * tension * tension * (beyond.drum_side_length / ea + by_tension);
        }
        beyond.compliance += beyond.rope_compliance;

        beyond
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

/// Points of the rim with the length of arc that belongs to each, for integrals over the arc: angles from the entry point
/// [rad], and lengths [m].
pub(super) fn arc_nodes(contact: &PulleyContact) -> impl Iterator<Item = (f64, f64)> + use<> {
    let (half, radius) = (0.5 * contact.wrap, contact.radius);
    let both = |(node, weight): (f64, f64)| [(node, weight), (-node, weight)];
    GAUSS.into_iter().flat_map(both).map(move |(node, weight)| (half * (1.0 + node), weight * half * radius))
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
fn tension_of(potential: f64, stretch: f64) -> f64 {
    2.0 * potential / (1.0 + stretch)
}

/// Stretch λ = √(1 + 2ψ/EA).
pub(super) fn stretch_of(potential: f64, axial_stiffness: f64) -> f64 {
    (1.0 + 2.0 * potential / axial_stiffness).max(MIN_SQUARED_STRETCH).sqrt()
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
