//! End stiffness of a cable about its elastic catenary, without vibration and with it.

use super::catenary_dynamic::{CatenaryDynamicEnd, MovingEnd, SpanAtRest, has_tension};
use super::situation::CableSituation;
use super::{EndStiffness, LocalAxes, NoStiffness};
use crate::catenary::space::HangingCable;
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::CableState;

/// Exact tangent, with a pulley or a winch in series.
pub(super) fn at_rest(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let hanging = of.hanging()?;
    if of.has_strains() && has_tension(&hanging.catenary) {
        return of.at_rest(SpanAtRest::hanging(LocalAxes::of_hanging(hanging), &hanging.catenary));
    }
    Ok(of.in_plane(of.in_series(hanging.tangent_w())))
}

/// Linear vibration by poles and residues. Without any mass the cable and its drive are springs.
pub(super) fn vibrating(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let (hanging, material) = (of.hanging()?, of.material());
    let end = of.moving_end(&LocalAxes::of_hanging(hanging));
    if material.mass_per_length == 0.0 && !end.as_ref().is_some_and(MovingEnd::has_dynamics) {
        return at_rest(of);
    }
    let of_rope = (material.mass_per_length, material.damping, material.stretch_loss);
    let cable = CatenaryDynamicEnd::new(hanging, end, of_rope, of.in_plane_only, of.limit, of.shapes)?;
    Ok(EndStiffness::by_poles(cable))
}

/// Static stiffness of the free span of cable `i` [N/m]; `None` for a rigid cable.
pub(super) fn span(_: &Robot, _: usize, state: &CableState) -> Option<Mat3> {
    state.hanging.as_ref().map(HangingCable::tangent_w)
}
