//! Friction of pulleys: tension at the drum and unstrained length beyond the exit point of a cable with friction.

use super::DriveAtRest;
use super::arc::{arc_nodes, stretch_of};
use crate::catenary::space::HangingCable;
use crate::robot::{Anchor, PulleyContact, PulleyFriction};

/// Cable with friction on its pulley, compared with the cable of equal free span without friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveFriction {
    /// Tension at the drum [N].
    pub tension_drum: f64,
    /// Unstrained length beyond the exit point less that without friction [m].
    pub excess_length: f64,
}

impl DriveAtRest {
    /// Friction exponent Θ of the cable's pulley; zero without friction. `anchor` is the anchor of the cable.
    ///
    /// # References
    /// docs/theory.md, equation (71).
    pub fn friction_exponent(&self, anchor: &Anchor) -> f64 {
        self.friction(anchor).map_or(0.0, |(friction, contact)| friction.exponent(contact.radius, contact.wrap))
    }

    /// Effect of friction beyond the exit point, with the free span held. `used` is the fraction of the friction that
    /// acts: 1 if the cable last ran towards the platform, −1 if it last ran towards the drum, and any value between.
    ///
    /// # References
    /// docs/theory.md, equations (72) and (73).
    pub fn with_friction(&self, span: &HangingCable, anchor: &Anchor, used: f64) -> DriveFriction {
        let ea = span.catenary.rope().axial_stiffness;
        let mut result = DriveFriction { tension_drum: self.tension_drum, excess_length: 0.0 };
        let Some((friction, contact)) = self.friction(anchor) else { return result };

        // Arc on the wheel. A piece dp of the strained cable has the unstrained length dp/λ.
        let (load_w, exit) = (span.load_w(), contact.exit_offset_w());
        let tension_exit = span.catenary.tension_at_end();
        let potential_exit = tension_exit * (1.0 + 0.5 * tension_exit / ea);
        for (angle, arc) in arc_nodes(&contact.wheel()) {
            let potential = potential_exit + load_w.dot(&(exit - contact.offset_w(angle)));
            let stretch = stretch_of(potential, ea);
            let tension = 2.0 * potential / (1.0 + stretch);
            let lost = lost_tension(tension, used * friction.exponent_from_exit(contact.radius, contact.wrap, angle));
            result.excess_length += arc * lost / (ea * stretch * (stretch - lost / ea));
        }

        // Drum side and winch.
        let lost = lost_tension(self.tension_drum, used * friction.exponent(contact.radius, contact.wrap));
        result.tension_drum -= lost;
        if let Some(winch) = &anchor.winch {
            let stretch = 1.0 + self.tension_drum / ea;
            let by_tension = winch.drum_side_length / ea + winch.compliance();
            result.excess_length += lost * by_tension / (stretch * (stretch - lost / ea));
        }

        result
    }

    /// Friction of the cable's pulley, and the place of the cable on it.
    fn friction(&self, anchor: &Anchor) -> Option<(PulleyFriction, &PulleyContact)> {
        let friction = anchor.pulley.as_ref()?.friction?;
        Some((friction, self.contact.as_ref()?))
    }
}

/// Tension that friction takes away between the exit point and a point behind it [N]: `T (1 − e^−exponent)`.
fn lost_tension(tension: f64, exponent: f64) -> f64 {
    -tension * (-exponent).exp_m1()
}
