//! Static stiffness of the elastic catenary: the exact tangent, and with a pulley or a winch in series.

use super::catenary_dynamic::{SpanAtRest, has_tension};
use super::situation::CableSituation;
use super::{EndStiffness, LocalAxes, NoStiffness};
use crate::catenary::space::HangingCable;
use crate::math::Mat3;
use crate::robot::Robot;
use crate::statics::CableState;

/// End stiffness of a cable in this model.
pub(super) fn end(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let hanging = of.hanging()?;
    if of.has_strains() && has_tension(&hanging.catenary) {
        return of.at_rest(SpanAtRest::hanging(LocalAxes::of_hanging(hanging), &hanging.catenary));
    }
    Ok(of.in_plane(of.in_series(hanging.tangent_w())))
}

/// Static stiffness of the free span of cable `i` [N/m]; `None` for a rigid cable.
pub(super) fn span(_: &Robot, _: usize, state: &CableState) -> Option<Mat3> {
    state.hanging.as_ref().map(HangingCable::tangent_w)
}
