//! Rates and accelerations of the lengths in a control loop: exact derivatives of the centre along the motion.

use super::input::LoopInput;
use super::model::{LoopModel, MAX_CABLES};
use super::state::LoopState;
use crate::math::Vec6;
use crate::statics::{CentreSearch, PlatformAlong, RatesRow};

/// Adds rates and accelerations to a state with the tensions of a search; false if they are not determined there, and
/// they stay zero.
pub(super) fn add(model: &LoopModel, input: &LoopInput, search: &CentreSearch<'_, '_>, state: &mut LoopState) -> bool {
    let (robot, motion) = (model.robot(), &input.motion);
    let is_at_rest = [&motion.velocity_w, &motion.acceleration_w, &motion.jerk_w].iter().all(|of| of.norm() == 0.0);
    if is_at_rest {
        return true;
    }
    let platform = PlatformAlong::new(&motion.pose, &motion.velocity_w, &motion.acceleration_w);
    let (dead, inertia) = (platform.dead_load(robot), motion.inertia_along(robot));
    let load: [Vec6; 2] = std::array::from_fn(|k| model.coordinates().reduce(&(dead[k] + inertia[k])));
    let mut rows = [RatesRow::default(); MAX_CABLES];
    let rows = &mut rows[..model.cables()];
    if !search.rates(&platform, &load, rows) {
        return false;
    }
    for (cable, row) in state.cables.iter_mut().zip(rows) {
        [cable.length_rate, cable.length_acceleration] = row.rates.length;
    }
    true
}
