//! Platform and ropes as one system: the forces that a motion needs, and Newton's corrections of it.
//!
//! A motion is stored as numbers in a row: centre of mass, turn since the beginning of the step, supports, then for
//! each rope its nodes and the numbers of its far end. The ends of a rope are filled from what they are on.

use super::body::{BodyMotion, MovingBody};
use super::far_end::{ExitMotion, FarEnd, FarForces, FarState, delayed_weights};
use super::moving_anchor::AnchorCourse;
use super::rope::{RopeMesh, WoundLength};
use super::side_by_side::RopePack;
use super::winding::Winding;
use crate::math::{Mat3, Rotation, Vec3, Vec6};
use crate::robot::Support;

/// Number of numbers of the platform in a motion.
pub(super) const BODY: usize = 6;

/// Jump of a commanded acceleration [m/s²] and of the share of a push from which on it counts as one: far above
/// rounding, far below gravity.
const MIN_JUMP: f64 = 1e-6;

/// End of a rope at the platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RopeEnd {
    /// On the platform.
    Attached,
    /// Free after a cut.
    Free,
    /// A rope without mass that was cut: it is gone.
    Gone,
}

/// Support of anchors that yields.
#[derive(Debug, Clone, Copy)]
pub(super) struct MovingSupport {
    /// Stiffness [N/m].
    pub(super) stiffness_w: Mat3,
    /// Mass [kg].
    pub(super) mass: f64,
    /// Damping time [s]: damping over stiffness.
    pub(super) damping_time: f64,
}

impl MovingSupport {
    /// Support of the loose end of a half, before there is one: it holds its place.
    pub(super) fn waiting() -> Self {
        Self { stiffness_w: Mat3::identity(), mass: 1.0, damping_time: 0.0 }
    }

    /// Support of a loose end: it has neither stiffness nor mass, so that it only carries the place of the end.
    pub(super) fn loose() -> Self {
        Self { stiffness_w: Mat3::zeros(), mass: 0.0, damping_time: 0.0 }
    }

    /// Support whose damping ratio holds at an angular frequency [rad/s].
    pub(super) fn of(support: &Support, omega: f64) -> Self {
        let ratio = support.damping_ratio;
        let damping_time = if ratio > 0.0 { 2.0 * ratio / omega } else { 0.0 };
        Self { stiffness_w: support.stiffness_w, mass: support.mass, damping_time }
    }
}

/// Platform and ropes.
#[derive(Clone)]
pub(super) struct System {
    pub(super) body: MovingBody,
    pub(super) ropes: Vec<RopeMesh>,
    /// The ropes side by side.
    pub(super) packs: Vec<RopePack>,
    pub(super) ends: Vec<RopeEnd>,
    /// Far ends of ropes that do more than stay where they are.
    pub(super) far_ends: Vec<Option<FarEnd>>,
    /// Cables that may fail at a place: the cable, and the rope that is its half at the platform from then on.
    pub(super) halves: Vec<(usize, usize)>,
    /// Supports, whose numbers follow those of the platform.
    pub(super) supports: Vec<MovingSupport>,
    pub(super) windings: Vec<Winding>,
    /// Courses of the anchors of the ropes; none for those that rest.
    pub(super) anchors: Vec<Option<AnchorCourse>>,
    /// First number of each rope in a motion.
    pub(super) offsets: Vec<usize>,
    /// Number of numbers of a motion.
    pub(super) size: usize,
    /// Wind at a time: the mean and gusts.
    pub(super) air: super::air::Air,
    /// Rotation of the platform at the beginning of the step.
    pub(super) rotation: Rotation,
    /// Residuals computed so far.
    pub(super) evaluations: usize,
}

/// Positions, velocities and accelerations of a motion.
#[derive(Debug, Clone, Default)]
pub(super) struct MotionNumbers {
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
}

impl MotionNumbers {
    pub(super) fn zeros(size: usize) -> Self {
        Self { x: vec![0.0; size], v: vec![0.0; size], a: vec![0.0; size] }
    }

    /// Place, velocity and acceleration of the point whose numbers begin at `from`.
    #[inline]
    pub(super) fn point(&self, from: usize) -> ExitMotion {
        [three(&self.x, from), three(&self.v, from), three(&self.a, from)]
    }

    /// Sets place, velocity and acceleration of the point whose numbers begin at `from`.
    #[inline]
    pub(super) fn put(&mut self, from: usize, [x, v, a]: &ExitMotion) {
        self.x[from..from + 3].copy_from_slice(x.as_slice());
        self.v[from..from + 3].copy_from_slice(v.as_slice());
        self.a[from..from + 3].copy_from_slice(a.as_slice());
    }
}

/// The first six numbers.
#[inline]
pub(super) fn six(numbers: &[f64]) -> Vec6 {
    Vec6::from_column_slice(&numbers[..BODY])
}

