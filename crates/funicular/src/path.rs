//! Paths of the platform over time: its pose with three derivatives, at every time.

mod arc;
mod bandwidth;
mod circle;
mod course;
mod limits_kept;
mod moves;
mod profile;
mod shaper;
mod smoothing;
mod straight_move;
mod table;

pub use course::{CourseForm, MotionLimits};
pub use limits_kept::UsedParts;
pub use moves::{Leg, LegWay};
pub use profile::Profile;
pub(crate) use profile::mean_exponential;
pub use shaper::{Impulse, Shaper, ShaperKind};
pub use smoothing::smoothed_within;
pub use straight_move::StraightMove;
pub use table::MAX_TURN_DEG;

use crate::math::{Rotation, Vec3, Vec6};
use crate::robot::{Pose, Robot};
use circle::Circle;
use moves::Moves;
use table::PathTable;
use thiserror::Error;

/// Path of the platform over time, from t = 0 on.
///
/// # Example
/// ```
/// use funicular::path::{CourseForm, MotionLimits, PlatformPath};
/// use funicular::robot::Pose;
///
/// let limits = MotionLimits { speed: 1.0, acceleration: 2.0, jerk: 10.0, ..MotionLimits::default() };
/// let poses = [Pose::new([0.0, 0.0, 1.0], [0.0; 3]), Pose::new([3.0, 0.0, 1.0], [0.0; 3])];
/// let path = PlatformPath::through(&poses, &limits, CourseForm::JerkLimited, 0.0)?;
/// assert!((path.duration() - 3.7).abs() < 1e-12); // s: 3 m at 1 m/s, 0.5 s to get to it, 0.2 s to accelerate
/// assert!((path.at(1.85).velocity_w[0] - 1.0).abs() < 1e-12); // m/s
/// # Ok::<(), funicular::path::PathError>(())
/// ```
///
/// # References
/// docs/theory.md, section 10d.
#[derive(Debug, Clone, PartialEq)]
pub struct PlatformPath {
    shape: PathShape,
    /// Factor of all times.
    slowness: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum PathShape {
    Moves(Moves),
    Circle(Circle),
    Table(PathTable),
}

/// Motion of the platform at one time of a path. Vectors have the translation of the origin first, then the rotation;
/// world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Pose.
    pub pose: Pose,
    /// Velocity of the origin [m/s] and angular velocity [rad/s].
    pub velocity_w: Vec6,
    /// Acceleration of the origin [m/s²] and angular acceleration [rad/s²].
    pub acceleration_w: Vec6,
    /// Rates of both accelerations [m/s³, rad/s³].
    pub jerk_w: Vec6,
}

/// Side of a time from which a motion is looked at. Both differ where a derivative jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Just before the time.
    Before,
    /// Just after it.
    After,
}

/// Time at which a derivative of a path jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathCorner {
    /// Time [s].
    pub time: f64,
    /// Lowest order of the derivatives that jump: 2 for the acceleration, 3 for the jerk, 4 for its rate.
    pub order: usize,
}

impl PathCorner {
    /// Order of the jerk among the derivatives of the pose.
    pub const JERK: usize = 3;

    /// Corners in ascending order; several within a time [s] are the one with the lowest order.
    fn merged(mut corners: Vec<Self>, same: f64) -> Vec<Self> {
        corners.sort_by(|a, b| a.time.total_cmp(&b.time));
        let mut found: Vec<Self> = Vec::with_capacity(corners.len());
        for corner in corners {
            match found.last_mut() {
                Some(last) if corner.time - last.time <= same => last.order = last.order.min(corner.order),
                _ => found.push(corner),
            }
        }
        found
    }
}

