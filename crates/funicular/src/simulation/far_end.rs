//! Far end of a rope: the exit point on a pulley that swivels, on a support that yields, with rope that passes it.
//!
//! Within a step the wrap angle is held, so that the exit point moves with swivel and support alone. Between two steps
//! the wheel rolls until the rope leaves it along its tangent. A rope that leaves the wheel δ too early or too late is
//! longer by `r δ³/6` only, so that a small δ costs nothing.

use super::feed::{ArcParts, Feed, FeedForces, arc_parts};
use super::rope::{RopeEnergy, RopeMesh, WoundLength};
use crate::math::{Mat3, Vec3};
use crate::robot::{Anchor, PulleyContact, Robot, Support};
use crate::statics::CableState;

/// Wrap angle [rad] below which the exit point is so near the swivel axis that it cannot move sideways.
const MIN_WRAP: f64 = 1e-3;
/// Tension below which a rope has no direction at its exit point [N].
const SLACK: f64 = 0.1;
/// Largest change of a wrap angle between two steps [rad], for a rope that whips.
const MAX_ROLL: f64 = 0.05;

/// Support of an anchor.
#[derive(Debug, Clone, Copy)]
pub(super) struct SupportedEnd {
    /// Index of the support.
    pub(super) index: usize,
    /// Drum side from the ground to the entry point without a displacement [m], if the drum stays there.
    pub(super) from_ground_w: Option<Vec3>,
}

impl SupportedEnd {
    /// Length of a drum side from the ground, whose weight is not the support's [m].
    fn length_from_ground(&self) -> f64 {
        self.from_ground_w.map_or(0.0, |side_w| side_w.norm())
    }
}

/// Far end of a rope that does more than stay where it is.
#[derive(Debug, Clone)]
pub(super) struct FarEnd {
    /// Entry point without a displacement of the support.
    pub(super) entry_w: Vec3,
    /// Place of the rope on the pulley, with the swivel where it was at the last roll.
    pub(super) contact: Option<PulleyContact>,
    swivel_inertia: f64,
    pub(super) support: Option<SupportedEnd>,
    pub(super) feed: Option<Feed>,
    /// Angle by which the rope leaves the wheel off its tangent, without fast waves [rad].
    pub(super) off_tangent: f64,
    /// Value of it at the beginning of the last step [rad].
    pub(super) off_tangent_before: f64,
}

/// Places among the coordinates of a far end: swivel (as the arc rγ), stations, integral of a servo's error, delayed
/// error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FarPlaces {
    pub(super) swivel: Option<usize>,
    pub(super) feed: Option<usize>,
    pub(super) integral: Option<usize>,
    pub(super) delayed: Option<usize>,
    pub(super) count: usize,
}

/// Motion of the exit point: place, velocity, acceleration.
pub(super) type ExitMotion = [Vec3; 3];

impl FarEnd {
    /// Far end of a cable; `None` for one that stays where it is. `holds_tension` says that its winch will.
    pub(super) fn of(robot: &Robot, i: usize, state: &CableState, holds_tension: bool) -> Option<Self> {
        let cable = &robot.cables[i];
        let Anchor { point_w, pulley, support, .. } = &cable.anchor;
        let ea = cable.material.axial_stiffness;
        let mut feed = Feed::of(&cable.anchor, state, ea, cable.material.mass_per_length);
        if feed.is_none() && holds_tension {
            feed = Some(Feed::plain(ea));
        }
        let contact = state.drive.as_ref().and_then(|drive| drive.contact);
        if contact.is_none() && support.is_none() && feed.is_none() {
            return None;
        }
        let on_support = |index: usize| {
            let of: &Support = &robot.supports[index];
            let direction_w = of.drum_side_from_ground(&cable.anchor);
            let length = cable.anchor.drum_side_length();
            SupportedEnd { index, from_ground_w: direction_w.map(|direction_w| direction_w * length) }
        };
        Some(Self {
            entry_w: *point_w,
            contact,
            swivel_inertia: pulley.as_ref().map_or(0.0, |pulley| pulley.swivel_inertia),
            support: support.map(on_support),
            feed,
            off_tangent: 0.0,
            off_tangent_before: 0.0,
        })
    }

    /// Loose end of the half of a broken rope, whose place is that of a support.
    pub(super) fn loose(support: usize) -> Self {
        Self {
            entry_w: Vec3::zeros(),
            contact: None,
            swivel_inertia: 0.0,
            support: Some(SupportedEnd { index: support, from_ground_w: None }),
            feed: None,
            off_tangent: 0.0,
            off_tangent_before: 0.0,
        }
    }

