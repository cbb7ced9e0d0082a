//! Modes above the limit: bounds of what they add, and the limit at which they do not count.

use super::LowestTension;
use super::command::Command;
use crate::at_rest::{self, AtRest, ModesBelow};
use crate::request::SettleRequest;
use crate::text::significant;
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Vec3, Vec6};
use funicular::modes::{LengthCommand, Modes, OmittedModes, OmittedMotion, Release};
use funicular::robot::{Damping, Robot, StretchLoss};

/// Ratio of the next limit that is tried.
pub(super) const NEXT_LIMIT: f64 = 1.4;

/// Maximum number of modes below a limit that the program chooses above the one of all modes of the platform: their
/// damped list takes a second.
pub(super) const MAX_CHOSEN_MODES: usize = 150;

/// Part of the tolerance from which on modes above the limit count.
const COUNTS: f64 = 0.1;

/// True if the modes above the limit of a list may move the point by a part of the tolerance.
pub(super) fn counts(
    at_rest: &AtRest,
    request: &SettleRequest,
    command: Option<&Command>,
    found: &ModesBelow,
    arm_w: &Vec3,
) -> bool {
    let most = COUNTS * request.tolerance_m;
    let Some(command) = command else {
        let wrench = wrench(at_rest, request);
        return Release::omitted_by(&found.dynamics, &found.modes, &wrench, arm_w) > most;
    };
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let bounds = bounds(at_rest, linearisation, &found.modes, arm_w, &command.lengths());
    bounds.is_some_and(|of| of.distance > most)
}

/// Released wrench about the platform origin.
pub(super) fn wrench(at_rest: &AtRest, request: &SettleRequest) -> Vec6 {
    let force = Vec3::from(request.release_n.unwrap_or_default());
    let point_p = Vec3::from(request.points.input_point_m.unwrap_or_default());
    let arm_w = at_rest.equilibrium.pose.rot_wp * point_p;
    let moment = arm_w.cross(&force) + Vec3::from(request.release_n_m.unwrap_or_default());
    Vec6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Bounds of what the modes above the limit of a list add to a command; `None` if none are known.
pub(super) fn bounds(
    at_rest: &AtRest,
    linearisation: Linearisation,
    found: &Modes,
    arm_w: &Vec3,
    command: &LengthCommand,
) -> Option<OmittedMotion> {
    let AtRest { robot, equilibrium, .. } = &*at_rest.vibrating();
    let lossless = Dynamics::about(&without_losses(robot), equilibrium, linearisation, found.below_hz).ok()?;
    let stretch = robot.cables.iter().zip(&equilibrium.cables);
    let stretch = stretch.map(|(cable, state)| cable.material.axial_stiffness / state.unstrained_length).collect();
    Some(OmittedModes::of(&lossless, found, arm_w, stretch)?.bounds(command))
}

fn without_losses(robot: &Robot) -> Robot {
    let mut robot = robot.clone();
    for cable in &mut robot.cables {
        cable.material.damping = Damping::Ratio(0.0);
        cable.material.stretch_loss = StretchLoss { factor: 0.0, time: 0.0 };
    }
    robot.platform.translational_damping_p = Vec3::zeros();
    robot.platform.rotational_damping_p = Vec3::zeros();
    robot
}

/// Caveat about the modes above the limit after a release.
pub(super) fn caveat_of_release(omitted: f64, tolerance: f64, limit: f64) -> Option<String> {
    (omitted > tolerance).then(|| {
        format!(
            "the modes above {limit} Hz may move the point by up to {} mm, more than the tolerance: raise ⟪below_hz⟫, \
             or leave it out",
            significant(1e3 * omitted, 3)
        )
    })
}

/// Caveat about the modes above the limit after a command.
pub(super) fn caveat(
    omitted: Option<&OmittedMotion>,
    tolerance: f64,
    limit: f64,
    lowest: &LowestTension,
) -> Option<String> {
    let Some(OmittedMotion { distance, mean_tensions }) = omitted else {
        return Some(format!(
            "no bound is known for the modes above {limit} Hz, because motors turn, supports are flexible, or a cable \
             has no length that is commanded: raise ⟪below_hz⟫ until the numbers stay"
        ));
    };
    let most = mean_tensions.iter().copied().fold(0.0, f64::max);
    if *distance > tolerance {
        return Some(format!(
            "the modes above {limit} Hz may move the point by up to {} mm, more than the tolerance: raise ⟪below_hz⟫, \
             or give the command longer times, a stop and a move in ⟪profile_s⟫",
            significant(1e3 * distance, 3)
        ));
    }
    (most >= lowest.tension_n).then(|| {
        format!(
            "the modes above {limit} Hz may change the mean tension of a cable by up to {} N, and the lowest tension \
             is {} N: a cable may become slack; raise ⟪below_hz⟫, or give the command longer times, a stop and a move \
             in ⟪profile_s⟫",
            significant(most, 3),
            significant(lowest.tension_n, 3)
        )
    })
}
