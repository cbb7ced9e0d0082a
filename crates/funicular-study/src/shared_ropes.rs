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

#[cfg(test)]
mod tests {
    use crate::request::{Request, commands};
    use crate::sweep::PreparedSweep;
    use crate::{Silent, run};
    use serde_json::json;

    const FALLS: &str = r#"
        name = "falls"
        [platform]
        mass_kg = 100.0
        motion = "point-mass"
        [materials.rope]
        axial_stiffness_n = 2e5
        mass_kg_per_m = 0.3
        [[cables]]
        name = "1"
        material = "rope"
        anchor_m = [-3.0, 0.0, 6.0]
        unstrained_length_m = 4.0
        [[cables]]
        name = "2"
        material = "rope"
        anchor_m = [3.0, 0.5, 6.0]
        unstrained_length_m = 4.5
        shares_rope_with = "1"
    "#;

    #[test]
    fn a_command_knows_ropes_over_sheaves_or_says_that_it_does_not() {
        let (mut known, mut refused) = (Vec::new(), 0);
        for command in commands() {
            let request = json!({ "command": command.name, "robot": { "name": "falls.toml", "text": FALLS } });
            // Commands without a robot, and those that need more keys.
            let Ok(request) = Request::from_value(request) else { continue };
            match run(&request, &mut Silent) {
                Ok(_) => known.push(command.name),
                Err(error) if command.name == "live" => assert!(error.to_string().contains("writes a file"), "{error}"),
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.contains("does not know ropes over sheaves"), "{}: {message}", command.name);
                    refused += 1;
                }
            }
        }
        assert_eq!(known, ["check", "parameters", "statics", "stiffness", "modes"]);
        assert!(refused >= 8, "{refused}");

        let of_map = json!({ "command": "map", "robot": { "text": FALLS } });
        let request = Request::from_value(of_map).unwrap();
        let error = PreparedSweep::new(&request).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("`map` does not know ropes over sheaves"), "{error}");
    }
}
