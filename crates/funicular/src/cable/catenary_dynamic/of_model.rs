//! End stiffness of a cable of a robot in the catenary-dynamic model.

use super::{CatenaryDynamicEnd, MovingEnd};
use crate::cable::situation::CableSituation;
use crate::cable::{DynamicCable, EndStiffness, LocalAxes, NoStiffness, catenary_static};

/// End stiffness of a cable in this model. Without any mass the cable and its drive are springs.
pub(in crate::cable) fn end(of: &CableSituation<'_>) -> Result<EndStiffness, NoStiffness> {
    let (hanging, material) = (of.hanging()?, of.material());
    let end = of.moving_end(&LocalAxes::of_hanging(hanging));
    if material.mass_per_length == 0.0 && !end.as_ref().is_some_and(MovingEnd::has_dynamics) {
        return catenary_static::end(of);
    }
    let of_rope = (material.mass_per_length, material.damping, material.stretch_loss);
    let cable = CatenaryDynamicEnd::new(hanging, end, of_rope, of.in_plane_only, of.limit, of.shapes)?;
    Ok(EndStiffness::Dynamic(DynamicCable::CatenaryDynamic(Box::new(cable))))
}
