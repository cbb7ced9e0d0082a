//! Circles of the platform's origin.

use super::course::{Course, CourseForm, MotionLimits};
use super::{PathError, PathPoint};
use crate::math::{Vec3, Vec6};
use crate::robot::Pose;
use std::f64::consts::TAU;

/// Distance of the start from the axis, over that of the centre, below which a circle has no radius: rounding.
const NO_RADIUS: f64 = 1e-12;

/// Circle about an axis, from rest to rest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Circle {
    start: Pose,
    /// Centre of the circle.
    center_w: Vec3,
    /// From the centre to the start, and a quarter of a turn on.
    radius_w: Vec3,
    quarter_w: Vec3,
    /// Angle of the whole path [rad].
    angle: f64,
    course: Course,
}

impl Circle {
    pub(super) fn new(
        start: &Pose,
        center_w: &Vec3,
        axis_w: &Vec3,
        turns: f64,
        limits: &MotionLimits,
        form: CourseForm,
    ) -> Result<Self, PathError> {
        let axis_w = axis_w.normalize();
        let from_center = start.position_w - center_w;
        let along = axis_w * from_center.dot(&axis_w);
        let radius_w = from_center - along;
        let (radius, angle) = (radius_w.norm(), TAU * turns);
        if radius <= NO_RADIUS * from_center.norm().max(1.0) {
            return Err(PathError::NoRadius);
        }

        // At constant speed all of the acceleration points inwards.
        let limits = MotionLimits { speed: limits.speed.min((limits.acceleration * radius).sqrt()), ..*limits };
        let mut course = Course::within(&limits, form, radius * angle.abs(), 0.0)?;

        // While the speed changes, both accelerations and all jerks add up: the course is slowed until they fit.
        let mut circle = Self {
            start: *start,
            center_w: center_w + along,
            radius_w,
            quarter_w: axis_w.cross(&radius_w),
            angle,
            course: course.clone(),
        };
        let excess = circle.excess(&limits);
        if excess > 1.0 {
            course = course.slowed(excess);
            circle.course = course;
        }
        Ok(circle)
    }

    /// Factor of the time with which acceleration and jerk keep their limits.
    fn excess(&self, limits: &MotionLimits) -> f64 {
        /// Number of times at which the motion is looked at.
        const LOOKS: usize = 400;
        let factor = |k: usize| {
            let point = self.at(self.duration() * k as f64 / LOOKS as f64);
            let size = |of: &Vec6| of.fixed_rows::<3>(0).norm();
            let [acceleration, jerk] = [size(&point.acceleration_w), size(&point.jerk_w)];
            (acceleration / limits.acceleration).sqrt().max((jerk / limits.jerk).cbrt())
        };
        (0..=LOOKS).map(factor).fold(1.0, f64::max)
    }

    pub(super) fn duration(&self) -> f64 {
        self.course.duration()
    }

    /// Times at which the jerk jumps [s].
    pub(super) fn corner_times(&self) -> Vec<f64> {
        self.course.corner_times()
    }

    pub(super) fn at(&self, time: f64) -> PathPoint {
        let [done, rate, second, third] = self.course.at(time).map(|of| self.angle * of);
        let (sin, cos) = done.sin_cos();
        let outwards = self.radius_w * cos + self.quarter_w * sin;
        let along = self.quarter_w * cos - self.radius_w * sin;

        let six = |of: Vec3| Vec6::new(of.x, of.y, of.z, 0.0, 0.0, 0.0);
        PathPoint {
            pose: Pose { position_w: self.center_w + outwards, ..self.start },
            velocity_w: six(along * rate),
            acceleration_w: six(along * second - outwards * rate.powi(2)),
            jerk_w: six(along * (third - rate.powi(3)) - outwards * (3.0 * rate * second)),
        }
    }
}
