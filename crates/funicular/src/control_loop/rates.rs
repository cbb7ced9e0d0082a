//! Rates and accelerations of the lengths in a control loop.
//!
//! The lengths of the centre are a smooth function of time. Differences of the fourth order between times nearby, each
//! solved from the state between them, give both derivatives. The platform moves by a small part of its distance to the
//! anchors between the times, so that the differences leave 1e-8 of a rate, and rounding 1e-5 of an acceleration.

use super::input::{LoopInput, check_pose};
use super::model::{LoopModel, MAX_CABLES};
use super::solved::{SearchStart, SolvedState, solve};
use crate::path::PathPoint;

/// Motion between two times, over the distance to the anchors and in radians. The error of the differences grows with
/// its fourth power, and the rounding of accelerations falls with its square.
const PART: f64 = 2e-4;

/// Factor of the time after a difference that left the limits, and maximum number of such attempts: the last is 1 µm in
/// 10 m.
const SHORTER: f64 = 0.05;
const MAX_ATTEMPTS: usize = 3;

/// Derivatives of a length.
#[derive(Debug, Clone, Copy, Default)]
struct LengthMotion {
    /// First [m/s].
    rate: f64,
    /// Second [m/s²].
    acceleration: f64,
}

/// Adds rates and accelerations to a state; false if neighbouring times have no tensions, and they stay zero.
pub(super) fn add(model: &LoopModel, input: &LoopInput, solved: &mut SolvedState) -> bool {
    let Some(mut time) = time_between(model, &input.motion) else { return true };
    for _ in 0..MAX_ATTEMPTS {
        if let Some(motion) = differences(model, input, solved, time) {
            for (cable, of) in solved.state.cables.iter_mut().zip(&motion) {
                (cable.length_rate, cable.length_acceleration) = (of.rate, of.acceleration);
            }
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
fn differences(
    model: &LoopModel,
    input: &LoopInput,
    solved: &SolvedState,
    time: f64,
) -> Option<[LengthMotion; MAX_CABLES]> {
    let count = model.cables();
    let beside = |time: f64| {
        let at = input.motion.shifted(time);
        check_pose(model.robot(), &at.pose).ok()?;
        solve(model, &at, &input.wrench(), SearchStart::Near(&solved.near)).ok()
    };
    let near = [beside(-time)?, beside(time)?];
    let far = [beside(-2.0 * time)?, beside(2.0 * time)?];

    let mut motion = [LengthMotion::default(); MAX_CABLES];
    for (i, of) in motion.iter_mut().enumerate().take(count) {
        let here = solved.state.cables[i].length;
        let changes = |there: &[SolvedState; 2]| [0, 1].map(|k| there[k].state.cables[i].length - here);
        let ([before, after], [far_before, far_after]) = (changes(&near), changes(&far));
        *of = LengthMotion {
            rate: (8.0 * (after - before) - (far_after - far_before)) / (12.0 * time),
            acceleration: (16.0 * (after + before) - (far_after + far_before)) / (12.0 * time * time),
        };
    }
    Some(motion)
}
