//! State of the robot: pose or unstrained lengths, and the mass of the platform.

use super::check_pose;
use super::loads::with_load;
use crate::request;
use anyhow::{Result, anyhow, bail};
use funicular::robot::{Robot, State};
use funicular::statics::StaticsError;

/// Robot with the state, the mass and the loads of a request.
///
/// # Errors
/// A number out of its range, or a pose or load that the platform cannot have.
pub fn with_state(mut robot: Robot, state: &request::State) -> Result<Robot> {
    state.check()?;
    if state.lengths_m.is_some() && state.pose.is_some() {
        bail!("give ⟪pose⟫ or ⟪lengths_m⟫, not both: each follows from the other");
    }
    if state.lengths_m.is_some() && state.hold_lengths_of_pose {
        bail!("give ⟪lengths_m⟫ or ⟪hold_lengths_of_pose⟫, not both: both give the lengths");
    }

    if let Some(lengths) = &state.lengths_m {
        robot.state = State::Lengths(lengths.clone());
    }
    if let Some(requested) = state.pose {
        let pose = requested.to_robot()?;
        check_pose(&robot, &pose).map_err(|error| anyhow!("⟪pose⟫: {error}"))?;
        robot.state = State::Pose(pose);
        robot.written_angles_deg = requested.written_angles_deg();
    }
    if let Some(mass) = state.mass_kg {
        robot.platform.mass = mass;
    }

    with_load(robot, &state.load)
}

/// Refuses to hold the lengths of a pose if the robot has none.
///
/// # Errors
/// A message that says which value to give.
pub(crate) fn refuse_no_pose(robot: &Robot) -> Result<()> {
    match robot.state {
        State::Pose(_) => Ok(()),
        State::Lengths(_) | State::Unknown => {
            bail!("⟪hold_lengths_of_pose⟫ needs a pose: give ⟪pose⟫, or the robot file a [state] with `position_m`")
        }
    }
}

/// Refuses a robot with neither known lengths nor a known pose.
///
/// # Errors
/// [`StaticsError::NoState`].
pub(crate) fn refuse_no_state(robot: &Robot) -> Result<(), StaticsError> {
    if robot.state == State::Unknown { Err(StaticsError::NoState) } else { Ok(()) }
}
