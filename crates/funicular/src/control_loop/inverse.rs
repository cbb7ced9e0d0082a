//! Pose to lengths in a control loop.

use super::ControlLoop;
use super::input::LoopInput;
use super::model::LoopModel;
use super::solved::solve;
use super::state::{LoopFault, LoopState, LoopStatus};

impl ControlLoop {
    /// Unstrained lengths and tensions that hold the platform in its motion. `with_rates` adds rates and accelerations
    /// of the lengths, exact derivatives along the motion.
    ///
    /// The external load stays while lengths change with the motion, and so does its jerk.
    ///
    /// # Errors
    /// [`LoopFault`]: nothing is changed.
    pub fn inverse(&mut self, model: &LoopModel, input: &LoopInput, with_rates: bool) -> Result<LoopState, LoopFault> {
        input.check(model.robot())?;
        let near = self.near_inverse.as_ref();
        let solved = match solve(model, input, near, with_rates) {
            Ok(solved) => solved,
            Err(fault @ (LoopFault::Singular | LoopFault::NotFound)) => {
                return Self::held(&mut self.last_inverse, fault);
            }
            Err(fault) => return Err(fault),
        };

        self.near_inverse = Some(solved.near);
        self.last_pose = Some(input.motion.pose);
        if solved.state.status == LoopStatus::Certified {
            self.last_inverse = Some(solved.state);
        }
        Ok(solved.state)
    }
}