    pub(super) fn places(&self) -> FarPlaces {
        let mut count = 0;
        let mut take = |of: usize| {
            count += of;
            count - of
        };
        let swivel = self.contact.is_some().then(|| take(1));
        let feed = self.feed.as_ref().map(|feed| take(feed.count()));
        let integral = self.feed.as_ref().filter(|feed| feed.has_integral()).map(|_| take(1));
        let delayed = self.feed.as_ref().and_then(Feed::delayed_servo).map(|_| take(1));
        FarPlaces { swivel, feed, integral, delayed, count }
    }

    /// True if the swivel can move.
    fn swivels(&self) -> bool {
        self.contact.is_some_and(|contact| contact.wrap > MIN_WRAP)
    }

    /// Place of the rope on the pulley with the swivel moved by the arc `swivel` [m].
    fn contact_at(&self, swivel: f64) -> Option<PulleyContact> {
        self.contact.map(|contact| contact.turned(0.0, swivel / contact.radius))
    }

    /// Motion of the exit point with numbers of this far end and the motion of its support.
    pub(super) fn exit(&self, z: [f64; 3], support: &ExitMotion) -> ExitMotion {
        let [place, velocity, acceleration] = *support;
        let entry_w = self.entry_w + place;
        let Some(contact) = self.contact_at(z[0]) else { return [entry_w, velocity, acceleration] };
        let (rate, change) = (z[1] / contact.radius, z[2] / contact.radius);
        let distance = contact.distance_from_axis();
        [
            entry_w + contact.exit_offset_w(),
            velocity + contact.sideways_w * (distance * rate),
            acceleration + (contact.sideways_w * change - contact.center_w * (rate * rate)) * distance,
        ]
    }

    /// Direction in which the exit point moves per arc of the swivel.
    pub(super) fn sideways_w(&self, swivel: f64) -> Option<Vec3> {
        let contact = self.contact_at(swivel).filter(|_| self.swivels())?;
        Some(contact.sideways_w * (contact.distance_from_axis() / contact.radius))
    }
}

/// The two sides of the equation of a delayed number, `T²d″/12 + Td′/2 + d = T²e″/12 − Te′/2 + e`, for a number with
/// its rate and acceleration.
///
/// # References
/// docs/theory.md, equation (97m1).
pub(super) fn delayed_weights(delay: f64, [value, rate, acceleration]: [f64; 3]) -> [f64; 2] {
    let (even, odd) = (value + delay * delay / 12.0 * acceleration, 0.5 * delay * rate);
    [even + odd, even - odd]
}

/// Forces at a far end.
#[derive(Debug, Clone, Default)]
pub(super) struct FarForces {
    pub(super) feed: FeedForces,
    /// Force that the exit point needs, world axes [N].
    pub(super) exit_w: Vec3,
    /// Force that the support needs for this rope, world axes [N].
    pub(super) support_w: Vec3,
    /// Force that the swivel needs, conjugate to its arc, and its stiffness but for the rope's.
    pub(super) swivel: f64,
    pub(super) swivel_stiffness: f64,
    /// Inertia of the swivel over the square of the radius [kg].
    pub(super) swivel_mass: f64,
    /// Stiffness of a drum side from the ground against motion of the support [N/m].
    pub(super) support_stiffness_w: Mat3,
    /// Length of the first piece per motion of the support: the direction of a drum side from the ground.
    pub(super) support_along_w: Vec3,
}

/// Everything that the forces at a far end depend on.
pub(super) struct FarState<'a> {
    pub(super) rope: &'a RopeMesh,
    pub(super) time: f64,
    /// Commanded length.
    pub(super) given: WoundLength,
    /// Free unstrained length.
    pub(super) free: WoundLength,
    /// Positions, velocities and accelerations of its coordinates.
    pub(super) z: [&'a [f64]; 3],
    /// Displacement of its support.
    pub(super) support_w: Vec3,
    /// Displacement of the anchor since the start.
    pub(super) moved_w: Vec3,
    /// Force that the last station needs, conjugate to its length [N]; zero without a feed.
    pub(super) held: f64,
    /// Lagrange's force of the last node, and its velocity and slope.
    pub(super) node_w: Vec3,
    pub(super) velocity_w: Vec3,
    pub(super) slope_w: Vec3,
}

