//! Massless straight spring: k_a = EA/L₀, all other entries zero (the paper's reference [27]).

use super::situation::CableSituation;
use super::{EndStiffness, LocalAxes, LocalStiffness, NoStiffness};
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::CableState;

/// End stiffness of a cable in this model. A slack cable has none.
pub(super) fn end(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    if of.state.is_slack() {
        return Ok(EndStiffness::Constant(Mat3::zeros()));
    }
    let held = stiffness(of.robot, of.i, of.state);
    of.along_chord(held, held.axial)
}

/// Static stiffness of the free span of cable `i` [N/m].
#[expect(clippy::unnecessary_wraps, reason = "other models have none of some cables")]
pub(super) fn span(robot: &Robot, i: usize, state: &CableState) -> Option<Mat3> {
    let held = if state.is_slack() { LocalStiffness::default() } else { stiffness(robot, i, state) };
    Some(held.in_world(&LocalAxes::of_cable(robot, i, state)))
}

/// Local stiffness [N/m] of cable `i` as a straight massless spring along its chord. Its tension EA (l/L₀ − 1) grows by
/// EA/L₀ per length; a rigid cable has the unstrained length of its chord.
pub(super) fn stiffness(robot: &Robot, i: usize, state: &CableState) -> LocalStiffness<f64> {
    let length = match &state.hanging {
        Some(hanging) => hanging.catenary.rope().unstrained_length,
        None => state.chord(),
    };
    LocalStiffness { axial: robot.cables[i].material.axial_stiffness / length, ..LocalStiffness::default() }
}
