//! Arcs of a cable, with bounds of how far they leave their chords and of their derivatives.

use super::segments;
use crate::catenary::space::HangingCable;
use crate::math::Vec3;

/// Part of a free span.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    /// Ends of the arc on the span [m].
    pub(super) s: [f64; 2],
    /// Ends of the arc in the world [m].
    pub(super) points_w: [Vec3; 2],
    /// Bound of the distance of its points from its chord [m].
    pub(super) sagitta: f64,
    /// Unit vector across the chord to the side on which the curve lies; `None` if it is straight or may be on any
    /// side.
    outward_w: Option<Vec3>,
    /// Point that is farthest from the chord [m], where it is divided.
    pub(super) middle: f64,
    /// Bounds of its derivatives; `None` where the curve turns back along its chord.
    pub(super) bounds: Option<ArcBounds>,
}

/// Bounds of the derivatives over an arc.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArcBounds {
    /// Least and greatest slope: stretched per unstrained length.
    pub(super) slope: [f64; 2],
    /// Greatest second derivative across the curve and along it [1/m].
    second: [f64; 2],
    /// Cosine and sine of the greatest angle between the curve and its chord.
    turn: [f64; 2],
}

impl Arc {
    /// Part of a straight cable between two places.
    pub(super) fn straight(s: [f64; 2], points_w: [Vec3; 2]) -> Self {
        let slope = (points_w[1] - points_w[0]).norm() / (s[1] - s[0]);
        let bounds = ArcBounds { slope: [slope; 2], second: [0.0; 2], turn: [1.0, 0.0] };
        Self { s, points_w, sagitta: 0.0, outward_w: None, middle: 0.5 * (s[0] + s[1]), bounds: Some(bounds) }
    }

    /// Part of a line that is straight between points, of which these lie within it. The farthest point of the chord is
    /// one of them.
    pub(super) fn through(s: [f64; 2], points_w: [Vec3; 2], places: &[f64], inner_w: &[Vec3]) -> Self {
        if places.is_empty() {
            return Self::straight(s, points_w);
        }
        let off = |point_w: &Vec3| segments::nearest(&[*point_w; 2], &points_w).distance;
        let sagitta = inner_w.iter().map(off).fold(0.0, f64::max);
        Self { s, points_w, sagitta, outward_w: None, middle: places[places.len() / 2], bounds: None }
    }

    /// Part of a sagging cable between two places.
    pub(super) fn of_hanging(hanging: &HangingCable, s: [f64; 2], points_w: [Vec3; 2]) -> Self {
        let half = 0.5 * (s[0] + s[1]);
        let catenary = &hanging.catenary;
        let rope = catenary.rope();
        let (along_w, up_w) = hanging.axes_w();
        let chord_w = points_w[1] - points_w[0];
        let (x, z) = (chord_w.dot(&along_w), chord_w.dot(&up_w));
        let (h, first) = (catenary.horizontal_force(), catenary.vertical_force_at_start());
        let forces = s.map(|s| [h, first + rope.weight_per_length * s]);
        let tensions = s.map(|s| catenary.tension_at(s));

        // While the curve does not turn back along its chord, the point with the chord's slope is the farthest, (W19).
        let is_forward = x > 0.0 && forces.iter().all(|[h, v]| h * x + v * z > 0.0);
        if !is_forward {
            // It stays within the ellipse of its length about its ends.
            let length = (s[1] - s[0]) * (1.0 + tensions[0].max(tensions[1]) / rope.axial_stiffness);
            let sagitta = 0.5 * (length * length - chord_w.norm_squared()).max(0.0).sqrt();
            return Self { s, points_w, sagitta, outward_w: None, middle: half, bounds: None };
        }
        let chord = (x * x + z * z).sqrt();
        let middle = ((h * z / x - first) / rope.weight_per_length).clamp(s[0], s[1]);
        let outward_w = (along_w * z - up_w * x) / chord;
        let sagitta = (hanging.point_w(middle) - points_w[0]).dot(&outward_w).abs();
        // Close to straight, rounding moves the middle to an end.
        let inside = middle - s[0] > 0.1 * (s[1] - s[0]) && s[1] - middle > 0.1 * (s[1] - s[0]);

        let least = if forces[0][1] < 0.0 && forces[1][1] > 0.0 { h } else { tensions[0].min(tensions[1]) };
        let slope = [least, tensions[0].max(tensions[1])].map(|tension| 1.0 + tension / rope.axial_stiffness);
        let across = rope.weight_per_length * h / least * (1.0 / least + 1.0 / rope.axial_stiffness);
        // The direction turns one way, so it is farthest from the chord at an end.
        let turn = |k: usize| {
            let ([h, v], size) = (forces[k], tensions[k] * chord);
            [(h * x + v * z) / size, (h * z - v * x).abs() / size]
        };
        let turn = if turn(0)[0] < turn(1)[0] { turn(0) } else { turn(1) };
        let second = [across, rope.weight_per_length / rope.axial_stiffness];
        let bounds = Some(ArcBounds { slope, second, turn });
        Self { s, points_w, sagitta, outward_w: Some(outward_w), middle: if inside { middle } else { half }, bounds }
    }

