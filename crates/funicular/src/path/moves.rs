//! Moves one after the other, straight or along arcs, which may overlap in time.

use super::arc::HelicalArc;
use super::course::{Course, CourseForm, MotionLimits};
use super::limits_kept::{UsedParts, largest};
use super::profile::SAME_CORNER;
use super::{PathCorner, PathError, PathPoint, Side, StraightMove, parts};
use crate::math::{Rotation, Vec3, Vec6};
use crate::robot::Pose;

/// Number of times at which the distance to a pose is looked at while two moves overlap.
const LOOKS: usize = 200;

/// Largest number of times that the limits of two moves which overlap are lowered. What is left then slows the whole
/// path down, so that more rounds would make it faster at most.
const ROUNDS: usize = 4;

/// Move of a job: where it ends, its way and its own speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Pose at its end.
    pub to: Pose,
    /// Way of the origin.
    pub way: LegWay,
    /// Largest speed of the origin [m/s], as a feed rate; infinite for that of all moves.
    pub speed: f64,
}

/// Way of the platform origin from one pose to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegWay {
    /// Straight line.
    Straight,
    /// Circular arc about an axis, or a helix if start and end differ along the axis.
    Arc {
        /// Point of the axis.
        center_w: Vec3,
        /// Direction of the axis.
        axis_w: Vec3,
        /// Angle by the right-hand rule [rad]; more than a whole turn is several turns.
        angle: f64,
    },
}

/// Moves from pose to pose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moves {
    /// Pose before each move, and after the last.
    poses: Vec<Pose>,
    moves: Vec<TimedMove>,
}

/// One move with the time of its begin.
#[derive(Debug, Clone, PartialEq)]
struct TimedMove {
    begins: f64,
    straight: StraightMove,
    /// Way of the origin if it is no straight line.
    arc: Option<HelicalArc>,
    course: Course,
}

impl TimedMove {
    fn ends(&self) -> f64 {
        self.begins + self.course.duration()
    }

    /// Way of the origin at a state of the course, with three derivatives.
    fn way(&self, course: [f64; 4]) -> [Vec3; 4] {
        self.arc.as_ref().map_or_else(|| course.map(|of| self.straight.translation_w * of), |arc| arc.way(course))
    }

    /// Slows a move along an arc down until the acceleration towards its axis fits the limits too.
    fn keep_limits_on_arc(&mut self, limits: &MotionLimits, form: CourseForm, turn: f64) -> Result<(), PathError> {
        let Some(arc) = self.arc.clone() else { return Ok(()) };
        let limits = MotionLimits { speed: limits.speed.min(arc.largest_speed(limits)), ..*limits };
        self.course = Course::within(&limits, form, arc.length(), turn)?;

        // While the speed changes, accelerations and jerks along and across the arc add up.
        let times: Vec<f64> = self.course.corners().into_iter().map(|(time, _)| time).collect();
        let motion = |time: f64, side: Side| {
            let [way, rate, second, third] = arc.way(self.course.at(time, side));
            let mut point = PathPoint::at_rest(&self.straight.pose(0.0));
            point.pose.position_w += way;
            add(&mut point.velocity_w, &rate, &Vec3::zeros());
            add(&mut point.acceleration_w, &second, &Vec3::zeros());
            add(&mut point.jerk_w, &third, &Vec3::zeros());
            point
        };
        let excess = largest(&times, |time, side| limits.used_by(&motion(time, side))).time_factor();
        if excess > 1.0 {
            self.course = self.course.slowed(excess);
        }
        Ok(())
    }
}

/// Pose after a move from a pose.
fn done_by(from: &Pose, of: &TimedMove) -> Pose {
    let [way, ..] = of.way([1.0, 0.0, 0.0, 0.0]);
    Pose { position_w: from.position_w + way, rot_wp: Rotation::from_scaled_axis(of.straight.turn_w) * from.rot_wp }
}

impl Moves {
    /// Moves from a pose on, each within the limits of all and its own speed. Where two overlap, the accelerations of
    /// both add up: the limits of such moves are lowered until the sum keeps those of the request. If that takes longer
    /// than to stop at every pose, they stop.
    pub(super) fn along(
        start: &Pose,
        legs: &[Leg],
        limits: &MotionLimits,
        form: CourseForm,
        blend: f64,
    ) -> Result<Self, PathError> {
        let own = |leg: &Leg| MotionLimits { speed: limits.speed.min(leg.speed), ..*limits };
        let own: Vec<MotionLimits> = legs.iter().map(own).collect();
        let mut lowered = own.clone();
        let stopping = Self::with_limits(start, legs, &lowered, form, 0.0)?;
        let mut found = Self::with_limits(start, legs, &lowered, form, blend)?;
        for _ in 0..ROUNDS {
            let excess = found.excess_of_moves(&own);
            if excess.iter().all(UsedParts::are_kept) {
                break;
            }
            for (own, of) in lowered.iter_mut().zip(&excess) {
                *own = own.lowered(of);
            }
            found = Self::with_limits(start, legs, &lowered, form, blend)?;
        }
        let left = found.excess_of_moves(&own).iter().map(UsedParts::time_factor).fold(1.0, f64::max);
        let found = found.slowed(left);
        Ok(if found.duration() < stopping.duration() { found } else { stopping })
    }