/// Fault of a path.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PathError {
    /// A move without limits has no duration.
    #[error("the {of} of the path has no limits: give its largest speed and acceleration")]
    NoLimit {
        /// `translation` or `turn`.
        of: &'static str,
    },
    /// Two poses in a row are the same.
    #[error("poses {first} and {} of the path are the same: leave one of them out", first + 1)]
    NoMove {
        /// Number of the first of the two, from 1.
        first: usize,
    },
    /// A circle without radius.
    #[error("the start is on the axis of the circle: move the centre, or turn the axis")]
    NoRadius,
    /// Times that do not rise.
    #[error("row {row} of the path: {time} s is not after {before} s; times have to rise")]
    TimesFall {
        /// Number of the row, from 1.
        row: usize,
        /// Time of the station [s].
        time: f64,
        /// Time of the row before [s].
        before: f64,
    },
    /// The platform turns too far between two rows for its way to be known.
    #[error(
        "rows {} and {row} of the path: the platform turns by {turn_deg:.4}° between them; the way of a turn is known \
         up to {MAX_TURN_DEG}°: add rows between",
        row - 1
    )]
    TurnsTooFar {
        /// Number of the second row, from 1.
        row: usize,
        /// Angle [degrees].
        turn_deg: f64,
    },
    /// The platform jumps between two rows.
    #[error(
        "rows {} and {row} of the path: {distance:.4} m in {time:.4} s are a jump, {ratio:.0} times as fast as the \
         usual speed of the path: correct the row, or its time",
        row - 1
    )]
    Jump {
        /// Number of the second row, from 1.
        row: usize,
        /// Distance [m].
        distance: f64,
        /// Time between the rows [s].
        time: f64,
        /// Speed over the usual one.
        ratio: f64,
    },
}

impl PlatformPath {
    /// Straight moves through poses, each by its shorter turn and from rest to rest. Every move is as fast as the
    /// limits allow. `blend` from 0 to 1 lets every move begin before the one before it has come to rest, so that the
    /// path rounds the corner: by all of the time of the slowing down, or this part of it.
    ///
    /// # Errors
    /// [`PathError::NoLimit`], [`PathError::NoMove`].
    pub fn through(poses: &[Pose], limits: &MotionLimits, form: CourseForm, blend: f64) -> Result<Self, PathError> {
        let Some((start, rest)) = poses.split_first() else { return Err(PathError::NoMove { first: 1 }) };
        let straight = |to: &Pose| Leg { to: *to, way: LegWay::Straight, speed: f64::INFINITY };
        Self::along(start, &rest.iter().map(straight).collect::<Vec<_>>(), limits, form, blend)
    }

    /// Moves from a pose on, straight or along arcs, each from rest to rest with its own speed; otherwise as
    /// [`PlatformPath::through`].
    ///
    /// # Errors
    /// [`PathError::NoLimit`], [`PathError::NoMove`], [`PathError::NoRadius`].
    pub fn along(
        start: &Pose,
        legs: &[Leg],
        limits: &MotionLimits,
        form: CourseForm,
        blend: f64,
    ) -> Result<Self, PathError> {
        Ok(Self { shape: PathShape::Moves(Moves::along(start, legs, limits, form, blend)?), slowness: 1.0 })
    }

    /// Circle about an axis through a centre, from rest to rest, without a turn of the platform. Positive turns go
    /// round by the right-hand rule.
    ///
    /// # Errors
    /// [`PathError::NoRadius`], [`PathError::NoLimit`].
    pub fn circle(
        start: &Pose,
        (center_w, axis_w): (&Vec3, &Vec3),
        turns: f64,
        limits: &MotionLimits,
        form: CourseForm,
    ) -> Result<Self, PathError> {
        Ok(Self { shape: PathShape::Circle(Circle::new(start, center_w, axis_w, turns, limits, form)?), slowness: 1.0 })
    }

    /// Smooth path through the rows of a table; its times begin at any value. Position and quaternion are splines of
    /// the fifth degree with four continuous derivatives.
    ///
    /// # Errors
    /// [`PathError::TimesFall`], [`PathError::TurnsTooFar`], [`PathError::Jump`].
    ///
    /// # Panics
    /// With fewer than two rows, or numbers of times and poses that differ.
    pub fn of_table(times: &[f64], poses: &[Pose]) -> Result<Self, PathError> {
        Ok(Self { shape: PathShape::Table(PathTable::new(times, poses)?), slowness: 1.0 })
    }

    /// Path with all times multiplied by a positive factor.
    #[must_use]
    pub fn slowed(&self, factor: f64) -> Self {
        Self { shape: self.shape.clone(), slowness: self.slowness * factor }
    }

    /// Time of its end [s].
    pub fn duration(&self) -> f64 {
        let own = match &self.shape {
            PathShape::Moves(moves) => moves.duration(),
            PathShape::Circle(circle) => circle.duration(),
            PathShape::Table(table) => table.duration(),
        };
        own * self.slowness
    }