#[inline]
pub(super) fn three(numbers: &[f64], from: usize) -> Vec3 {
    Vec3::from_column_slice(&numbers[from..from + 3])
}

/// Rate of the turn θ in the chart `R = R_n exp θ` for an angular velocity in platform axes.
///
/// # References
/// docs/theory.md, equation (97c).
pub(super) fn turn_rate(turn: &Vec3, omega: &Vec3) -> Vec3 {
    let square = turn.norm_squared();
    // (1 − (φ/2) cot(φ/2))/φ²; the series has an error of φ⁶/30240·… below the switch.
    let factor = if square < 1e-4 {
        1.0 / 12.0 + square / 720.0
    } else {
        let half = 0.5 * square.sqrt();
        (1.0 - half / half.tan()) / square
    };
    let once = turn.cross(omega);
    omega + once * 0.5 + turn.cross(&once) * factor
}

impl System {
    /// Motion of the platform in a row of numbers.
    pub(super) fn body_motion(&self, m: &MotionNumbers) -> BodyMotion {
        BodyMotion {
            center_w: three(&m.x, 0),
            rot_wp: self.rotation_at(&three(&m.x, 3)).to_rotation_matrix().into_inner(),
            velocity: six(&m.v),
            acceleration: six(&m.a),
        }
    }

    /// Rotation after a turn since the beginning of the step.
    pub(super) fn rotation_at(&self, turn: &Vec3) -> Rotation {
        self.rotation * Rotation::from_scaled_axis(*turn)
    }

    /// Numbers of rope `i` in a motion.
    #[inline]
    pub(super) fn of_rope(&self, i: usize) -> std::ops::Range<usize> {
        self.offsets[i]..self.offsets[i] + self.ropes[i].size()
    }

    /// Numbers of the nodes of rope `i` but for the last.
    #[inline]
    pub(super) fn inner_nodes(&self, i: usize) -> std::ops::Range<usize> {
        self.offsets[i]..self.offsets[i] + self.ropes[i].size() - 3
    }

    /// Numbers of the far end of rope `i`, behind those of its nodes.
    #[inline]
    pub(super) fn of_far_end(&self, i: usize) -> std::ops::Range<usize> {
        let from = self.offsets[i] + self.ropes[i].size();
        from..from + self.far_ends[i].as_ref().map_or(0, |far| far.places().count)
    }

    /// Rope that is the half of a cable at the platform after a failure at a place.
    pub(super) fn half_of(&self, cable: usize) -> Option<usize> {
        self.halves.iter().find(|(of, _)| *of == cable).map(|(_, half)| *half)
    }

    /// Numbers of a support.
    pub(super) fn of_support(index: usize) -> std::ops::Range<usize> {
        BODY + 3 * index..BODY + 3 * index + 3
    }

    /// Fills the ends of the ropes: on the platform, and far ends that move. `lengths` are the commanded ones at the
    /// time.
    pub(super) fn fill_ends(&self, time: f64, body: &BodyMotion, lengths: &[WoundLength], m: &mut MotionNumbers) {
        for (i, end) in self.ends.iter().enumerate() {
            if let Some(far) = &self.far_ends[i] {
                self.fill_far_end(i, far, (time, &lengths[i]), m);
            } else if let Some(anchor) = &self.anchors[i] {
                m.put(self.of_rope(i).end - 3, &anchor.at(time));
            }
            if *end == RopeEnd::Attached {
                m.put(self.offsets[i], &body.point(&self.body.lever_p(i)));
            }
        }
    }

    fn fill_far_end(&self, i: usize, far: &FarEnd, (time, given): (f64, &WoundLength), m: &mut MotionNumbers) {
        let (places, from) = (far.places(), self.of_far_end(i).start);
        if let (Some(feed), Some(at)) = (&far.feed, places.feed)
            && feed.follows_command()
        {
            let last = from + at + feed.count() - 1;
            let of = feed.commanded(given);
            (m.x[last], m.v[last], m.a[last]) = (of.value, of.rate, of.acceleration);
            if let Some(delayed) = places.delayed {
                (m.x[from + delayed], m.v[from + delayed], m.a[from + delayed]) = (of.value - given.value, 0.0, 0.0);
            }
        }
        let swivel = places.swivel.map_or([0.0; 3], |at| [m.x[from + at], m.v[from + at], m.a[from + at]]);
        let [place, velocity, acceleration] = Self::support_motion(far, m);
        let moved = self.moved(i, time);
        let exit = far.exit(swivel, &[place + moved[0], velocity + moved[1], acceleration + moved[2]]);
        m.put(self.of_rope(i).end - 3, &exit);
    }

