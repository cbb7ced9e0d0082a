//! Ropes that are stiffer in vibration than under a slow load: the robot that vibrates about an equilibrium.
//!
//! In vibration such a rope behaves about its tension like a rope with the dynamic stiffness that has this tension at
//! the same ends and the same mass. Its unstrained length and what it has per unstrained length follow from that
//! (docs/theory.md, equations (27h) to (27j)). Every analysis of vibration then needs one axial stiffness only.

use super::collect::with_stability;
use super::equilibrium::{CableState, Equilibrium};
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::residual::residual_of;
use crate::drive::CableAtRest;
use crate::robot::{Cable, Damping, Robot};
use std::borrow::Cow;

/// Maximum number of steps for the length of a rope, a guard: three to five are usual.
const MAX_STEPS: usize = 40;

/// Difference of the tension from the wanted one, over it, at which the search for the length ends.
const SAME_TENSION: f64 = 1e-13;

/// Change of the length in the first step of the search, over the length.
const FIRST_STEP: f64 = 1e-6;

impl Equilibrium {
    /// Robot that vibrates about this equilibrium, and the equilibrium with its ropes: those with a [dynamic axial
    /// stiffness](crate::robot::Material::dynamic_axial_stiffness) have it in place of their axial stiffness. Pose,
    /// tensions and masses stay; between the ends of a sagging rope the balance changes by the variation of its strain,
    /// which [`residual`](Self::residual) shows. The same robot and equilibrium if no rope has a dynamic stiffness.
    ///
    /// # References
    /// docs/theory.md, equations (27h) to (27j).
    pub fn with_dynamic_stiffness<'a>(&'a self, robot: &'a Robot) -> (Cow<'a, Robot>, Cow<'a, Self>) {
        if !robot.has_dynamic_stiffness() {
            return (Cow::Borrowed(robot), Cow::Borrowed(self));
        }
        let (mut stiffer, mut rest) = (robot.clone(), self.clone());
        for (cable, state) in stiffer.cables.iter_mut().zip(&self.cables) {
            replace_rope(cable, state);
        }

        let settled = stiffer.displaced(&self.support_displacements(robot));
        for (i, state) in rest.cables.iter_mut().enumerate() {
            if robot.cables[i].material.dynamic_axial_stiffness.is_some() && self.model != StaticModel::Ideal {
                hang_with_same_tension(state, &LoadedCable::at(&settled, i, &self.pose, self.model));
            }
        }
        rest.residual = residual_of(&stiffer, &rest.pose, &rest.cables);
        if self.model != StaticModel::Ideal {
            rest = with_stability(&stiffer, rest);
        }
        (Cow::Owned(stiffer), Cow::Owned(rest))
    }
}

/// Gives a cable the rope with which it vibrates: equations (27h) and (27i).
fn replace_rope(cable: &mut Cable, state: &CableState) {
    let rope = &mut cable.material;
    let Some(stiffness) = rope.dynamic_axial_stiffness.take() else { return };
    let tension = 0.5 * (state.tension_platform + state.tension_anchor);
    let shorter = (1.0 + tension / stiffness) / (1.0 + tension / rope.axial_stiffness);

    rope.axial_stiffness = stiffness;
    rope.mass_per_length *= shorter;
    rope.load_per_length_w *= shorter;
    if let Damping::Viscous(coefficient) = &mut rope.damping {
        *coefficient *= shorter;
    }
    if let Some(width) = &mut rope.drag_width {
        *width *= shorter;
    }
    cable.load_per_length_w *= shorter;
}

/// Gives a cable the unstrained length with which its free span has the tension that it has in this state.
fn hang_with_same_tension(state: &mut CableState, cable: &LoadedCable) {
    let Some(wanted) = state.hanging.as_ref().map(|span| span.catenary.parallel_tension()) else { return };
    if state.is_slack() {
        return;
    }
    let hang = |length: f64| CableAtRest::hang(state.attachment_w, cable.cable, &cable.load, length);
    let missing = |found: &CableAtRest| found.span.catenary.parallel_tension() - wanted;

    // Secant method: the tension is a smooth, falling function of the length.
    let mut length = state.unstrained_length;
    let mut found = hang(length);
    let mut last = (length * (1.0 + FIRST_STEP), missing(&hang(length * (1.0 + FIRST_STEP))));
    for _ in 0..MAX_STEPS {
        let here = missing(&found);
        let step = here * (last.0 - length) / (last.1 - here);
        if here.abs() <= SAME_TENSION * wanted || !step.is_finite() {
            break;
        }
        last = (length, here);
        length -= step;
        found = hang(length);
    }

    state.unstrained_length = length;
    state.anchor_w = found.span.end_w;
    state.force_on_platform_w = found.force_w();
    state.tension_platform = found.span.catenary.tension_at_start();
    state.tension_anchor = found.span.catenary.tension_at_end();
    state.hanging = Some(found.span);
    state.drive = found.drive;
}