impl FarEnd {
    fn arc(&self, swivel: f64, load_w: &Vec3) -> Option<ArcParts> {
        self.contact_at(swivel).map(|contact| arc_parts(&contact, load_w))
    }

    /// Forces of the feed alone.
    pub(super) fn feed_forces(&self, of: &FarState) -> FeedForces {
        let places = self.places();
        let (Some(feed), Some(at)) = (&self.feed, places.feed) else { return FeedForces::default() };
        let swivel = places.swivel.map_or(0.0, |at| of.z[0][at]);
        let arc = self.arc(swivel, &of.rope.load_w);
        feed.forces(of.time, &of.given, (&of.z[0][at..], &of.z[1][at..]), (arc.as_ref(), self.longer(&of.support_w)))
    }

    /// By how much a drum side from the ground is longer than without a displacement of the support [m].
    fn longer(&self, support_w: &Vec3) -> f64 {
        let side_w = self.support.and_then(|support| support.from_ground_w);
        side_w.map_or(0.0, |side_w| (side_w + support_w).norm() - side_w.norm())
    }

    /// Unstrained lengths of the stations at rest.
    pub(super) fn stations_at_rest(&self, free: f64, tension_entry: f64, load_w: &Vec3, support_w: &Vec3) -> Vec<f64> {
        let Some(feed) = &self.feed else { return Vec::new() };
        let psi = feed.psi(tension_entry);
        feed.at_rest(free, psi, self.arc(0.0, load_w).as_ref(), self.longer(support_w))
    }

    /// Forces that the far end needs.
    ///
    /// # References
    /// docs/theory.md, equations (97l) to (97o).
    pub(super) fn forces(&self, of: &FarState) -> FarForces {
        let places = self.places();
        let load_w = of.rope.load_w;
        let mut out = FarForces { feed: self.feed_forces(of), ..FarForces::default() };

        // Rope that passes the exit point takes its momentum along.
        let passing_w = of.velocity_w - of.slope_w * (of.free.rate / of.free.value);
        out.exit_w = of.node_w - passing_w * (of.rope.mass * of.free.rate);

        if let (Some(at), Some(contact)) = (places.swivel, self.contact) {
            let radius = contact.radius;
            let turned = contact.turned(0.0, of.z[0][at] / radius);
            let moment = |(angle, length): (f64, f64)| length * contact.offset_w(angle).dot(&contact.center_w);
            let first: f64 = crate::drive::arc_nodes(&contact.wheel()).map(moment).sum();
            let square = radius * radius;
            out.swivel_mass = self.swivel_inertia / square;
            let lever = turned.distance_from_axis() / radius;
            out.swivel = lever * turned.sideways_w.dot(&out.exit_w) - load_w.dot(&turned.sideways_w) * first / radius
                + out.swivel_mass * of.z[2][at];
            out.swivel_stiffness =
                -lever / radius * turned.center_w.dot(&out.exit_w) + load_w.dot(&turned.center_w) * first / square;
        }
        if let Some(support) = self.support {
            self.load_support(&support, of, &mut out);
        }
        out
    }

    /// Force on the support: of the exit point, of the weight behind it, and of a drum side from the ground.
    fn load_support(&self, support: &SupportedEnd, of: &FarState, out: &mut FarForces) {
        out.support_w = out.exit_w;
        let behind = self.whole(of.given, of.z, of.free).value - of.free.value - support.length_from_ground();
        out.support_w -= of.rope.load_w * behind;
        if let Some(side_w) = support.from_ground_w {
            let along_w = side_w + of.support_w;
            let length = along_w.norm();
            let direction_w = along_w / length;
            out.support_w += direction_w * out.feed.tension_entry;
            out.support_along_w = direction_w;
            let across = Mat3::identity() - direction_w * direction_w.transpose();
            out.support_stiffness_w = across * (out.feed.tension_entry / length);
        }
    }

    /// Unstrained length from the platform to what holds the rope: the drum, or the end of the commanded length.
    pub(super) fn whole(&self, given: WoundLength, z: [&[f64]; 3], free: WoundLength) -> WoundLength {
        match (&self.feed, self.places().feed) {
            (Some(feed), Some(at)) => feed.whole(given, z.map(|of| &of[at..])),
            _ => free,
        }
    }

