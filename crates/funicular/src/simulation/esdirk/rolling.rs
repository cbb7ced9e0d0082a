//! Wheels that roll between two steps, until their ropes leave them along their tangents.

use super::Stepper;
use crate::simulation::rope::WoundLength;

/// Angle off the tangent at which a rope may leave its wheel [rad]: the rope is then longer by `r δ³/6`, 2e-11 m at a
/// radius of a tenth of a metre. At rest it is rounding.
const MIN_WRAP: f64 = 1e-3;
const MIN_WRAP_AT_REST: f64 = 1e-12;
/// Time constant with which a wheel follows its rope [s]: waves at the end of a rope are faster, the motion of a
/// platform slower. A rope that turns with 1 rad/s is then 0.01 rad off its tangent, and 2e-8 m longer at a radius of
/// 0.1 m.
const ROLLING_TIME: f64 = 0.01;

/// Occasion on which wheels roll.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rolling {
    /// The robot is at rest.
    AtRest,
    /// Between two steps.
    Between,
}

impl Stepper {
    /// Follows how far the ropes leave their wheels off their tangents, without the fast waves of their ends.
    pub(in crate::simulation) fn follow_tangents(&mut self, lengths: &[WoundLength], duration: f64) {
        for (i, given) in lengths.iter().enumerate() {
            if let Some(far) = &mut self.system.far_ends[i] {
                far.off_tangent_before = far.off_tangent;
            }
            if self.system.far_ends[i].as_ref().is_none_or(|far| far.contact.is_none()) {
                continue;
            }
            let Some(forces) = self.system.far_forces(i, self.time, given, &self.now, &self.needed) else { continue };
            let from = self.system.of_far_end(i).start;
            let Some(far) = &mut self.system.far_ends[i] else { continue };
            let swivel = far.places().swivel.map_or(0.0, |at| self.now.x[from + at]);
            let missing = far.missing_wrap(swivel, &forces.exit_w);
            far.off_tangent += (missing - far.off_tangent) * -(-duration / ROLLING_TIME).exp_m1();
        }
    }

    /// Rolls each wheel whose rope leaves it too far off its tangent; `true` if there was one. The rope stays where it
    /// is: its free length changes, and its nodes move along it.
    ///
    /// # References
    /// docs/theory.md, equation (97o).
    pub(super) fn roll_wheels(&mut self, when: Rolling) -> bool {
        let lengths = self.system.lengths(self.time);
        let mut has_rolled = false;
        for (i, given) in lengths.iter().enumerate() {
            let Some(forces) = self.system.far_forces(i, self.time, given, &self.now, &self.needed) else { continue };
            let (numbers, free) = (self.system.of_far_end(i), self.system.free_length(i, given, &self.now));
            let stiffness = self.system.ropes[i].stiffness;
            let Some(far) = &mut self.system.far_ends[i] else { continue };
            let places = far.places();
            let (Some(swivel), Some(length)) = (places.swivel, places.feed) else { continue };
            let turned = self.now.x[numbers.start + swivel];
            let (wrap, least) = match when {
                Rolling::AtRest => (far.missing_wrap(turned, &forces.exit_w), MIN_WRAP_AT_REST),
                Rolling::Between => (far.off_tangent, MIN_WRAP),
            };
            if wrap.abs() <= least {
                continue;
            }
            has_rolled = true;
            far.off_tangent = 0.0;
            let after = free.value - far.roll(wrap, turned, forces.exit_w.norm(), stiffness);
            self.now.x[numbers.start + swivel] = 0.0;
            self.now.x[numbers.start + length] = after;
            let (rope, range) = (&self.system.ropes[i], self.system.of_rope(i));
            for of in [&mut self.now.x, &mut self.now.v] {
                let moved = rope.resampled(free.value, after, &of[range.clone()]);
                of[range.clone()].copy_from_slice(&moved);
            }
        }
        if has_rolled {
            self.evaluate(&lengths);
        }
        has_rolled
    }
}
