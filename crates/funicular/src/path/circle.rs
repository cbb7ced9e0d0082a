//! Circles of the platform's origin.

use super::course::{Course, CourseForm, MotionLimits};
use super::limits_kept::largest;
use super::profile::SAME_CORNER;
use super::{PathCorner, PathError, PathPoint, Side};
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
        let times: Vec<f64> = circle.corners().iter().map(|corner| corner.time).collect();
        let excess = largest(&times, |time, side| limits.used_by(&circle.at(time, side))).time_factor();
        if excess > 1.0 {
            course = course.slowed(excess);
            circle.course = course;
        }
        Ok(circle)
    }

    pub(super) fn duration(&self) -> f64 {
        self.course.duration()
    }

    /// Times at which a derivative jumps, ascending.
    pub(super) fn corners(&self) -> Vec<PathCorner> {
        let all = self.course.corners().into_iter().map(|(time, order)| PathCorner { time, order });
        PathCorner::merged(all.collect(), SAME_CORNER * self.duration())
    }

    pub(super) fn at(&self, time: f64, side: Side) -> PathPoint {
        let [done, rate, second, third] = self.course.at(time, side).map(|of| self.angle * of);
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
