//! Straight moves one after the other, which may overlap in time.

use super::course::{Course, CourseForm, MotionLimits};
use super::{PathError, PathPoint, StraightMove, parts};
use crate::math::{Rotation, Vec3, Vec6};
use crate::robot::Pose;

/// Number of times at which the distance to a pose is looked at while two moves overlap.
const LOOKS: usize = 200;

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
    pub(super) fn through(
        poses: &[Pose],
        limits: &MotionLimits,
        form: CourseForm,
        blend: f64,
    ) -> Result<Self, PathError> {
        let mut moves: Vec<TimedMove> = Vec::new();
        for (k, ends) in poses.windows(2).enumerate() {
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

    pub(super) fn duration(&self) -> f64 {
        self.moves.iter().map(TimedMove::ends).fold(0.0, f64::max)
    }

    /// Times at which the jerk jumps [s].
    pub(super) fn corner_times(&self) -> Vec<f64> {
        self.moves.iter().flat_map(|of| of.course.corner_times().into_iter().map(|time| of.begins + time)).collect()
    }

    /// Sum of the translations, and the turns one after the other: a later turn acts on what the earlier ones have
    /// done.
    pub(super) fn at(&self, time: f64) -> PathPoint {
        let mut point = PathPoint::at_rest(&self.start);
        for of in self.moves.iter().filter(|of| time > of.begins) {
            let [done, rate, second, third] = of.course.at(time - of.begins);
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
                let distance = |k: usize| (self.at(at(k)).pose.position_w - corner_w).norm();
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
