//! Equilibrium made of cables that hang at a pose.

use super::drag::tangent_with_drag;
use super::equilibrium::{CableState, Equilibrium, Stability};
use super::model::StaticModel;
use super::residual::residual_of;
use super::stiffness::stability;
use crate::catenary::space::HangingCable;
use crate::robot::{Pose, Robot};

/// Collects an equilibrium from cables that hang at a pose.
pub(super) fn collect(
    robot: &Robot,
    pose: Pose,
    model: StaticModel,
    hanging: Vec<HangingCable>,
    unstrained_lengths: &[f64],
    iterations: usize,
) -> Equilibrium {
    let cables: Vec<CableState> = hanging
        .into_iter()
        .zip(unstrained_lengths)
        .map(|(cable, &unstrained_length)| CableState {
            attachment_w: cable.start_w,
            lever_w: cable.start_w - pose.position_w,
            anchor_w: cable.end_w,
            unstrained_length,
            force_on_platform_w: cable.force_on_start_w(),
            tension_platform: cable.catenary.tension_at_start(),
            tension_anchor: cable.catenary.tension_at_end(),
            hanging: Some(cable),
        })
        .collect();

    let residual = residual_of(robot, &pose, &cables);
    let mut equilibrium = Equilibrium { pose, model, cables, residual, iterations, stability: Stability::Rigid };
    if let Some(stiffness) = tangent_with_drag(robot, &equilibrium) {
        equilibrium.stability = stability(robot, &stiffness);
    }
    equilibrium
}