    /// Work of needed forces along a change of all numbers. The ends at the platform are a part of it.
    pub(super) fn work(&self, needed: &[f64], change: &[f64]) -> f64 {
        let all =
            |range: std::ops::Range<usize>| needed[range.clone()].iter().zip(&change[range]).map(|(a, b)| a * b).sum();
        let at_platform = |i: usize| -> f64 {
            let from = self.offsets[i];
            if self.ends[i] == RopeEnd::Attached { all(from..from + 3) } else { 0.0 }
        };
        let whole: f64 = all(0..self.size);
        whole - (0..self.ends.len()).map(at_platform).sum::<f64>()
    }

    /// Motion of the support of a far end.
    fn support_motion(far: &FarEnd, m: &MotionNumbers) -> ExitMotion {
        far.support.map_or([Vec3::zeros(); 3], |support| m.point(Self::of_support(support.index).start))
    }

    /// Displacement of the anchor of rope `i` since the start, with its velocity and acceleration.
    fn moved(&self, i: usize, time: f64) -> ExitMotion {
        self.anchors[i].as_ref().map_or([Vec3::zeros(); 3], |anchor| anchor.moved(time))
    }

    /// Power [W] that moves the anchor of rope `i`: with the energy that passing rope has by the motion of the anchor.
    ///
    /// # References
    /// docs/theory.md, equation (97g2).
    pub(super) fn anchor_power(
        &self,
        i: usize,
        time: f64,
        given: &WoundLength,
        m: &MotionNumbers,
        needed: &[f64],
    ) -> f64 {
        let Some(anchor) = &self.anchors[i] else { return 0.0 };
        let [_, velocity_w, _] = anchor.moved(time);
        let node_w = three(needed, self.of_rope(i).end - 3);
        let Some(far) = &self.far_ends[i] else { return node_w.dot(&velocity_w) };
        let (rope, free) = (&self.ropes[i], self.free_length(i, given, m));
        let behind = self.whole_length(i, given, m).value - free.value;
        let passing = 0.5 * rope.mass * free.rate * velocity_w.norm_squared();
        let weight_w = rope.gravity_w * (rope.mass * behind);
        let stored = if far.feed.is_some() { passing } else { 0.0 };
        (node_w - weight_w).dot(&velocity_w) - stored
    }

    /// True if a commanded acceleration or a push is another one from a time on than before it.
    pub(super) fn jumps_at(&self, time: f64) -> bool {
        let before = time.next_down();
        let lengths = self.windings.iter().any(|winding| {
            let [before, after] = [before, time].map(|at| winding.at(at));
            (after.acceleration - before.acceleration).abs() > MIN_JUMP
        });
        let anchors = self.anchors.iter().flatten().any(|anchor| {
            let [before, after] = [before, time].map(|at| anchor.moved(at));
            (after[2] - before[2]).norm() > MIN_JUMP
        });
        lengths
            || anchors
            || self.body.pushes.iter().any(|push| (push.share(time) - push.share(before)).abs() > MIN_JUMP)
    }

    /// Commanded lengths of all ropes at a time.
    pub(super) fn lengths(&self, time: f64) -> Vec<WoundLength> {
        self.windings.iter().map(|winding| winding.at(time)).collect()
    }

    /// Free unstrained length of rope `i`, whose commanded length is `given`.
    #[inline]
    pub(super) fn free_length(&self, i: usize, given: &WoundLength, m: &MotionNumbers) -> WoundLength {
        let far = self.far_ends[i].as_ref();
        let Some(at) = far.and_then(|far| far.places().feed) else { return *given };
        let at = self.of_far_end(i).start + at;
        WoundLength { value: m.x[at], rate: m.v[at], acceleration: m.a[at] }
    }

    /// Unstrained length of rope `i` from the platform to the drum.
    pub(super) fn whole_length(&self, i: usize, given: &WoundLength, m: &MotionNumbers) -> WoundLength {
        let Some(far) = &self.far_ends[i] else { return *given };
        let range = self.of_far_end(i);
        far.whole(*given, [&m.x[range.clone()], &m.v[range.clone()], &m.a[range]], self.free_length(i, given, m))
    }

