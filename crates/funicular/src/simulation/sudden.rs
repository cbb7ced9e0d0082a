//! Changes of platform and cables that happen at once.

use super::body::{BodyMotion, MovingBody, halves, joined};
use super::esdirk::Stepper;
use super::event::EventFault;
use super::feed::WinchHold;
use super::rope::WoundLength;
use super::system::{MovingSupport, RopeEnd, System, six};
use super::winding::Winding;
use crate::math::{Mat3, Mat6, Vec3, Vec6, inverse6, skew};

/// Inertia of a point mass about a point at distance `lever`.
fn of_point(mass: f64, lever: &Vec3) -> Mat3 {
    (Mat3::identity() * lever.norm_squared() - lever * lever.transpose()) * mass
}

impl MovingBody {
    /// Body without a payload that is a part of it.
    pub(super) fn without(&self, mass: f64, point_p: &Vec3) -> Result<Self, EventFault> {
        if mass >= self.mass {
            return Err(EventFault::NegativeMass { mass, of: self.mass });
        }
        let (left, lever) = (self.mass - mass, point_p - self.center_p);
        let inertia_p = self.inertia_p - of_point(mass * self.mass / left, &lever);
        let is_possible = !self.turns() || is_positive(&inertia_p) || lever.norm() == 0.0;
        if !is_possible {
            return Err(EventFault::NegativeInertia { mass });
        }
        Ok(Self { mass: left, inertia_p, center_p: self.center_p - lever * (mass / left), ..self.clone() })
    }

    /// Body with a point mass more.
    pub(super) fn with(&self, mass: f64, point_p: &Vec3) -> Self {
        let (sum, lever) = (self.mass + mass, point_p - self.center_p);
        let inertia_p = self.inertia_p + of_point(mass * self.mass / sum, &lever);
        Self { mass: sum, inertia_p, center_p: self.center_p + lever * (mass / sum), ..self.clone() }
    }

    fn turns(&self) -> bool {
        self.motion.is_some_and(|motion| motion.can_turn())
    }
}

/// True if a symmetric matrix has no eigenvalue below zero but for rounding.
fn is_positive(inertia: &Mat3) -> bool {
    let least = inertia.symmetric_eigenvalues().min();
    least > -1e-12 * inertia.norm()
}

impl Stepper {
    /// Takes a body in place of the present one, at the same place and with the same velocities of its points.
    fn take_body(&mut self, body: MovingBody) {
        let motion = self.system.body_motion(&self.now);
        let shift = body.center_p - self.system.body.center_p;
        let [center, velocity, _] = motion.point(&shift);
        self.now.x[..3].copy_from_slice(center.as_slice());
        self.now.v[..3].copy_from_slice(velocity.as_slice());
        self.system.body = body;
    }

    /// Lets a payload go.
    pub(super) fn release(&mut self, mass: f64, point_p: Option<Vec3>) -> Result<(), EventFault> {
        let body = &self.system.body;
        let without = body.without(mass, &point_p.unwrap_or(body.center_p))?;
        self.take_body(without);
        Ok(())
    }

    /// Takes a payload up: the momentum of payload, platform and the ends of the ropes on it stays.
    ///
    /// # References
    /// docs/theory.md, equation (97k).
    pub(super) fn pick(&mut self, mass: f64, point_p: Option<Vec3>, velocity_w: Option<Vec3>) {
        let point_p = point_p.unwrap_or(self.system.body.center_p);
        let with = self.system.body.with(mass, &point_p);
        let before = self.system.body_motion(&self.now);
        let lever = point_p - self.system.body.center_p;
        let own = before.point(&lever)[1];
        self.take_body(with);

        // Change of the momentum of the payload, which the others take over.
        let impulse_w = (velocity_w.unwrap_or(own) - own) * mass;
        let motion = self.system.body_motion(&self.now);
        let body = &self.system.body;
        let impulse = MovingBody::wrench(&motion, &(point_p - body.center_p), &impulse_w);
        let change = self
            .impulse_matrix(&motion)
            .map_or_else(Vec6::zeros, |inverse| body.expanded(&(inverse * body.reduced(&impulse))));
        let velocity = six(&self.now.v) + change;
        self.now.v[..6].copy_from_slice(velocity.as_slice());
    }