    /// Moves from a pose on, each within its own limits.
    fn with_limits(
        start: &Pose,
        legs: &[Leg],
        limits: &[MotionLimits],
        form: CourseForm,
        blend: f64,
    ) -> Result<Self, PathError> {
        let mut moves: Vec<TimedMove> = Vec::with_capacity(legs.len());
        let (mut poses, mut from) = (vec![*start], *start);
        for (k, (leg, limits)) in legs.iter().zip(limits).enumerate() {
            let straight = StraightMove::between(&from, &leg.to);
            let arc = match leg.way {
                LegWay::Straight => None,
                LegWay::Arc { center_w, axis_w, angle } => {
                    let ends = [&from.position_w, &leg.to.position_w];
                    Some(HelicalArc::new(ends, &center_w, &axis_w, angle).ok_or(PathError::NoRadius)?)
                }
            };
            let way = arc.as_ref().map_or(straight.translation_w.norm(), HelicalArc::length);
            let turn = straight.turn_w.norm();
            if way == 0.0 && turn == 0.0 {
                return Err(PathError::NoMove { first: k + 1 });
            }
            let mut own = TimedMove { begins: 0.0, straight, arc, course: Course::within(limits, form, way, turn)? };
            own.keep_limits_on_arc(limits, form, turn)?;

            // Two moves overlap while the one slows down and the other speeds up.
            own.begins = moves.last().map_or(0.0, |last| {
                let both = last.course.slowing().min(own.course.slowing());
                last.ends() - blend * both
            });
            poses.push(done_by(&poses[k], &own));
            moves.push(own);
            from = leg.to;
        }
        Ok(Self { poses, moves })
    }

    /// Used parts of the limits while each move overlaps with its neighbours. Where two speeds meet, the higher one is
    /// allowed.
    fn excess_of_moves(&self, own: &[MotionLimits]) -> Vec<UsedParts> {
        let mut found = vec![UsedParts::default(); self.moves.len()];
        let times: Vec<f64> = self.corners().into_iter().map(|corner| corner.time).collect();
        for (k, pair) in self.moves.windows(2).enumerate() {
            let (from, to) = (pair[1].begins, pair[0].ends());
            if to <= from {
                continue;
            }
            let limits = MotionLimits { speed: own[k].speed.max(own[k + 1].speed), ..own[k] };
            let first = times.partition_point(|time| *time <= from);
            let inside = times[first..].iter().copied().take_while(|time| *time < to);
            let corners: Vec<f64> = std::iter::once(from).chain(inside).chain([to]).collect();
            let used = largest(&corners, |time, side| limits.used_by(&self.at(time, side)));
            for of in &mut found[k..k + 2] {
                *of = of.larger(&used);
            }
        }
        found
    }

    /// The moves with all times multiplied by a positive factor.
    fn slowed(mut self, factor: f64) -> Self {
        for of in &mut self.moves {
            of.begins *= factor;
            of.course = of.course.slowed(factor);
        }
        self
    }

    pub(super) fn duration(&self) -> f64 {
        self.moves.iter().map(TimedMove::ends).fold(0.0, f64::max)
    }

    /// Times at which a derivative jumps, ascending.
    pub(super) fn corners(&self) -> Vec<PathCorner> {
        let of = |of: &TimedMove| {
            let at = |(time, order)| PathCorner { time: of.begins + time, order };
            of.course.corners().into_iter().map(at).collect::<Vec<_>>()
        };
        let shortest = self.moves.iter().map(|of| of.course.duration()).fold(f64::INFINITY, f64::min);
        PathCorner::merged(self.moves.iter().flat_map(of).collect(), SAME_CORNER * shortest)
    }

    /// Sum of the translations, and the turns one after the other: a later turn acts on what the earlier ones have
    /// done.
    pub(super) fn at(&self, time: f64, side: Side) -> PathPoint {
        // Moves follow each other: those that have ended are in the pose, and of the others few have begun.
        let same = |of: &TimedMove| SAME_CORNER * of.course.duration();
        let first = self.moves.partition_point(|of| of.ends() + same(of) < time);
        let mut point = PathPoint::at_rest(&self.poses[first]);
        for of in self.moves[first..].iter().take_while(|of| of.begins - same(of) <= time) {
            let course = of.course.at(time - of.begins, side);
            let [done, rate, second, third] = course;
            let turn = of.straight.turn_w;
            let rotation = Rotation::from_scaled_axis(turn * done);

            let [way, way_rate, way_second, way_third] = of.way(course);
            point.pose.position_w += way;
            point.pose.rot_wp = rotation * point.pose.rot_wp;

            let turned = |of: &Vec6| rotation * parts(of)[1];
            let [w, a, j] = [turned(&point.velocity_w), turned(&point.acceleration_w), turned(&point.jerk_w)];
            let (own_w, own_a, own_j) = (turn * rate, turn * second, turn * third);
            let swept = own_w.cross(&w);
            add(&mut point.velocity_w, &way_rate, &(own_w + w));
            add(&mut point.acceleration_w, &way_second, &(own_a + a + swept));
            let jerk = own_j + j + own_a.cross(&w) + own_w.cross(&(2.0 * a + swept));
            add(&mut point.jerk_w, &way_third, &jerk);
        }
        point
    }

    /// Least distance from each inner pose of the path.
    pub(super) fn misses(&self) -> Vec<f64> {
        let pairs = self.moves.windows(2);
        pairs
            .map(|pair| {
                let corner_w = pair[1].straight.pose(0.0).position_w;
                let overlap = pair[0].ends() - pair[1].begins;
                let at = |k: usize| pair[1].begins + overlap * k as f64 / LOOKS as f64;
                let distance = |k: usize| (self.at(at(k), Side::After).pose.position_w - corner_w).norm();
                if overlap > 0.0 { (0..=LOOKS).map(distance).fold(f64::INFINITY, f64::min) } else { 0.0 }
            })
            .collect()
    }
}

/// Adds a translation, and sets the rotation.
fn add(of: &mut Vec6, translation: &Vec3, rotation: &Vec3) {
    for k in 0..3 {
        of[k] += translation[k];
        of[k + 3] = rotation[k];
    }
}
