//! End stiffness of a shallow sagging cable, without vibration and with it.

use super::catenary_dynamic::{CatenaryDynamicEnd, EndDirections, MovingEnd};
use super::shallow_dynamic::ShallowDynamic;
use super::situation::CableSituation;
use super::{EndStiffness, LocalAxes, NoStiffness, Sag, shallow_static, stretch_of};
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::CableState;

/// Static stiffness, with a pulley or a winch in series.
pub(super) fn at_rest(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let sag = of.sag();
    let held = shallow_static::stiffness(&sag);
    Ok(of.in_plane(of.along_chord(held, sag.axial_stiffness / sag.effective_length)?))
}

/// Vibration in closed form; by poles and residues if any cable of the robot needs them.
pub(super) fn vibrating(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let CableSituation { robot, i, state, axes, in_plane_only, limit, .. } = *of;
    let sag = of.sag();
    let damping = of.material().damping.per_length_over(stretch_of(robot, i, state));
    if !(robot.has_moving_ends() || robot.has_stretch_loss() || robot.has_running_ropes()) {
        return Ok(EndStiffness::in_closed_form(ShallowDynamic::new(sag, axes, damping, in_plane_only)));
    }

    // Without any mass the cable and its drive are springs.
    let end = of.moving_end(&axes);
    let hanging = of.hanging()?;
    if sag.mass_per_length == 0.0 && !end.as_ref().is_some_and(MovingEnd::has_dynamics) {
        return at_rest(of);
    }
    let of_axes = (axes, EndDirections::in_axes(hanging, &axes));
    let of_rope = (damping, of.material().stretch_loss, of.has_strains());
    let cable = CatenaryDynamicEnd::of_shallow_span(&sag, of_axes, end, of_rope, in_plane_only, limit)?;
    Ok(EndStiffness::by_poles(cable))
}

/// Static stiffness of the free span of cable `i` [N/m].
#[expect(clippy::unnecessary_wraps, reason = "other models have none of some cables")]
pub(super) fn span(robot: &Robot, i: usize, state: &CableState) -> Option<Mat3> {
    let held = shallow_static::stiffness(&Sag::of(robot, i, state));
    Some(held.in_world(&LocalAxes::of_cable(robot, i, state)))
}
