//! Robot file of a request: its text is changed, read and checked.

pub mod page;
pub mod schema;

pub use crate::refused::Refused;

use crate::request::{Change, RobotText};
use crate::set_values::{self, Assignment};
use anyhow::{Context, Result, anyhow, bail};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use funicular::robot::Robot;
use std::io;
use std::ops::Range;

/// Name and text of the robot that is built into every front end.
const EMBEDDED: (&str, &str) = ("robots/yuan2014-4mm.toml", funicular_robots::YUAN2014_4MM);

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

/// Text of a robot file in which the STL files of its bodies stand as data, so that requests, pages and copies need no
/// other file. `read` gives the bytes of a file that is named relative to the robot file, one byte more than
/// [`MAX_BYTES`] at most. Text that is no TOML stays as it is: its reader says what is wrong.
///
/// # Errors
/// An STL file that cannot be read, or that is too large.
pub fn with_meshes(name: &str, text: String, read: impl Fn(&str) -> io::Result<Vec<u8>>) -> Result<String> {
    let Ok(document) = toml_edit::Document::parse(text.as_str()) else { return Ok(text) };
    let mut found: Vec<(Range<usize>, String)> = Vec::new();
    for kind in ["obstacles", "platform_bodies"] {
        let tables = document.get(kind).and_then(toml_edit::Item::as_table_like);
        for (body, entry) in tables.into_iter().flat_map(toml_edit::TableLike::iter) {
            let Some(file) = entry.as_table_like().and_then(|entry| entry.get("file")) else { continue };
            let (Some(path), Some(span)) = (file.as_str(), file.span()) else { continue };
            if path.starts_with("data:") {
                continue;
            }
            let data = read(path)
                .map_err(Into::into)
                .and_then(|bytes| mesh_data(path, &bytes))
                .with_context(|| format!("{name}: the mesh {path:?} of [{kind}.{body}] cannot be read"))?;
            found.push((span, data));
        }
    }

    // The last first, so that the places of the others stay.
    found.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let with_data = |mut text: String, (span, data): (Range<usize>, String)| {
        text.replace_range(span, &format!("\"{data}\""));
        text
    };
    Ok(found.into_iter().fold(text.clone(), with_data))
}

/// Content of an STL file as a data URL.
fn mesh_data(path: &str, bytes: &[u8]) -> Result<String> {
    if bytes.len() > MAX_BYTES {
        bail!("it is larger than {} MiB; export it with fewer triangles", MAX_BYTES >> 20);
    }
    // The name stays for messages, without the characters that end it.
    let name: String = path.chars().filter(|c| c.is_alphanumeric() || "._-/ ".contains(*c)).collect();
    Ok(format!("data:model/stl;name={name};base64,{}", BASE64_STANDARD.encode(bytes)))
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
    pub(crate) fn changed_text(&self) -> Result<String> {
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
