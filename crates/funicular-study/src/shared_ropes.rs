//! Ropes over sheaves, which only some commands know.

use crate::request::Request;
use anyhow::{Result, bail};
use funicular::robot::Robot;

/// Commands that know ropes over sheaves.
const WITH_ROPES_OVER_SHEAVES: [&str; 6] = ["check", "parameters", "statics", "stiffness", "modes", "live"];

/// Refuses a robot with ropes over sheaves in a command that does not know them.
///
/// # Errors
/// Such a robot.
pub fn refuse_ropes_over_sheaves(command: &str, robot: &Robot) -> Result<()> {
    if WITH_ROPES_OVER_SHEAVES.contains(&command) { Ok(()) } else { refuse_ropes_in(&format!("`{command}`"), robot) }
}

/// Refuses a robot with ropes over sheaves in a part of a command that does not know them; `what` is its name in
/// messages.
///
/// # Errors
/// Such a robot.
pub(crate) fn refuse_ropes_in(what: &str, robot: &Robot) -> Result<()> {
    let Some(rope) = robot.ropes.first() else { return Ok(()) };
    bail!(
        "{what} does not know ropes over sheaves, and the rope of cable \"{}\" is one: `statics`, `stiffness` and \
         `modes` know them; leave out `shares_rope_with` for cables of their own",
        robot.cables[rope.cables[0]].name
    )
}

/// Refuses a request whose robot has ropes over sheaves, if its command does not know them.
///
/// # Errors
/// Such a robot.
pub fn refuse_ropes_of_request(request: &Request) -> Result<()> {
    let Some(robot) = request.robot() else { return Ok(()) };
    let names_key = |text: &str| text.contains("shares_rope_with");
    if !names_key(&robot.text) && !robot.set.iter().any(|change| names_key(&change.path)) {
        return Ok(());
    }
    // The command itself reports a file that cannot be read.
    robot.read().map_or(Ok(()), |file| refuse_ropes_over_sheaves(request.command(), &file.robot))
}