    /// Inverse of the mass of the platform with the masses of the ropes' ends on it, in its coordinates.
    fn impulse_matrix(&self, motion: &BodyMotion) -> Option<Mat6> {
        let body = &self.system.body;
        let lengths = self.system.lengths(self.time);
        let mut matrix = body.matrix(motion, 1.0, 0.0, 0.0);
        for (i, rope) in self.system.ropes.iter().enumerate() {
            if self.system.ends[i] != RopeEnd::Attached {
                continue;
            }
            let turn = -motion.rot_wp * skew(&body.lever_p(i));
            let mass = rope.end_mass(self.system.free_length(i, &lengths[i], &self.now).value);
            for k in 0..6 {
                let (translation, of_turn) = halves(&Vec6::ith(k, 1.0));
                let end = (translation + turn * of_turn) * mass;
                let column = joined(&end, &turn.tr_mul(&end));
                let mut view = matrix.column_mut(k);
                view += column;
            }
        }
        inverse6(&body.reduced_matrix(&matrix))
    }

    /// From now on winches hold tensions, which go from the present ones to the given ones.
    pub(super) fn hold_tensions(&mut self, time: f64, duration: f64, tensions: &[Option<f64>]) {
        let lengths = self.system.lengths(self.time);
        for (i, after) in tensions.iter().enumerate() {
            let Some(after) = *after else { continue };
            let Some(forces) = self.system.far_forces(i, self.time, &lengths[i], &self.now, &self.needed) else {
                continue;
            };
            let whole = self.system.whole_length(i, &lengths[i], &self.now).value;
            let numbers = self.system.of_far_end(i).start;
            let Some(far) = &mut self.system.far_ends[i] else { continue };
            let places = far.places();
            let (Some(feed), Some(at)) = (&mut far.feed, places.feed) else { continue };
            let last = numbers + at + feed.count() - 1;
            let before = forces.feed.tension_drum.unwrap_or_else(|| forces.exit_w.norm());
            feed.hold_tension(WinchHold::Tension { from: time, duration, before, after }, [whole, self.now.x[last]]);
        }
    }

    /// Parts a cable at an unstrained length from the platform. Both halves stay where they are and keep their
    /// velocities: `half` is the one at the platform, the cable itself the one at the anchor.
    ///
    /// # References
    /// docs/theory.md, equation (97k3).
    pub(super) fn part(&mut self, cable: usize, half: usize, place: f64) {
        let lengths = self.system.lengths(self.time);
        let free = self.system.free_length(cable, &lengths[cable], &self.now);
        let (rope, of_cable, of_half) =
            (&self.system.ropes[cable], self.system.of_rope(cable), self.system.of_rope(half));
        let x = self.now.x[of_cable.clone()].to_vec();
        // Velocities of the rope itself.
        let sliding = rope.sliding(&free, &x);
        let v: Vec<f64> = self.now.v[of_cable.clone()].iter().zip(&sliding).map(|(v, slid)| v - slid).collect();

        let share = place / free.value;
        let near = [0.0, share];
        self.now.x[of_half.clone()].copy_from_slice(&rope.sampled(near, &x));
        self.now.v[of_half.clone()].copy_from_slice(&rope.sampled(near, &v));
        let left = WoundLength { value: free.value - place, ..free };
        let x_left = rope.sampled([share, 1.0], &x);
        let slid_left = rope.sliding(&left, &x_left);
        // The last node stays on what it is on.
        let inner = x_left.len() - 3;
        for (k, v) in rope.sampled([share, 1.0], &v)[..inner].iter().enumerate() {
            self.now.x[of_cable.start + k] = x_left[k];
            self.now.v[of_cable.start + k] = v + slid_left[k];
        }

        self.let_go_of(half, of_half.end - 3);
        self.shorten(cable, place);
        self.system.windings[half] = Winding::constant(place);
        self.system.ends[half] = RopeEnd::Attached;
        self.system.ends[cable] = RopeEnd::Free;
    }

    /// Makes the far end of a half loose, at the place of its last node.
    fn let_go_of(&mut self, half: usize, last: usize) {
        let Some(support) = self.system.far_ends[half].as_ref().and_then(|far| far.support) else { return };
        let numbers = System::of_support(support.index);
        self.system.supports[support.index] = MovingSupport::loose();
        self.now.x.copy_within(last..last + 3, numbers.start);
        self.now.v.copy_within(last..last + 3, numbers.start);
    }

    /// Counts the lengths of a cable from a place on.
    fn shorten(&mut self, cable: usize, place: f64) {
        self.system.windings[cable].cut_off(place);
        let from = self.system.of_far_end(cable).start;
        let Some(far) = &self.system.far_ends[cable] else { return };
        if let (Some(feed), Some(at)) = (&far.feed, far.places().feed) {
            self.now.x[from + at..from + at + feed.count()].iter_mut().for_each(|length| *length -= place);
        }
    }

    /// Frees the end of a cable.
    pub(super) fn cut(&mut self, cable: usize) {
        let has_mass = self.system.ropes[cable].mass > 0.0;
        self.system.ends[cable] = if has_mass { RopeEnd::Free } else { RopeEnd::Gone };
    }
}
