//! Straight moves one after the other, which may overlap in time.

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

/// Moves from pose to pose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moves {
    start: Pose,
    moves: Vec<TimedMove>,
}

/// One move with the time of its begin.
#[derive(Debug, Clone, PartialEq)]
struct TimedMove {
    begins: f64,
    straight: StraightMove,
    course: Course,
}

impl TimedMove {
    fn ends(&self) -> f64 {
        self.begins + self.course.duration()
    }
}

impl Moves {
    /// Moves through poses. Where two overlap, the accelerations of both add up: the limits of such moves are lowered
    /// until the sum keeps those of the request. If that takes longer than to stop at every pose, they stop.
    pub(super) fn through(
        poses: &[Pose],
        limits: &MotionLimits,
        form: CourseForm,
        blend: f64,
    ) -> Result<Self, PathError> {
        let mut lowered = vec![*limits; poses.len().saturating_sub(1)];
        let stopping = Self::with_limits(poses, &lowered, form, 0.0)?;
        let mut found = Self::with_limits(poses, &lowered, form, blend)?;
        for _ in 0..ROUNDS {
            let excess = found.excess_of_moves(limits);
            if excess.iter().all(UsedParts::are_kept) {
                break;
            }
            for (own, of) in lowered.iter_mut().zip(&excess) {
                *own = own.lowered(of);
            }
            found = Self::with_limits(poses, &lowered, form, blend)?;
        }
        let left = found.excess_of_moves(limits).iter().map(UsedParts::time_factor).fold(1.0, f64::max);
        let found = found.slowed(left);
        Ok(if found.duration() < stopping.duration() { found } else { stopping })
    }

    /// Moves through poses, each within its own limits.
    fn with_limits(poses: &[Pose], limits: &[MotionLimits], form: CourseForm, blend: f64) -> Result<Self, PathError> {
        let mut moves: Vec<TimedMove> = Vec::new();
        for (k, (ends, limits)) in poses.windows(2).zip(limits).enumerate() {
            let straight = StraightMove::between(&ends[0], &ends[1]);
            let (way, turn) = (straight.translation_w.norm(), straight.turn_w.norm());
            if way == 0.0 && turn == 0.0 {
                return Err(PathError::NoMove { first: k + 1 });
            }
            let course = Course::within(limits, form, way, turn)?;

            // Two moves overlap while the one slows down and the other speeds up.
            let begins = moves.last().map_or(0.0, |last| {
                let both = last.course.slowing().min(course.slowing());
                last.ends() - blend * both
            });
            moves.push(TimedMove { begins, straight, course });
        }
        Ok(Self { start: poses[0], moves })
    }

    /// Used parts of the limits while each move overlaps with its neighbours.
    fn excess_of_moves(&self, limits: &MotionLimits) -> Vec<UsedParts> {
        let mut found = vec![UsedParts::default(); self.moves.len()];
        for (k, pair) in self.moves.windows(2).enumerate() {
            let (from, to) = (pair[1].begins, pair[0].ends());
            if to <= from {
                continue;
            }
            let inside = self.corners().into_iter().map(|corner| corner.time).filter(|time| *time > from && *time < to);
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
        let mut point = PathPoint::at_rest(&self.start);
        for of in &self.moves {
            let [done, rate, second, third] = of.course.at(time - of.begins, side);
            let (way, turn) = (of.straight.translation_w, of.straight.turn_w);
            let rotation = Rotation::from_scaled_axis(turn * done);

            point.pose.position_w += way * done;
            point.pose.rot_wp = rotation * point.pose.rot_wp;

            let turned = |of: &Vec6| rotation * parts(of)[1];
            let [w, a, j] = [turned(&point.velocity_w), turned(&point.acceleration_w), turned(&point.jerk_w)];
            let (own_w, own_a, own_j) = (turn * rate, turn * second, turn * third);
            let swept = own_w.cross(&w);
            add(&mut point.velocity_w, &(way * rate), &(own_w + w));
            add(&mut point.acceleration_w, &(way * second), &(own_a + a + swept));
            let jerk = own_j + j + own_a.cross(&w) + own_w.cross(&(2.0 * a + swept));
            add(&mut point.jerk_w, &(way * third), &jerk);
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
