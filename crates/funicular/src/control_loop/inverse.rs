//! Pose to lengths in a control loop.

use super::input::LoopInput;
use super::model::LoopModel;
use super::solved::{SearchStart, solve};
use super::state::{LoopFault, LoopState, LoopStatus};
use super::{ControlLoop, rates};

impl ControlLoop {
    /// Unstrained lengths and tensions that hold the platform in its motion. `with_rates` adds rates and accelerations
    /// of the lengths, which takes twice as long again.
    ///
    /// The external load stays while lengths change with the motion, and so does its jerk.
    ///
    /// # Errors
    /// [`LoopFault`]: nothing is changed.
    pub fn inverse(&mut self, model: &LoopModel, input: &LoopInput, with_rates: bool) -> Result<LoopState, LoopFault> {
        input.check(model.robot())?;
        let near = self.near_inverse.as_ref();
        let mut solved = match solve(model, &input.motion, &input.wrench(), SearchStart::Best(near)) {
            Ok(solved) => solved,
            Err(fault @ (LoopFault::Singular | LoopFault::NotFound)) => {
                return Self::held(&mut self.last_inverse, fault);
            }
            Err(fault) => return Err(fault),
        };
        if with_rates && !rates::add(model, input, &mut solved) {
            solved.state.status = solved.state.status.max(LoopStatus::Accepted);
        }

        self.near_inverse = Some(solved.near);
        self.last_pose = Some(input.motion.pose);
        if solved.state.status == LoopStatus::Certified {
            self.last_inverse = Some(solved.state);
        }
        Ok(solved.state)
    }
}
