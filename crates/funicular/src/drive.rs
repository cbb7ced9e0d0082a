//! Cable at rest between the platform and its winch: the free span, the arc on the pulley, the drum side and the winch.
//!
//! Friction and weight beyond the entry point are left out; [`DriveAtRest::with_friction`] adds the friction of the
//! pulley to a cable that was found without it. In a cable without friction the sum ψ(T) + q·p, with ψ(T) = T + T²/2EA,
//! is constant from the platform to the entry point; between entry point and drum the tension is that at the entry
//! point. The unknowns are the place of the cable on the pulley (wrap and swivel angle) and the unstrained length of
//! the free span. The conditions are that the cable leaves the wheel along its tangent, that the swivel is balanced,
//! and that the unstrained lengths of all pieces add up (docs/theory.md, section 18).
//!
//! With respect to the platform, such a cable is a hanging cable in series with its anchor end: [`AnchorEnd`]. It has
//! an energy, whose gradient is the force of the cable. So the searches for equilibria treat all cables alike.

mod anchor_end;
mod arc;
pub(crate) mod at_tension;
mod balance;
mod chain;
pub(crate) mod derivatives;
mod friction;

pub use anchor_end::AnchorEnd;
pub(crate) use anchor_end::{DrumSideAtRest, OnSupport};
pub(crate) use chain::{ChainDescription, ChainStretch, Piece};
pub use chain::{DriveChain, Motor, Place};
pub use friction::DriveFriction;

use crate::catenary::Rope;
use crate::catenary::space::HangingCable;
use crate::math::{Mat3, Vec3};
use crate::robot::{Anchor, Cable, LineLoad, PulleyContact, Robot};
use arc::Beyond;
use balance::Unknowns;

/// Cable at rest, from its attachment on the platform to its winch.
#[derive(Debug, Clone, PartialEq)]
pub struct CableAtRest {
    /// Free span, from the attachment to the exit point.
    pub span: HangingCable,
    /// State of pulley, drum side and winch; `None` for a fixed anchor.
    pub drive: Option<Box<DriveAtRest>>,
}

/// State of pulley, drum side and winch of a cable at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveAtRest {
    /// Place of the cable on the pulley; `None` without a pulley.
    pub contact: Option<PulleyContact>,
    /// Sideways angle κ between the cable and the wheel's plane at the exit point [rad], due to the weight of the cable
    /// on a wheel whose swivel axis is not vertical.
    pub kink: f64,
    /// Tension from the entry point to the drum [N].
    pub tension_drum: f64,
    /// Unstrained length on the wheel [m].
    pub arc_length: f64,
    /// Unstrained length from the entry point to the drum [m], less the length paid out by a winch that yields.
    pub drum_side_length: f64,
    /// Length that the winch pays out because it yields [m].
    pub winch_yield: f64,
    /// Potential energy of arc, drum side and winch [J], and of the weight's reference height.
    energy: f64,
    /// Stiffness of the cable's end at the exit point.
    pub end: AnchorEnd,
}

impl CableAtRest {
    /// Cable `i` of a robot with its attachment at a point of the world [m] and this unstrained length [m], drum side
    /// included. The drag of the wind is that of a straight cable.
    ///
    /// # Example
    /// ```
    /// use funicular::{drive::CableAtRest, math::Vec3, robot::Robot};
    ///
    /// let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
    /// let cable = CableAtRest::of(&robot, 0, Vec3::new(0.0, 0.0, 0.5), 6.863);
    /// assert!(cable.drive.is_none() && cable.force_w().z > 0.0); // N
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(robot: &Robot, i: usize, attachment_w: Vec3, unstrained_length: f64) -> Self {
        let cable = &robot.cables[i];
        let load = robot.line_load(i, &(cable.anchor.exit_w(&attachment_w) - attachment_w));
        Self::hang(attachment_w, cable, &load, unstrained_length)
    }

    /// Hanging cable whose end is held at the anchor.
    pub(crate) fn fixed(span: HangingCable) -> Self {
        Self { span, drive: None }
    }

    /// Cable of an unstrained length [m], drum side included, that ends at `start_w` on the platform. `load` is its
    /// load per unstrained length.
    #[inline]
    pub(crate) fn hang(start_w: Vec3, cable: &Cable, load: &LineLoad, unstrained_length: f64) -> Self {
        let rope = rope_of(cable, load, unstrained_length);
        if cable.anchor.is_fixed() {
            return Self::fixed(HangingCable::between(start_w, cable.anchor.point_w, load.up_w, rope));
        }
        balance::at_length(start_w, &cable.anchor, load, rope)
    }

