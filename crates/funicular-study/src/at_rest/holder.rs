//! Robot whose unstrained lengths are held while the changes of a request act.

use super::{with_limits, with_state};
use crate::request::{self, RobotText, Tensions};
use anyhow::Result;
use funicular::robot::Robot;

/// Robot whose unstrained lengths at a pose are held: the robot of the file without any change of the request, except
/// for its state and its tension limits.
///
/// # Errors
/// A file that is no robot without its changes, or a request that contradicts itself or the robot.
pub fn holder(source: &RobotText, state: &request::State, tensions: &Tensions) -> Result<Robot> {
    holder_of(source.of_holder().read()?.robot, state, tensions)
}

/// Holder from the robot of its text, with the pose and the tension limits of a request.
///
/// # Errors
/// A pose that the platform cannot have, or limits that exclude each other.
pub(crate) fn holder_of(robot: Robot, state: &request::State, tensions: &Tensions) -> Result<Robot> {
    let pose_alone = request::State { pose: state.pose, ..request::State::default() };
    with_limits(&with_state(robot, &pose_alone)?, tensions)
}
