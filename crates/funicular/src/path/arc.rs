//! Circular arcs and helices of the platform's origin, as parts of a job.

use super::course::MotionLimits;
use crate::math::Vec3;

/// Radius over the distance of the start from the centre, below which an arc has none: rounding.
const NO_RADIUS: f64 = 1e-12;

/// Arc about an axis, with a way along the axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HelicalArc {
    /// From the axis to the start, and a quarter of a turn on.
    radius_w: Vec3,
    quarter_w: Vec3,
    /// Way along the axis and rest of the way between the ends, over the whole arc.
    along_w: Vec3,
    angle: f64,
}

impl HelicalArc {
    /// Arc between two points by this angle about an axis; `None` without a radius. What the end is off the circle of
    /// the start goes along evenly, so that the arc ends where it has to.
    pub(super) fn new([from, to]: [&Vec3; 2], center_w: &Vec3, axis_w: &Vec3, angle: f64) -> Option<Self> {
        let axis_w = axis_w.try_normalize(0.0)?;
        let out = from - center_w;
        let radius_w = out - axis_w * out.dot(&axis_w);
        if radius_w.norm() <= NO_RADIUS * out.norm().max(1.0) || angle == 0.0 {
            return None;
        }
        let quarter_w = axis_w.cross(&radius_w);
        let (sin, cos) = angle.sin_cos();
        let circle = radius_w * (cos - 1.0) + quarter_w * sin;
        Some(Self { radius_w, quarter_w, along_w: to - from - circle, angle })
    }

    /// Length of the way [m].
    pub(super) fn length(&self) -> f64 {
        (self.radius_w.norm() * self.angle).hypot(self.along_w.norm())
    }

    /// Speed at which the acceleration and the jerk across the way are at their limits [m/s].
    pub(super) fn largest_speed(&self, limits: &MotionLimits) -> f64 {
        let radius = self.radius_w.norm();
        let whole = self.length() / (radius * self.angle.abs());
        (limits.acceleration * radius).sqrt().min((limits.jerk * radius * radius).cbrt()) * whole
    }

    /// Way from the start at a state of the course, with three derivatives.
    pub(super) fn way(&self, course: [f64; 4]) -> [Vec3; 4] {
        let [done, rate, second, third] = course.map(|of| self.angle * of);
        let (sin, cos) = done.sin_cos();
        let outwards = self.radius_w * cos + self.quarter_w * sin;
        let around = self.quarter_w * cos - self.radius_w * sin;
        let along = course.map(|of| self.along_w * of);
        [
            outwards - self.radius_w + along[0],
            around * rate + along[1],
            around * second - outwards * rate.powi(2) + along[2],
            around * (third - rate.powi(3)) - outwards * (3.0 * rate * second) + along[3],
        ]
    }
}