    /// Times at which a derivative up to that of the jerk jumps, ascending. The rates of lengths jump where the jerk
    /// does, because tensions and sag follow the acceleration. None within a table.
    pub fn corners(&self) -> Vec<PathCorner> {
        let own = match &self.shape {
            PathShape::Moves(moves) => moves.corners(),
            PathShape::Circle(circle) => circle.corners(),
            PathShape::Table(_) => Vec::new(),
        };
        own.into_iter().map(|corner| PathCorner { time: corner.time * self.slowness, ..corner }).collect()
    }

    /// Motion at a time [s]; at rest before the begin and after the end, where a table holds its first or last motion.
    /// Where a derivative jumps, the motion just after the time, and at the end of the path that just before it.
    pub fn at(&self, time: f64) -> PathPoint {
        let duration = self.duration();
        let is_end = (time - duration).abs() <= profile::SAME_CORNER * duration;
        self.beside(time, if is_end { Side::Before } else { Side::After })
    }

    /// Motion just before or just after a time [s].
    pub fn beside(&self, time: f64, side: Side) -> PathPoint {
        let own = time / self.slowness;
        let mut point = match &self.shape {
            PathShape::Moves(moves) => moves.at(own, side),
            PathShape::Circle(circle) => circle.at(own, side),
            PathShape::Table(table) => table.at(own),
        };
        point.velocity_w /= self.slowness;
        point.acceleration_w /= self.slowness.powi(2);
        point.jerk_w /= self.slowness.powi(3);
        point
    }

    /// Largest parts of limits that the motion uses, over all its time.
    pub fn used_parts(&self, limits: &MotionLimits) -> UsedParts {
        let ends = [0.0, self.duration()];
        let mut times: Vec<f64> = self.corners().iter().map(|corner| corner.time).chain(ends).collect();
        times.sort_by(f64::total_cmp);
        limits_kept::largest(&times, |time, side| limits.used_by(&self.beside(time, side)))
    }

    /// Least distance at which the path passes each pose that it goes through, between the first and the last [m]; more
    /// than zero where it rounds a corner. Empty for circles and tables.
    pub fn misses(&self) -> Vec<f64> {
        if let PathShape::Moves(moves) = &self.shape { moves.misses() } else { Vec::new() }
    }
}

impl PathPoint {
    /// Platform at rest at a pose.
    pub fn at_rest(pose: &Pose) -> Self {
        let none = Vec6::zeros();
        Self { pose: *pose, velocity_w: none, acceleration_w: none, jerk_w: none }
    }

    /// Velocity of the origin [m/s] and angular velocity [rad/s].
    pub fn twist(&self) -> [Vec3; 2] {
        parts(&self.velocity_w)
    }

    /// Force [N] and moment about the origin [N m] of the inertia of the platform on itself, world axes.
    ///
    /// # References
    /// docs/theory.md, equation (40z5).
    pub fn inertia(&self, robot: &Robot) -> [Vec3; 2] {
        let of = PlatformInertia::of(robot, self);
        [of.force_w, of.moment_w]
    }

    /// Motion a short time later [s], by its derivatives.
    #[must_use]
    pub(crate) fn shifted(&self, time: f64) -> Self {
        let change =
            self.velocity_w * time + self.acceleration_w * (0.5 * time * time) + self.jerk_w * (time.powi(3) / 6.0);
        let turn = Rotation::from_scaled_axis(Vec3::new(change[3], change[4], change[5]));
        Self {
            pose: Pose {
                position_w: self.pose.position_w + Vec3::new(change[0], change[1], change[2]),
                rot_wp: turn * self.pose.rot_wp,
            },
            velocity_w: self.velocity_w + self.acceleration_w * time + self.jerk_w * (0.5 * time * time),
            acceleration_w: self.acceleration_w + self.jerk_w * time,
            jerk_w: self.jerk_w,
        }
    }