    /// Cable with a free span that leaves the pulley at `contact`; its unstrained length follows from both.
    pub(crate) fn with_span(span: HangingCable, anchor: &Anchor, contact: Option<PulleyContact>) -> Self {
        if anchor.is_fixed() {
            return Self::fixed(span);
        }
        let beyond = Beyond::of(&span, anchor, contact.as_ref());
        let drive = DriveAtRest::new(&span, anchor, contact, &beyond);
        Self { span, drive: Some(Box::new(drive)) }
    }

    /// Unstrained length from the attachment to the drum [m].
    pub fn unstrained_length(&self) -> f64 {
        let free = self.span.catenary.rope().unstrained_length;
        self.drive.as_ref().map_or(free, |drive| free + drive.arc_length + drive.drum_side_length)
    }

    /// Force of the cable on the platform [N].
    #[inline]
    pub fn force_w(&self) -> Vec3 {
        self.span.force_on_start_w()
    }

    /// Stiffness of the cable at the platform, its length held; 3×3, world axes, symmetric [N/m].
    pub fn tangent_w(&self) -> Mat3 {
        tangent_w(&self.span, self.drive.as_deref())
    }

    /// Derivative of the force on the platform with respect to the unstrained length [N/m].
    pub fn force_by_length_w(&self) -> Vec3 {
        force_by_length_w(&self.span, self.drive.as_deref())
    }

    /// Potential energy [J]; its gradient with respect to the start is minus [`Self::force_w`].
    /// Weight is counted from the world's origin, over a pulley and on a winch from the entry point.
    pub fn energy(&self) -> f64 {
        self.span.energy() + self.drive.as_ref().map_or(0.0, |drive| drive.energy)
    }
}

/// Cable beyond its free span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BeyondExit {
    /// Unstrained length from the exit point to the drum [m].
    pub(crate) length: f64,
    /// Tension from the entry point to the drum [N].
    pub(crate) tension_drum: f64,
}

impl BeyondExit {
    /// Part beyond a span that ends at the anchor's point, or at the exit point of `contact`.
    pub(crate) fn of(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Self {
        if anchor.is_fixed() {
            return Self { length: 0.0, tension_drum: span.catenary.tension_at_end() };
        }
        let beyond = Beyond::of(span, anchor, contact);
        Self { length: beyond.length(), tension_drum: beyond.tension_entry }
    }
}

/// Cable at rest, as [`CableAtRest`], in one piece: without memory from the heap, for control loops.
#[derive(Debug, Clone)]
pub(crate) struct CableInLoop {
    /// Free span.
    pub(crate) span: HangingCable,
    /// State of its drive; `None` for a fixed anchor.
    pub(crate) drive: Option<DriveAtRest>,
}

impl CableInLoop {
    /// Cable of an unstrained length [m], drum side included, as [`CableAtRest::hang`]. The search starts at the place
    /// and the free length of `near`, and takes a bounded number of steps; `None` if it fails.
    pub(crate) fn hang(
        start_w: Vec3,
        cable: &Cable,
        load: &LineLoad,
        unstrained_length: f64,
        near: Option<&Self>,
    ) -> Option<Self> {
        let rope = rope_of(cable, load, unstrained_length);
        if cable.anchor.is_fixed() {
            let span = HangingCable::between(start_w, cable.anchor.point_w, load.up_w, rope);
            return Some(Self { span, drive: None });
        }
        let start = near.and_then(|near| {
            let free_length = near.span.catenary.rope().unstrained_length;
            Some(Unknowns { contact: near.drive.as_ref()?.contact, free_length })
        });
        let (span, contact) = balance::at_length_near(start_w, &cable.anchor, load, rope, start)?;
        let beyond = Beyond::of(&span, &cable.anchor, contact.as_ref());
        let drive = DriveAtRest::new(&span, &cable.anchor, contact, &beyond);
        Some(Self { span, drive: Some(drive) })
    }

    /// Stiffness of the cable at the platform, as [`CableAtRest::tangent_w`].
    pub(crate) fn tangent_w(&self) -> Mat3 {
        tangent_w(&self.span, self.drive.as_ref())
    }

