//! Free span of a cable as a curve, its parts, and its distance from a body.

use super::arc::Arc;
use super::bounded::Bounded;
use super::solid::PlacedBody;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::statics::CableState;
use std::cell::OnceCell;
use std::collections::BinaryHeap;

/// Free span, from the platform (0) to the anchor.
pub(super) struct FreeSpan<'a> {
    shape: SpanShape<'a>,
    /// Ends: at the platform and at the anchor [m].
    pub(super) ends_w: [Vec3; 2],
    /// Unstrained length, the chord of a straight cable, or the length of a line through points [m].
    pub(super) length: f64,
    /// Length at an end that may be left out, in the same measure [m].
    from_end: f64,
    /// Radius of the rope [m].
    pub(super) radius: f64,
    /// Parts without the ends that are left out, by [`Self::part`]; pairs share them.
    parts: [OnceCell<Option<Arc>>; 4],
}

/// Curve of a span.
enum SpanShape<'a> {
    Straight,
    Hanging(&'a HangingCable),
    /// Straight between points, whose places on the span [m] are given.
    Through {
        points_w: &'a [Vec3],
        places: Vec<f64>,
    },
}

/// End of a span.
#[derive(Debug, Clone, Copy)]
pub(super) enum SpanEnd {
    Platform,
    Anchor,
}

/// Point of a span with its derivatives by the place on it.
#[expect(clippy::struct_field_names, reason = "the letter names the frame, as everywhere")]
pub(super) struct PointOnSpan {
    pub(super) point_w: Vec3,
    pub(super) slope_w: Vec3,
    pub(super) curvature_w: Vec3,
}

impl PointOnSpan {
    /// Point after a small step, to its third power [m].
    pub(super) fn after(&self, step: f64) -> Vec3 {
        self.point_w + self.slope_w * step + self.curvature_w * (0.5 * step * step)
    }
}

impl<'a> FreeSpan<'a> {
    pub(super) fn of(state: &'a CableState, radius: f64, from_end: f64) -> Self {
        // A slack cable without weight has no shape; it counts as its chord.
        let hanging = state.hanging.as_ref().filter(|hanging| hanging.catenary.rope().weight_per_length > 0.0);
        let chord = state.chord();
        let length = hanging.map_or(chord, |hanging| hanging.catenary.rope().unstrained_length);
        let ends_w = [state.attachment_w, state.anchor_w];
        let shape = hanging.map_or(SpanShape::Straight, SpanShape::Hanging);
        Self { shape, ends_w, length, from_end, radius, parts: Default::default() }
    }

    /// Span that is straight between points, from the platform to the anchor; without points it has no length, and
    /// nothing of it is compared.
    pub(super) fn through(points_w: &'a [Vec3], radius: f64, from_end: f64) -> Self {
        let mut length = 0.0;
        let pieces = points_w.windows(2).map(|pair| {
            length += (pair[1] - pair[0]).norm();
            length
        });
        let places = std::iter::once(0.0).chain(pieces).collect();
        let ends_w = [points_w.first(), points_w.last()].map(|end| end.copied().unwrap_or_else(Vec3::zeros));
        let shape = SpanShape::Through { points_w, places };
        Self { shape, ends_w, length, from_end, radius, parts: Default::default() }
    }

    /// Vector from the platform to the anchor [m].
    pub(super) fn chord_w(&self) -> Vec3 {
        self.ends_w[1] - self.ends_w[0]
    }

    /// Point at a place [m].
    pub(super) fn point(&self, s: f64) -> Vec3 {
        match &self.shape {
            SpanShape::Hanging(hanging) => hanging.point_w(s),
            SpanShape::Straight => self.ends_w[0] + self.chord_w() * (s / self.length),
            SpanShape::Through { points_w, places } => {
                let [from, to] = piece(places, s);
                let length = places[to] - places[from];
                let part = if length > 0.0 { (s - places[from]) / length } else { 0.0 };
                points_w[from] + (points_w[to] - points_w[from]) * part
            }
        }
    }

    /// Point at a place with its derivatives; not finite where a loop turns without tension.
    pub(super) fn point_with_derivatives(&self, s: f64) -> PointOnSpan {
        let point_w = self.point(s);
        let straight = |slope_w: Vec3| PointOnSpan { point_w, slope_w, curvature_w: Vec3::zeros() };
        let hanging = match &self.shape {
            SpanShape::Straight => return straight(self.chord_w() / self.length),
            SpanShape::Through { points_w, places } => {
                let [from, to] = piece(places, s);
                return straight((points_w[to] - points_w[from]) / (places[to] - places[from]));
            }
            SpanShape::Hanging(hanging) => hanging,
        };
        let catenary = &hanging.catenary;
        let rope = catenary.rope();
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start() + rope.weight_per_length * s);
        let tension = catenary.tension_at(s);
        let (along_w, up_w) = hanging.axes_w();

