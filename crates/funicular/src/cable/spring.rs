//! Massless straight spring: k_a = EA/L₀, all other entries zero (the paper's reference [27]).

use super::LocalStiffness;
use crate::robot::Robot;
use crate::statics::CableState;

/// Local stiffness [N/m] of cable `i` as a straight massless spring along its chord. Its tension EA (l/L₀ − 1) grows by
/// EA/L₀ per length; a rigid cable has the unstrained length of its chord.
pub(super) fn stiffness(robot: &Robot, i: usize, state: &CableState) -> LocalStiffness<f64> {
    let length = match &state.hanging {
        Some(hanging) => hanging.catenary.rope().unstrained_length,
        None => state.chord(),
    };
    LocalStiffness { axial: robot.cables[i].material.axial_stiffness / length, ..LocalStiffness::default() }
}
