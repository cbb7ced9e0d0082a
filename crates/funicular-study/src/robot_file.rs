//! Robot file of a request: its text is changed, read and checked.

pub mod page;
pub mod schema;

pub use crate::refused::Refused;

use crate::request::{Change, RobotText};
use crate::set_values::{self, Assignment};
use anyhow::{Result, anyhow, bail};
use funicular::robot::Robot;

/// Name and text of the robot that is built into every front end.
pub const EMBEDDED: (&str, &str) = ("robots/yuan2014-4mm.toml", funicular_robots::YUAN2014_4MM);

/// Maximum size of a robot file [bytes]. A cable takes some 200, so a larger file is another one given by mistake.
pub const MAX_BYTES: usize = 16 << 20;

/// Robot with the text that describes it.
#[derive(Debug, Clone)]
pub struct RobotFile {
    /// Robot.
    pub robot: Robot,
    /// Origin of the text, for messages and pages.
    pub name: String,
    /// Text with its changes.
    pub text: String,
}

/// Text of a robot file from its bytes.
///
/// # Errors
/// More than [`MAX_BYTES`] bytes, or bytes that are not UTF-8.
pub fn decode(name: &str, bytes: Vec<u8>) -> Result<String> {
    if bytes.len() > MAX_BYTES {
        bail!("{name} is larger than {} MiB: it is not a robot file", MAX_BYTES >> 20);
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        anyhow!("{name} is not valid UTF-8 at byte {}: a robot file is TOML in UTF-8", at + 1)
    })
}

impl RobotText {
    /// Robot that is built into the front ends.
    pub fn embedded() -> Self {
        Self { name: EMBEDDED.0.to_owned(), text: EMBEDDED.1.to_owned(), set: Vec::new() }
    }

    /// Reads the robot.
    ///
    /// # Errors
    /// A change of a value that the file does not have, or [`Refused`].
    pub fn read(&self) -> Result<RobotFile> {
        let mut name = if self.name.is_empty() { "<request>".to_owned() } else { self.name.clone() };
        if !self.set.is_empty() {
            name.push_str(" with changes");
        }
        let text = self.changed_text()?;
        match Robot::from_toml(&text) {
            Ok(robot) => Ok(RobotFile { robot, name, text }),
            Err(error) => Err(Refused::new(name, &text, error).into()),
        }
    }

    /// Text with its changes.
    ///
    /// # Errors
    /// A change of a value that the file does not have.
    pub fn changed_text(&self) -> Result<String> {
        if self.set.is_empty() {
            return Ok(self.text.clone());
        }
        let changes = self.set.iter().map(Change::assignment).collect::<Result<Vec<_>>>()?;
        Ok(set_values::apply(&self.text, &changes)?)
    }

    /// Text of the robot whose unstrained lengths are held: with the changes of `[state]` alone.
    pub(crate) fn of_holder(&self) -> Self {
        let set = self.set.iter().filter(|change| change.is_of_state()).cloned().collect();
        Self { set, ..self.clone() }
    }
}

impl Change {
    /// True for a value of `[state]`.
    fn is_of_state(&self) -> bool {
        set_values::path(&self.path).is_ok_and(|path| path.is_of_state())
    }

    /// Change in the form that the editor of robot files takes.
    fn assignment(&self) -> Result<Assignment> {
        let Self { path, value } = self;
        set_values::of_json(path, value).map_err(|reason| anyhow!("⟪set⟫ {path}: {reason}"))
    }
}
