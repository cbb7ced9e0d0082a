//! Free span of a cable as a curve, its arcs, and its distance from a body.

use super::BODY_TOLERANCE;
use super::solid::PlacedBody;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;
use crate::statics::CableState;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Free span, from the platform (0) to the anchor.
pub(super) struct FreeSpan<'a> {
    /// Curve; none for a straight cable.
    hanging: Option<&'a HangingCable>,
    start_w: Vec3,
    end_w: Vec3,
    /// Unstrained length, or the chord of a straight cable [m].
    pub(super) length: f64,
    /// Length at an end that may be left out, in the same measure [m].
    from_end: f64,
    /// Radius of the rope [m].
    pub(super) radius: f64,
}

/// End of a span.
#[derive(Debug, Clone, Copy)]
pub(super) enum SpanEnd {
    Platform,
    Anchor,
}

/// Part of a span.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    /// Its ends on the span [m].
    pub(super) s: [f64; 2],
    /// Its ends in the world [m].
    pub(super) points_w: [Vec3; 2],
    /// Bound of the distance of its points from its chord [m].
    pub(super) sagitta: f64,
    /// Point that is farthest from the chord [m], where it is divided.
    pub(super) middle: f64,
}

/// Bounds of the derivatives over an arc.
pub(super) struct ArcBounds {
    /// Least and greatest slope: stretched per unstrained length.
    pub(super) slope: [f64; 2],
    /// Greatest second derivative [1/m].
    pub(super) curvature: f64,
    /// Greatest angle between the curve and its chord [rad].
    pub(super) turn: f64,
}

/// Point of a span with its derivatives by the place on it.
#[expect(clippy::struct_field_names, reason = "the letter names the frame, as everywhere")]
pub(super) struct PointOnSpan {
    pub(super) point_w: Vec3,
    pub(super) slope_w: Vec3,
    pub(super) curvature_w: Vec3,
}

impl<'a> FreeSpan<'a> {
    pub(super) fn of(state: &'a CableState, radius: f64, from_end: f64) -> Self {
        // A slack cable without weight has no shape; it counts as its chord.
        let hanging = state.hanging.as_ref().filter(|hanging| hanging.catenary.rope().weight_per_length > 0.0);
        let chord = state.chord();
        let length = hanging.map_or(chord, |hanging| hanging.catenary.rope().unstrained_length);
        Self { hanging, start_w: state.attachment_w, end_w: state.anchor_w, length, from_end, radius }
    }

    /// End on the platform [m].
    pub(super) fn start_w(&self) -> Vec3 {
        self.start_w
    }

    /// End at the anchor [m].
    pub(super) fn end_w(&self) -> Vec3 {
        self.end_w
    }

    /// Point at a place [m].
    pub(super) fn point(&self, s: f64) -> Vec3 {
        match self.hanging {
            Some(hanging) => hanging.point_w(s),
            None => self.start_w + (self.end_w - self.start_w) * (s / self.length),
        }
    }

    /// Point at a place with its derivatives; not finite where a loop turns without tension.
    pub(super) fn point_with_derivatives(&self, s: f64) -> PointOnSpan {
        let point_w = self.point(s);
        let Some(hanging) = self.hanging else {
            let slope_w = (self.end_w - self.start_w) / self.length;
            return PointOnSpan { point_w, slope_w, curvature_w: Vec3::zeros() };
        };
        let catenary = &hanging.catenary;
        let rope = catenary.rope();
        let (h, v) = (catenary.horizontal_force(), catenary.vertical_force_at_start() + rope.weight_per_length * s);
        let tension = h.hypot(v);
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
        let half = 0.5 * (s[0] + s[1]);
        let Some(hanging) = self.hanging else { return Arc { s, points_w, sagitta: 0.0, middle: half } };
        let catenary = &hanging.catenary;
        let rope = catenary.rope();
        let (along_w, up_w) = hanging.axes_w();
        let chord_w = points_w[1] - points_w[0];
        let (x, z) = (chord_w.dot(&along_w), chord_w.dot(&up_w));
        let (h, first) = (catenary.horizontal_force(), catenary.vertical_force_at_start());
        let vertical = |s: f64| first + rope.weight_per_length * s;

        // While the curve does not turn back along its chord, the point with the chord's slope is the farthest, (W19).
        let forward = |s: f64| h * x + vertical(s) * z > 0.0;
        if forward(s[0]) && forward(s[1]) && x > 0.0 {
            let middle = ((h * z / x - first) / rope.weight_per_length).clamp(s[0], s[1]);
            let offset_w = self.point(middle) - points_w[0];
            let (dx, dz) = (offset_w.dot(&along_w), offset_w.dot(&up_w));
            let sagitta = (dx * z - dz * x).abs() / x.hypot(z);
            // Close to straight, rounding moves the middle to an end.
            let inside = middle - s[0] > 0.1 * (s[1] - s[0]) && s[1] - middle > 0.1 * (s[1] - s[0]);
            return Arc { s, points_w, sagitta, middle: if inside { middle } else { half } };
        }

        // Otherwise it stays within the ellipse of its length about its ends.
        let most = h.hypot(vertical(s[0])).max(h.hypot(vertical(s[1])));
        let length = (s[1] - s[0]) * (1.0 + most / rope.axial_stiffness);
        let sagitta = 0.5 * (length * length - chord_w.norm_squared()).max(0.0).sqrt();
        Arc { s, points_w, sagitta, middle: half }
    }