    /// Tension at the drum [N]; that at the anchor without a drive.
    pub(crate) fn tension_drum(&self) -> f64 {
        self.drive.as_ref().map_or_else(|| self.span.catenary.tension_at_end(), |drive| drive.tension_drum)
    }
}

/// Stiffness of a cable at the platform, its length held; 3×3, world axes, symmetric [N/m]. `drive` is the state of its
/// drive, `None` for a fixed anchor.
///
/// # References
/// docs/theory.md, equation (70).
pub(crate) fn tangent_w(span: &HangingCable, drive: Option<&DriveAtRest>) -> Mat3 {
    let held = span.tangent_w();
    drive.map_or(held, |drive| drive.end.in_series_with(&held))
}

/// Static stiffness of a cable for a motion of its anchor. `held` is the stiffness of its span; `side` is its drum
/// side, if its drum stays on the ground.
pub(crate) fn on_support(held: &Mat3, drive: Option<&DriveAtRest>, side: Option<DrumSideAtRest>) -> OnSupport {
    match (drive, side) {
        (None, _) => OnSupport::moving_together(*held),
        (Some(drive), None) => OnSupport::moving_together(drive.end.in_series_with(held)),
        (Some(drive), Some(side)) => drive.end.with_drum_on_ground(held, &side),
    }
}

/// Derivative of the force of a cable on the platform with respect to its unstrained length [N/m].
///
/// # References
/// docs/theory.md, equation (70).
pub(crate) fn force_by_length_w(span: &HangingCable, drive: Option<&DriveAtRest>) -> Vec3 {
    match drive {
        None => span.force_by_length_w(),
        Some(drive) => drive.end.force_by_length_w(&span.tangent_w()).unwrap_or_else(|| span.force_by_length_w()),
    }
}

impl DriveAtRest {
    fn new(span: &HangingCable, anchor: &Anchor, contact: Option<PulleyContact>, beyond: &Beyond) -> Self {
        let end = AnchorEnd::of(span, contact.as_ref(), beyond);
        // The energy of the span counts its weight from the world's origin; that of a cable whose pieces change their
        // lengths has to count it from a fixed point of the cable's path.
        let length = span.catenary.rope().unstrained_length;
        let reference = span.load_w().dot(&anchor.point_w) * length;
        Self {
            contact,
            kink: beyond.kink,
            tension_drum: beyond.tension_entry,
            arc_length: beyond.arc_length,
            drum_side_length: beyond.drum_side_length,
            winch_yield: beyond.winch_yield,
            energy: beyond.energy + reference,
            end,
        }
    }
}

/// Forces on the end of a cable when the frame turns: the wheel and the drum side turn, and weight and span stay in the
/// world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ByTurn {
    /// Forces on the motions (σ, v) of the end [N].
    pub(crate) on_end: [f64; 2],
    /// Displacement of the end of the drum side at the wheel that stretches arc and drum side as much as the weight on
    /// the turned arc does, towards the platform, measured with the stretch at the exit point [m].
    pub(crate) stretched: f64,
}

impl DriveAtRest {
    /// Forces on the end of the cable per rotation of its anchor about the entry point [rad].
    ///
    /// # References
    /// docs/theory.md, equation (83a).
    pub(crate) fn by_turn(&self, span: &HangingCable, anchor: &Anchor, turn_w: &Vec3) -> ByTurn {
        let Some(contact) = &self.contact else { return ByTurn::default() };
        let (load_w, force_w, wheel) = (span.load_w(), end_force_w(span), contact.wheel());
        let beyond = Beyond::of(span, anchor, Some(contact));
        let turned = |of_w: Vec3| turn_w.cross(&of_w);

        let along =
            force_w.dot(&turned(self.end.travel_w)) + load_w.dot(&turned(contact.exit_offset_w())) / beyond.stretch;
        let sideways_w = turned(contact.sideways_w);
        let distance = contact.distance_from_axis();
        let arc = if distance > 0.0 { load_w.dot(&sideways_w) * beyond.moment / distance } else { 0.0 };
        let axial_stiffness = span.catenary.rope().axial_stiffness;
        let moment_w = beyond.compliance_moment(&load_w, axial_stiffness, &wheel);
        ByTurn {
            on_end: [along, force_w.dot(&sideways_w) + arc],
            stretched: beyond.stretch * load_w.dot(&turned(moment_w)),
        }
    }

    /// Mass that the swivel of the anchor's pulley adds to the sideways motion of the exit point [kg]; zero without a
    /// swivel.
    pub(crate) fn swivel_mass(&self, anchor: &Anchor) -> f64 {
        let distance = self.contact.as_ref().map_or(0.0, PulleyContact::distance_from_axis);
        match &anchor.pulley {
            Some(pulley) if distance > 0.0 => pulley.swivel_inertia / (distance * distance),
            _ => 0.0,
        }
    }
}

/// Rope of a cable with its load.
fn rope_of(cable: &Cable, load: &LineLoad, unstrained_length: f64) -> Rope {
    let axial_stiffness = cable.material.axial_stiffness;
    Rope { unstrained_length, weight_per_length: load.size, axial_stiffness }
}

/// Force with which a span pulls at its end towards the platform, world axes [N].
fn end_force_w(span: &HangingCable) -> Vec3 {
    let (along_w, up_w) = span.axes_w();
    -(along_w * span.catenary.horizontal_force() + up_w * span.catenary.vertical_force_at_end())
}

pub(crate) use arc::{arc_nodes, stretch_of, tension_at_drum, tension_of};
pub(crate) use balance::contact_of_span;

#[cfg(test)]
mod tests;