    /// True if a place is on the arc.
    pub(super) fn holds(&self, s: f64) -> bool {
        (self.s[0]..=self.s[1]).contains(&s)
    }

    /// Bound of how far the arc reaches beyond its chord in the direction of a unit vector [m].
    pub(super) fn reach(&self, direction_w: &Vec3) -> f64 {
        self.outward_w.map_or(self.sagitta, |outward_w| self.sagitta * outward_w.dot(direction_w).max(0.0))
    }

    /// Lower bound of the second derivative of half the squared distance along this arc from the points of another one,
    /// none of which is farther than `farthest` [m]. It is least where the other one lies far on the side to which this
    /// one bends.
    pub(super) fn least_second_derivative(&self, bounds: &ArcBounds, other: &Self, farthest: f64) -> f64 {
        let square = bounds.slope[0] * bounds.slope[0];
        let Some(outward_w) = self.outward_w else { return square };
        let inward_w = -outward_w;
        let own = self.points_w[0].dot(&inward_w) - self.sagitta;
        let others = other.points_w[0].dot(&inward_w).max(other.points_w[1].dot(&inward_w)) + other.reach(&inward_w);
        // Change of a unit vector that turns by the angle, without cancellation: twice the sine of half of it, (40r).
        let [cos, sin] = bounds.turn;
        let turned = sin * (2.0 / (1.0 + cos)).sqrt();
        let beyond = (others - own + farthest * turned).max(0.0);
        square - bounds.second[0] * beyond - bounds.second[1] * farthest
    }
}

impl ArcBounds {
    /// Square of the greatest second derivative [1/m²].
    pub(super) fn bend_squared(&self) -> f64 {
        self.second[0] * self.second[0] + self.second[1] * self.second[1]
    }

    /// Cosine of the least angle between the lines of two arcs: the angle between their chords, less what the curves
    /// turn from them.
    pub(super) fn greatest_cosine(own: &Self, others: &Self, chords_w: [&Vec3; 2]) -> f64 {
        let size = (chords_w[0].norm_squared() * chords_w[1].norm_squared()).sqrt();
        // Differences of angles by their cosines and sines.
        let mut angle = [chords_w[0].dot(chords_w[1]).abs() / size, chords_w[0].cross(chords_w[1]).norm() / size];
        for [cos, sin] in [own.turn, others.turn] {
            if angle[1] * cos <= angle[0] * sin {
                return 1.0;
            }
            angle = [angle[0] * cos + angle[1] * sin, angle[1] * cos - angle[0] * sin];
        }
        angle[0]
    }
}
