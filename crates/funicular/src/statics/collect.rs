//! Equilibrium made of cables that hang at a pose.

use super::drag::tangent_with_drag;
use super::equilibrium::{CableState, Equilibrium, Stability};
use super::model::StaticModel;
use super::residual::residual_of;
use super::stiffness::stability;
use crate::drive::CableAtRest;
use crate::math::Vec3;
use crate::robot::{Pose, Robot};

/// Collects an equilibrium from cables that hang at a pose.
pub(super) fn collect(
    robot: &Robot,
    pose: Pose,
    model: StaticModel,
    cables: Vec<CableAtRest>,
    unstrained_lengths: &[f64],
    iterations: usize,
) -> Equilibrium {
    with_stability(robot, without_stability(robot, pose, model, cables, unstrained_lengths, iterations))
}

/// Collects an equilibrium like [`collect`], but leaves its stability open, as that of rigid cables.
pub(super) fn without_stability(
    robot: &Robot,
    pose: Pose,
    model: StaticModel,
    cables: Vec<CableAtRest>,
    unstrained_lengths: &[f64],
    iterations: usize,
) -> Equilibrium {
    let cables: Vec<CableState> = cables
        .into_iter()
        .zip(unstrained_lengths)
        .map(|(cable, &unstrained_length)| CableState {
            attachment_w: cable.span.start_w,
            lever_w: cable.span.start_w - pose.position_w,
            anchor_w: cable.span.end_w,
            unstrained_length,
            force_on_platform_w: cable.force_w(),
            tension_platform: cable.span.catenary.tension_at_start(),
            tension_anchor: cable.span.catenary.tension_at_end(),
            hanging: Some(cable.span),
            drive: cable.drive,
            displacement_w: Vec3::zeros(),
        })
        .collect();

    let residual = residual_of(robot, &pose, &cables);
    Equilibrium { pose, model, cables, residual, iterations, stability: Stability::Rigid }
}

/// Equilibrium with the stability of its cables.
pub(super) fn with_stability(robot: &Robot, mut equilibrium: Equilibrium) -> Equilibrium {
    if let Some(stiffness) = tangent_with_drag(robot, &equilibrium) {
        equilibrium.stability = stability(robot, &stiffness);
    }
    equilibrium
}
