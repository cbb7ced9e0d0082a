//! Rates and accelerations of the lengths in a control loop.
//!
//! The lengths of the centre are a smooth function of time. Differences of the fourth order between four times nearby,
//! each solved from the last, give both derivatives. The platform moves by a small part of its distance to the anchors
//! between the times, so that the differences leave 1e-13 of a rate, and rounding 1e-12 of it and 1e-9 of an
//! acceleration.

use super::input::{LoopInput, check_pose};
use super::inverse::{NearInverse, Search, Solved, solve};
use super::model::{LoopModel, MAX_CABLES};
use crate::path::PathPoint;

/// Motion between two times, over the distance to the anchors and in radians.
const PART: f64 = 3e-4;

/// Factor of the time after a difference that left the limits, and maximum number of such attempts: the last is 1 µm in
/// 10 m.
const SHORTER: f64 = 0.05;
const MAX_ATTEMPTS: usize = 3;

/// Derivatives of a length.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LengthMotion {
    /// First [m/s].
    pub(super) rate: f64,
    /// Second [m/s²].
    pub(super) acceleration: f64,
}

/// Adds rates and accelerations to a state; false if neighbouring times have no tensions, and they stay zero.
pub(super) fn add(model: &LoopModel, input: &LoopInput, solved: &mut Solved) -> bool {
    let Some(mut time) = time_between(model, &input.motion) else { return true };
    for _ in 0..MAX_ATTEMPTS {
        if let Some(motion) = differences(model, input, solved, time) {
            solved.set_motion(&motion);
            return true;
        }
        time *= SHORTER;
    }
    false
}

/// Time between the differences [s]; `None` at rest.
fn time_between(model: &LoopModel, motion: &PathPoint) -> Option<f64> {
    let robot = model.robot();
    let nearest = robot.cables.iter().map(|cable| cable.chord_w(&motion.pose).norm()).fold(f64::INFINITY, f64::min);
    let radius = model.coordinates().ell();
    let size = |of: &crate::math::Vec6| {
        let (linear, angular) = (of.fixed_rows::<3>(0).norm(), of.fixed_rows::<3>(3).norm());
        (linear + angular * radius) / nearest + angular
    };
    let (speed, acceleration, jerk) = (size(&motion.velocity_w), size(&motion.acceleration_w), size(&motion.jerk_w));
    let fastest = speed.max(acceleration.sqrt()).max(jerk.cbrt());
    (fastest > 0.0).then(|| PART / fastest)
}

/// Derivatives by differences over a time [s]; `None` if a neighbouring time has no tensions of the same kind.
fn differences(model: &LoopModel, input: &LoopInput, solved: &Solved, time: f64) -> Option<[LengthMotion; MAX_CABLES]> {
    let count = model.cables();
    let mut lengths = [[0.0; MAX_CABLES]; 5];
    let put = |row: &mut [f64; MAX_CABLES], of: &Solved| {
        row.iter_mut().zip(&of.state.cables).for_each(|(length, cable)| *length = cable.length);
    };
    put(&mut lengths[2], solved);
    for side in [[1, 0], [3, 4]] {
        let mut near: NearInverse = solved.near;
        for place in side {
            let at = input.motion.shifted((place as f64 - 2.0) * time);
            check_pose(model.robot(), &at.pose).ok()?;
            let there = solve(model, &at, &input.wrench(), Search::Near(&near)).ok()?;
            put(&mut lengths[place], &there);
            near = there.near;
        }
    }

    let mut motion = [LengthMotion::default(); MAX_CABLES];
    for (i, of) in motion.iter_mut().enumerate().take(count) {
        let here = lengths[2][i];
        let [before2, before, after, after2] = [0, 1, 3, 4].map(|place: usize| lengths[place][i] - here);
        *of = LengthMotion {
            rate: (8.0 * (after - before) - (after2 - before2)) / (12.0 * time),
            acceleration: (16.0 * (after + before) - (after2 + before2)) / (12.0 * time * time),
        };
    }
    Some(motion)
}