    /// Energies and powers of what lies behind the exit point.
    pub(super) fn energy(&self, of: &FarState) -> RopeEnergy {
        let (places, forces) = (self.places(), self.forces(of));
        let rope = of.rope;
        let mut energy = RopeEnergy::default();
        if let Some(at) = places.swivel {
            energy.kinetic += 0.5 * forces.swivel_mass * of.z[1][at].powi(2);
        }
        let (Some(feed), Some(at)) = (&self.feed, places.feed) else { return energy };
        let scale = feed.stretch * feed.stretch;
        for (mass, rate) in feed.masses.iter().zip(&of.z[1][at..]) {
            energy.kinetic += 0.5 * scale * mass * rate * rate;
        }
        energy.strain = forces.feed.strain;
        energy.dissipation = forces.feed.dissipation;

        // Rope on the wheel has its own heights, and all behind it that of the entry point.
        let entry_w = self.entry_w + of.support_w + of.moved_w;
        let weight_w = rope.gravity_w * rope.mass;
        let dead_w = rope.load_w - weight_w;
        let whole = self.whole(of.given, of.z, of.free);
        let mut behind = whole.value - of.free.value - self.support.map_or(0.0, |support| support.length_from_ground());
        if let Some(contact) = self.contact_at(places.swivel.map_or(0.0, |at| of.z[0][at])) {
            let psi = feed.psi(forces.feed.tension_entry);
            for (angle, length) in crate::drive::arc_nodes(&contact.wheel()) {
                let offset_w = contact.offset_w(angle);
                let content = length / feed.stretch_at(psi - rope.load_w.dot(&offset_w));
                energy.potential -= weight_w.dot(&(entry_w + offset_w)) * content;
                behind -= content;
            }
            energy.loads += dead_w.dot(&contact.exit_offset_w()) * of.free.rate;
        }
        energy.potential -= weight_w.dot(&entry_w) * behind;
        let held = if feed.follows_command() { of.held * whole.rate } else { 0.0 };
        energy.winch = forces.feed.power + held - weight_w.dot(&entry_w) * whole.rate;
        energy
    }

    /// Change of the wrap angle after which the rope leaves the wheel along its tangent [rad].
    pub(super) fn missing_wrap(&self, swivel: f64, exit_w: &Vec3) -> f64 {
        let Some(contact) = self.contact_at(swivel) else { return 0.0 };
        let force_w = -exit_w;
        let (along, across) = (force_w.dot(&contact.exit_direction_w()), force_w.dot(&contact.exit_normal_w()));
        if along <= SLACK { 0.0 } else { across.atan2(along).clamp(-MAX_ROLL, MAX_ROLL) }
    }

    /// Rolls the wheel: the wrap angle grows by `wrap`, and the swivel becomes where it is. Returns by how much
    /// unstrained rope the free span becomes shorter.
    pub(super) fn roll(&mut self, wrap: f64, swivel: f64, tension: f64, axial_stiffness: f64) -> f64 {
        let Some(contact) = self.contact else { return 0.0 };
        let wrap = wrap.max(-contact.wrap);
        self.contact = Some(contact.turned(wrap, swivel / contact.radius));
        let shorter = contact.radius * wrap / (1.0 + tension / axial_stiffness);
        // What leaves the free span lies between it and the winch.
        if let Some(feed) = self.feed.as_mut().filter(|feed| feed.count() == 1) {
            feed.behind += shorter;
        }
        shorter
    }
}

#[cfg(test)]
mod tests {
    use super::delayed_weights;
    use crate::math::Complex;

    /// The size of a delayed number is right at every frequency, and its angle falls behind the delay's by 1.3e-3 at
    /// one radian.
    #[test]
    fn a_delayed_number_has_the_phase_of_the_delay() {
        let delay = 0.01;
        let response = |angle: f64| {
            let lambda = Complex::i() * (angle / delay);
            // The sides are linear in value, rate and acceleration.
            let side = |k: usize| {
                let of = |number: [f64; 3]| Complex::from(delayed_weights(delay, number)[k]);
                of([1.0, 0.0, 0.0]) + of([0.0, 1.0, 0.0]) * lambda + of([0.0, 0.0, 1.0]) * lambda * lambda
            };
            side(1) / side(0)
        };
        for (angle, bound) in [(0.1, 1.5e-8), (1.0, 1.4e-3)] {
            let found = response(angle);
            let off = (found.arg() + angle).abs();
            assert!((found.norm() - 1.0).abs() < 1e-12 && off < bound && off > 0.8 * bound, "{angle}: {off:e}");
        }
    }
}