    /// Bounds of the derivatives over an arc; `None` where a cable without tension turns.
    pub(super) fn bounds(&self, arc: &Arc) -> Option<ArcBounds> {
        let Some(hanging) = self.hanging else {
            let slope = self.end_w.metric_distance(&self.start_w) / self.length;
            return Some(ArcBounds { slope: [slope; 2], curvature: 0.0, turn: 0.0 });
        };
        let catenary = &hanging.catenary;
        let rope = catenary.rope();
        let h = catenary.horizontal_force();
        let [first, last] = arc.s.map(|s| catenary.vertical_force_at_start() + rope.weight_per_length * s);
        let at_ends = [h.hypot(first), h.hypot(last)];
        let least = if first < 0.0 && last > 0.0 { h } else { at_ends[0].min(at_ends[1]) };
        if least <= 0.0 {
            return None;
        }
        let slope = |tension: f64| 1.0 + tension / rope.axial_stiffness;

        // The direction turns one way, so it is farthest from the chord at an end.
        let (along_w, up_w) = hanging.axes_w();
        let chord_w = arc.points_w[1] - arc.points_w[0];
        let (x, z) = (chord_w.dot(&along_w), chord_w.dot(&up_w));
        let from_chord = |v: f64| (h * z - v * x).abs().atan2(h * x + v * z);
        Some(ArcBounds {
            slope: [slope(least), slope(at_ends[0].max(at_ends[1]))],
            curvature: rope.weight_per_length * (1.0 / least + 1.0 / rope.axial_stiffness),
            turn: from_chord(first).max(from_chord(last)),
        })
    }

    /// Both parts of an arc.
    pub(super) fn halves(&self, arc: &Arc) -> [Arc; 2] {
        let point_w = self.point(arc.middle);
        [
            self.arc_between([arc.s[0], arc.middle], [arc.points_w[0], point_w]),
            self.arc_between([arc.middle, arc.s[1]], [point_w, arc.points_w[1]]),
        ]
    }

    /// Places between which the span is compared, without the ends that are nearer than `from_end` to the other thing;
    /// `None` if nothing remains. `distances` are those of the ends.
    pub(super) fn compared(&self, distances: [f64; 2]) -> Option<[f64; 2]> {
        let [at_start, at_end] = distances.map(|distance| if distance < self.from_end { self.from_end } else { 0.0 });
        let range = [at_start, self.length - at_end];
        (range[0] < range[1]).then_some(range)
    }

    /// Distance of the surface of the cable from a body, on which one of its ends may be mounted, and the nearest points;
    /// `None` if nothing is compared, or if the distance is surely above `enough`.
    pub(super) fn nearest_on(&self, body: &PlacedBody, mounted: SpanEnd, enough: f64) -> Option<(f64, [Vec3; 2])> {
        let at = |point_w: &Vec3| body.nearest_to_segment(point_w, point_w).distance;
        let range = self.compared(match mounted {
            SpanEnd::Platform => [at(&self.start_w), f64::INFINITY],
            SpanEnd::Anchor => [f64::INFINITY, at(&self.end_w)],
        })?;

        let mut best = (f64::INFINITY, [Vec3::zeros(); 2]);
        let mut queue = BinaryHeap::new();
        let consider = |arc: Arc, best: &mut (f64, [Vec3; 2]), queue: &mut BinaryHeap<Waiting>| {
            let near = body.nearest_to_segment(&arc.points_w[0], &arc.points_w[1]);
            let s = arc.s[0] + near.fraction * (arc.s[1] - arc.s[0]);
            let point_w = self.point(s);
            let of_point = body.nearest_to_segment(&point_w, &point_w);
            if of_point.distance < best.0 {
                *best = (of_point.distance, [point_w, of_point.point_w]);
            }
            // A straight arc is its chord, whose nearest point is not known where it touches the body.
            if arc.sagitta <= 0.5 * BODY_TOLERANCE && near.distance < best.0 {
                let on_chord_w = arc.points_w[0] + (arc.points_w[1] - arc.points_w[0]) * near.fraction;
                *best = (near.distance, [on_chord_w, near.point_w]);
            }
            queue.push(Waiting { lower: near.distance - arc.sagitta, arc });
        };

        consider(self.arc(range), &mut best, &mut queue);
        while let Some(Waiting { lower, arc }) = queue.pop() {
            if lower - self.radius > enough {
                return None;
            }
            if lower >= best.0 - BODY_TOLERANCE || arc.sagitta <= 0.5 * BODY_TOLERANCE {
                break;
            }
            self.halves(&arc).into_iter().for_each(|half| consider(half, &mut best, &mut queue));
        }
        Some((best.0 - self.radius, best.1))
    }
}

/// Arc that may be nearer than the best point found, the nearest first.
struct Waiting {
    lower: f64,
    arc: Arc,
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}