        // Direction over its unstrained length, (3) of the theory, and its derivative.
        let per_force = 1.0 / tension + 1.0 / rope.axial_stiffness;
        let turn = v * rope.weight_per_length / tension.powi(3);
        let slope_w = (along_w * h + up_w * v) * per_force;
        let curvature_w = up_w * (rope.weight_per_length * per_force) - (along_w * h + up_w * v) * turn;
        PointOnSpan { point_w, slope_w, curvature_w }
    }

    /// Part of the span between two places.
    pub(super) fn arc(&self, s: [f64; 2]) -> Arc {
        self.arc_between(s, s.map(|s| self.point(s)))
    }

    fn arc_between(&self, s: [f64; 2], points_w: [Vec3; 2]) -> Arc {
        match &self.shape {
            SpanShape::Hanging(hanging) => Arc::of_hanging(hanging, s, points_w),
            SpanShape::Straight => Arc::straight(s, points_w),
            SpanShape::Through { points_w: all_w, places } => {
                let inner =
                    places.partition_point(|place| *place <= s[0])..places.partition_point(|place| *place < s[1]);
                Arc::through(s, points_w, &places[inner.clone()], &all_w[inner])
            }
        }
    }

    /// Both parts of an arc.
    pub(super) fn halves(&self, arc: &Arc) -> [Arc; 2] {
        let point_w = self.point(arc.middle);
        [
            self.arc_between([arc.s[0], arc.middle], [arc.points_w[0], point_w]),
            self.arc_between([arc.middle, arc.s[1]], [point_w, arc.points_w[1]]),
        ]
    }

    /// Part of the span that is compared, without the ends that are nearer than `from_end` to the other thing; `None`
    /// if nothing remains. `distances` are those of the ends.
    pub(super) fn part(&self, distances: [f64; 2]) -> Option<&Arc> {
        let left_out = distances.map(|distance| distance < self.from_end);
        let find = || {
            let [at_start, at_end] = left_out.map(|left_out| if left_out { self.from_end } else { 0.0 });
            let range = [at_start, self.length - at_end];
            (range[0] < range[1]).then(|| self.arc(range))
        };
        self.parts[usize::from(left_out[0]) + 2 * usize::from(left_out[1])].get_or_init(find).as_ref()
    }

    /// Part of the span that is compared with a body, on which one of its ends may be mounted.
    fn part_beside(&self, body: &PlacedBody, mounted: SpanEnd) -> Option<&Arc> {
        let at = |point_w: &Vec3| {
            let far = body.lower_bound_to_segment(point_w, point_w);
            if far >= self.from_end { far } else { body.nearest_to_segment(point_w, point_w).distance }
        };
        self.part(match mounted {
            SpanEnd::Platform => [at(&self.ends_w[0]), f64::INFINITY],
            SpanEnd::Anchor => [f64::INFINITY, at(&self.ends_w[1])],
        })
    }

    /// Distance of the surface of the cable from a body, on which one of its ends may be mounted, and the nearest
    /// points; `None` if nothing is compared, or if the distance is surely above `enough`. It is too large by the
    /// tolerance at most.
    pub(super) fn nearest_on(
        &self,
        body: &PlacedBody,
        mounted: SpanEnd,
        enough: f64,
        tolerance: f64,
    ) -> Option<(f64, [Vec3; 2])> {
        let part = self.part_beside(body, mounted)?;
        let mut best = (f64::INFINITY, [Vec3::zeros(); 2]);
        let mut queue = BinaryHeap::new();
        let [from_w, to_w] = part.points_w;
        if body.lower_bound_to_segment(&from_w, &to_w) - part.sagitta - self.radius > enough {
            return None;
        }
        let is_mesh = body.is_mesh();
        let consider = |arc: Arc, best: &mut (f64, [Vec3; 2]), queue: &mut BinaryHeap<Bounded<Arc>>| {
            // Between a long segment and many triangles distances are dear, from a point they are not.
            let half_length = 0.5 * (arc.points_w[1] - arc.points_w[0]).norm();
            if is_mesh && arc.sagitta > 0.5 * tolerance {
                let point_w = self.point(arc.middle);
                let near = body.nearest_to_segment(&point_w, &point_w);
                if near.distance < best.0 {
                    *best = (near.distance, [point_w, near.point_w]);
                }
                if 2.0 * half_length > near.distance.abs() {
                    let chord_w = arc.points_w[1] - arc.points_w[0];
                    let [before, after] = arc.points_w.map(|end_w| (end_w - point_w).norm());
                    let reach = before.max(after).max(0.5 * chord_w.norm()) + arc.sagitta;
                    queue.push(Bounded { lower: near.distance - reach, of: arc });
                    return;
                }
            }
            let near = body.nearest_to_segment(&arc.points_w[0], &arc.points_w[1]);
            let s = arc.s[0] + near.fraction * (arc.s[1] - arc.s[0]);
            let point_w = self.point(s);
            let of_point = body.nearest_to_segment(&point_w, &point_w);
            if of_point.distance < best.0 {
                *best = (of_point.distance, [point_w, of_point.point_w]);
            }
            // A straight arc is its chord, whose nearest point is not known where it touches the body.
            if arc.sagitta <= 0.5 * tolerance && near.distance < best.0 {
                let on_chord_w = arc.points_w[0] + (arc.points_w[1] - arc.points_w[0]) * near.fraction;
                *best = (near.distance, [on_chord_w, near.point_w]);
            }
            queue.push(Bounded { lower: near.distance - arc.sagitta, of: arc });
        };

        consider(*part, &mut best, &mut queue);
        while let Some(Bounded { lower, of: arc }) = queue.pop() {
            if lower - self.radius > enough {
                return None;
            }
            if lower >= best.0 - tolerance || arc.sagitta <= 0.5 * tolerance {
                break;
            }
            self.halves(&arc).into_iter().for_each(|half| consider(half, &mut best, &mut queue));
        }
        Some((best.0 - self.radius, best.1))
    }
}

/// Numbers of the points between which a place lies.
fn piece(places: &[f64], s: f64) -> [usize; 2] {
    let to = places.partition_point(|place| *place < s).clamp(1, places.len() - 1);
    [to - 1, to]
}
