//! Residual of the balance: the remaining wrench at a pose, and the share of rounding in it.

use super::equilibrium::{CableState, Equilibrium};
use super::error::StaticsError;
use super::loaded_cable::LoadedCable;
use super::model::StaticModel;
use super::ropes;
use super::supports::CablesOnSupports;
use crate::math::Vec6;
use crate::platform::{Coordinates, balance, load_size};
use crate::robot::{Pose, Robot};

/// Total wrench on the platform at any pose from cables, weight and load, about the platform origin [N, N·m]; the
/// residual of equilibrium.
///
/// # Errors
/// [`StaticsError`]: the number of lengths differs from the number of cables, or a length is not positive.
pub fn wrench(robot: &Robot, pose: &Pose, lengths: &[f64], model: StaticModel) -> Result<Vec6, StaticsError> {
    check_lengths(robot, lengths)?;
    if robot.has_supports() {
        let loaded = LoadedCable::all(robot, pose, model);
        let settled = CablesOnSupports::at(robot, &loaded, lengths, pose);
        let forces = settled.cables.iter().map(|cable| (cable.force_w(), cable.span.start_w - pose.position_w));
        return Ok(balance(robot, pose, forces).0);
    }
    let loaded = LoadedCable::all(robot, pose, model);
    let lengths = ropes::divided(robot, &loaded, lengths, pose);
    let forces = lengths.iter().enumerate().map(|(i, &length)| {
        let cable = loaded[i].hang(pose, length);
        (cable.force_w(), cable.span.start_w - pose.position_w)
    });
    Ok(balance(robot, pose, forces).0)
}

pub(super) fn check_lengths(robot: &Robot, lengths: &[f64]) -> Result<(), StaticsError> {
    if lengths.len() != robot.cables.len() {
        return Err(StaticsError::LengthCount { given: lengths.len(), cables: robot.cables.len() });
    }
    match lengths.iter().position(|length| !(*length > 0.0 && length.is_finite())) {
        Some(i) => Err(StaticsError::Length { cable: robot.cables[i].name.clone(), value: lengths[i] }),
        None => Ok(()),
    }
}

/// Larger of force and moment/ℓ, over the sum of all tensions and the weight; components that the platform cannot
/// follow do not count.
pub(super) fn scaled_residual(coordinates: &Coordinates, wrench: &Vec6, force_scale: f64) -> f64 {
    let size = coordinates.wrench_size(wrench);
    if force_scale > 0.0 { size / force_scale } else { size }
}

/// Scaled residual of a set of cable states at a pose.
pub(super) fn residual_of(robot: &Robot, pose: &Pose, cables: &[CableState]) -> f64 {
    let (wrench, scale) = balance(robot, pose, cables.iter().map(|c| (c.force_on_platform_w, c.lever_w)));
    scaled_residual(&Coordinates::of(robot), &wrench, scale)
}

/// Relative rounding of a chord, in units of [`f64::EPSILON`]: coordinates of a few chord lengths, a few operations.
const CHORD_ROUNDING: f64 = 8.0;

/// Force that rounding of all chords leaves in the balance [N]: strains of [`CHORD_ROUNDING`] in all cables.
pub(super) fn elastic_rounding(robot: &Robot) -> f64 {
    let stiffness: f64 = robot.cables.iter().map(|cable| cable.material.axial_stiffness).sum();
    CHORD_ROUNDING * f64::EPSILON * stiffness
}

/// True if there is nothing to balance: no load acts on the platform or its cables, and all tensions together are no
/// more than rounding of the cables' elastic forces. A residual relative to them would be zero over zero.
///
/// # Example
/// ```
/// # use funicular::{math::Vec3, robot::Robot, statics::{self, StaticModel}};
/// # let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM)?;
/// let lengths = [6.863, 6.565, 6.756, 6.663, 6.801, 6.604];
/// robot.gravity_w = Vec3::zeros();
/// let afloat = statics::forward(&robot, &lengths, StaticModel::Catenary, None)?;
/// assert!(statics::is_unloaded(&robot, &afloat) && afloat.residual == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_unloaded(robot: &Robot, equilibrium: &Equilibrium) -> bool {
    let tensions: f64 = equilibrium.cables.iter().map(|cable| cable.force_on_platform_w.norm()).sum();
    let loads = LoadedCable::all(robot, &equilibrium.pose, equilibrium.model);
    load_size(robot) == 0.0 && loads.iter().all(|cable| cable.load.size == 0.0) && tensions <= elastic_rounding(robot)
}