    /// Coefficients of t and t² of [`Self::inertia`] at a time t after this one, velocity, acceleration and jerk at
    /// their derivatives here.
    pub(crate) fn inertia_along(&self, robot: &Robot) -> [Vec6; 2] {
        let (mass, rot) = (robot.platform.mass, self.pose.rot_wp);
        let ([_, turn], [linear, angular], [jerk, angular_jerk]) =
            (self.twist(), parts(&self.acceleration_w), parts(&self.jerk_w));
        // The rotation of a vector that is fixed to the platform, and the inverse of it, up to t².
        let turned = |vector_p: &Vec3| {
            let vector_w = rot * vector_p;
            let rate = turn.cross(&vector_w);
            [vector_w, rate, (angular.cross(&vector_w) + turn.cross(&rate)) * 0.5]
        };
        let axes: [[Vec3; 3]; 3] = std::array::from_fn(|k| turned(&Vec3::from_fn(|i, _| f64::from(u8::from(i == k)))));
        let into_platform = |of: &Along| {
            Along(std::array::from_fn(|order| {
                Vec3::from_fn(|k, _| (0..=order).map(|part| axes[k][part].dot(&of.0[order - part])).sum())
            }))
        };
        let into_world = |of: &Along| {
            Along(std::array::from_fn(|order| {
                (0..=order).map(|part| (0..3).map(|k| axes[k][part] * of.0[order - part][k]).sum::<Vec3>()).sum()
            }))
        };
        let spun = |of: &Along| {
            let inside = into_platform(of);
            into_world(&Along(inside.0.map(|coefficient| robot.platform.inertia_p * coefficient)))
        };

        let arm = Along(turned(&robot.platform.center_of_mass_p));
        let omega = Along([turn, angular, angular_jerk * 0.5]);
        let alpha = Along([angular, angular_jerk, Vec3::zeros()]);
        let own = Along([linear, jerk, Vec3::zeros()]);
        let at_center = own + alpha.cross(&arm) + omega.cross(&omega.cross(&arm));
        let force = Along(at_center.0.map(|coefficient| coefficient * -mass));
        let moment = arm.cross(&force) - spun(&alpha) - omega.cross(&spun(&omega));
        [1, 2].map(|k| {
            let (force, moment) = (force.0[k], moment.0[k]);
            Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
        })
    }

    /// Rates of [`Self::inertia`] [N/s, N m/s].
    pub fn inertia_rate(&self, robot: &Robot) -> [Vec3; 2] {
        PlatformInertia::of(robot, self).rate(self)
    }
}

/// Wrench of the inertia, with the terms of its rate.
struct PlatformInertia {
    mass: f64,
    /// From the origin to the centre of mass.
    arm_w: Vec3,
    tensor_w: crate::math::Mat3,
    force_w: Vec3,
    moment_w: Vec3,
}

impl PlatformInertia {
    fn of(robot: &Robot, point: &PathPoint) -> Self {
        let (rot, platform) = (&point.pose.rot_wp, &robot.platform);
        let ([_, omega], [linear, angular]) = (point.twist(), parts(&point.acceleration_w));
        let arm_w = rot * platform.center_of_mass_p;
        let matrix = rot.to_rotation_matrix();
        let tensor_w = matrix.matrix() * platform.inertia_p * matrix.matrix().transpose();

        let at_center = linear + angular.cross(&arm_w) + omega.cross(&omega.cross(&arm_w));
        let force_w = at_center * -platform.mass;
        let spin = tensor_w * angular + omega.cross(&(tensor_w * omega));
        Self { mass: platform.mass, arm_w, tensor_w, force_w, moment_w: arm_w.cross(&force_w) - spin }
    }

    fn rate(&self, point: &PathPoint) -> [Vec3; 2] {
        let ([_, omega], [_, alpha], [jerk, beta]) =
            (point.twist(), parts(&point.acceleration_w), parts(&point.jerk_w));
        let (arm, tensor) = (&self.arm_w, &self.tensor_w);
        let arm_rate = omega.cross(arm);

        let at_center = jerk
            + beta.cross(arm)
            + alpha.cross(&arm_rate)
            + alpha.cross(&arm_rate)
            + omega.cross(&(alpha.cross(arm) + omega.cross(&arm_rate)));
        let force = at_center * -self.mass;

        let of_alpha = tensor * beta + omega.cross(&(tensor * alpha)) - tensor * omega.cross(&alpha);
        let momentum_rate = tensor * alpha + omega.cross(&(tensor * omega));
        let spin = of_alpha + alpha.cross(&(tensor * omega)) + omega.cross(&momentum_rate);
        [force, arm_rate.cross(&self.force_w) + arm.cross(&force) - spin]
    }
}

/// Vector along a motion: coefficients of 1, t and t².
#[derive(Clone, Copy)]
struct Along([Vec3; 3]);

impl Along {
    fn cross(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|order| (0..=order).map(|part| self.0[part].cross(&other.0[order - part])).sum()))
    }
}

impl std::ops::Add for Along {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl std::ops::Sub for Along {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

/// Translation and rotation of a vector.
fn parts(of: &Vec6) -> [Vec3; 2] {
    [Vec3::new(of[0], of[1], of[2]), Vec3::new(of[3], of[4], of[5])]
}