    /// State on which the forces at a far end depend. `needed` has the forces of the rope's nodes.
    pub(super) fn far_state<'a>(
        &'a self,
        i: usize,
        time: f64,
        given: &WoundLength,
        m: &'a MotionNumbers,
        needed: &[f64],
    ) -> FarState<'a> {
        let (range, z, free) = (self.of_rope(i), self.of_far_end(i), self.free_length(i, given, m));
        let rope = &self.ropes[i];
        let slope_w = rope.slope_at_end(&free, &m.x[range.clone()]);
        let far = self.far_ends[i].as_ref();
        let support = far.and_then(|far| far.support);
        let stations = far.and_then(|far| Some(far.places().feed? + far.feed.as_ref()?.count()));
        FarState {
            rope,
            time,
            given: *given,
            free,
            z: [&m.x[z.clone()], &m.v[z.clone()], &m.a[z.clone()]],
            support_w: support.map_or_else(Vec3::zeros, |support| three(&m.x, Self::of_support(support.index).start)),
            moved_w: self.moved(i, time)[0],
            held: stations.map_or(0.0, |count| needed[z.start + count - 1]),
            node_w: three(needed, range.end - 3),
            velocity_w: three(&m.v, range.end - 3),
            slope_w,
        }
    }

    /// Forces at the far end of rope `i`; `None` for one that stays where it is.
    pub(super) fn far_forces(
        &self,
        i: usize,
        time: f64,
        given: &WoundLength,
        m: &MotionNumbers,
        needed: &[f64],
    ) -> Option<FarForces> {
        let far = self.far_ends[i].as_ref()?;
        Some(far.forces(&self.far_state(i, time, given, m, needed)))
    }

    /// Forces that the motion needs, in a row of numbers: zero where the motion is right, at the ends of the ropes what
    /// holds them. The ends have been filled.
    pub(super) fn needed(
        &mut self,
        time: f64,
        lengths: &[WoundLength],
        body: &BodyMotion,
        m: &MotionNumbers,
        out: &mut [f64],
    ) {
        self.evaluations += 1;
        out.fill(0.0);
        let mut on_body = self.body.needed(time, &self.air.on_body(time), body);
        for (index, support) in self.supports.iter().enumerate() {
            let [place, velocity, acceleration] = m.point(Self::of_support(index).start);
            let force_w = support.stiffness_w * (place + velocity * support.damping_time) + acceleration * support.mass;
            out[Self::of_support(index)].copy_from_slice(force_w.as_slice());
        }
        let free: Vec<WoundLength> = (0..lengths.len()).map(|i| self.free_length(i, &lengths[i], m)).collect();
        for pack in &mut self.packs {
            pack.add_inner_forces(&self.ropes, &self.offsets, &free, [&m.x, &m.v], out);
        }
        for (i, rope) in self.ropes.iter().enumerate() {
            let range = self.of_rope(i);
            let of_rope = &mut out[range.clone()];
            if self.ends[i] == RopeEnd::Gone {
                of_rope.fill(0.0);
                continue;
            }
            let wind = self.air.on_rope(i, time);
            rope.add_outer_forces(&free[i], &wind, [&m.x[range.clone()], &m.v[range.clone()], &m.a[range]], of_rope);
            if self.ends[i] == RopeEnd::Attached {
                on_body += MovingBody::wrench(body, &self.body.lever_p(i), &three(of_rope, 0));
            }
            self.needed_at_far_end(i, time, &lengths[i], m, out);
        }
        out[..BODY].copy_from_slice(on_body.as_slice());
    }

    fn needed_at_far_end(&self, i: usize, time: f64, given: &WoundLength, m: &MotionNumbers, out: &mut [f64]) {
        let Some(far) = &self.far_ends[i] else { return };
        let (places, from) = (far.places(), self.of_far_end(i).start);
        let forces = far.forces(&self.far_state(i, time, given, m, out));
        if let Some(at) = places.swivel {
            out[from + at] = forces.swivel;
        }
        if let (Some(feed), Some(at)) = (&far.feed, places.feed) {
            let (range, free) = (self.of_rope(i), self.free_length(i, given, m));
            let wind = self.air.on_rope(i, time);
            let entry_w = far.entry_w + Self::support_motion(far, m)[0] + self.moved(i, time)[0];
            let of_rope = [&m.x[range.clone()], &m.v[range.clone()], &m.a[range]];
            let scale = feed.stretch * feed.stretch;
            for (j, (needed, mass)) in forces.feed.needed.iter().zip(&feed.masses).enumerate() {
                out[from + at + j] = needed + scale * mass * m.a[from + at + j];
            }
            out[from + at] += self.ropes[i].needed_by_length(&free, &wind, of_rope, &entry_w);
            if let Some(integral) = places.integral {
                // Its acceleration is the rate of the error.
                let last = from + at + feed.count() - 1;
                out[from + integral] = m.a[from + integral] - (m.v[last] - given.rate);
            }
            if let (Some(delayed), Some((delay, _))) = (places.delayed, feed.delayed_servo()) {
                let (last, k) = (from + at + feed.count() - 1, from + delayed);
                let error = [m.x[last] - given.value, m.v[last] - given.rate, m.a[last] - given.acceleration];
                out[k] = delayed_weights(delay, [m.x[k], m.v[k], m.a[k]])[0] - delayed_weights(delay, error)[1];
            }
        }
        if let Some(support) = far.support {
            for (out, force) in out[Self::of_support(support.index)].iter_mut().zip(forces.support_w.iter()) {
                *out += force;
            }
        }
    }
}
