//! The robot file: found, read, changed as `--set` says, checked.

use crate::args::ChangeArgs;
use crate::errors::Rendered;
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular_files::{Guard, edit};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest robot file [bytes]; a cable takes some 200, so this is no robot but another file given by mistake.
const LARGEST: u64 = 16 << 20;

/// The robot that the program carries: its name and its file.
const EMBEDDED: (&str, &str) = ("robots/yuan2014-4mm.toml", include_str!("../../../robots/yuan2014-4mm.toml"));

/// A robot with the text that describes it.
pub(crate) struct RobotFile {
    pub(crate) robot: Robot,
    /// Where the text is from.
    pub(crate) name: String,
    /// With the changes of `--set`.
    pub(crate) text: String,
}

/// Reads the robot that the arguments name; without a path the one that the program carries.
pub(crate) fn read(path: Option<&Path>, changes: &ChangeArgs) -> Result<RobotFile> {
    let (mut name, mut text) = match path {
        None => (EMBEDDED.0.to_owned(), EMBEDDED.1.to_owned()),
        Some(path) if path.as_os_str() == "-" => {
            let name = "<stdin>".to_owned();
            let text = limited(io::stdin().lock(), &name)?;
            (name, text)
        }
        Some(path) => {
            let name = path.display().to_string();
            let text = limited(open(path, &name)?, &name)?;
            (name, text)
        }
    };
    if !changes.set.is_empty() {
        text = edit::apply(&text, &changes.set)?;
        name.push_str(" with --set");
    }
    match Robot::from_toml(&text) {
        Ok(robot) => Ok(RobotFile { robot, name, text }),
        Err(error) => Err(Rendered(error.render(&name, &text, crate::errors::stderr_has_colour())).into()),
    }
}

/// Guard of a command's files that knows the robot file, also where that is standard input.
pub(crate) fn guard(path: Option<&Path>) -> Guard {
    let mut guard = Guard::default();
    if let Some(path) = path {
        let path = if path.as_os_str() == "-" { Path::new("/dev/stdin") } else { path };
        guard.reads("the robot file", path);
    }
    guard
}

fn open(path: &Path, name: &str) -> Result<File> {
    if path.is_dir() {
        bail!("cannot read the robot file {name}: it is a directory; name a TOML file in it");
    }
    File::open(path)
        .with_context(|| format!("cannot read the robot file {name}; give the path of a TOML file, or - for stdin"))
}

fn limited(reader: impl Read, name: &str) -> Result<String> {
    let mut bytes = Vec::new();
    reader.take(LARGEST + 1).read_to_end(&mut bytes).with_context(|| format!("cannot read the robot file {name}"))?;
    if bytes.len() as u64 > LARGEST {
        bail!("{name} is larger than {} MiB: it is no robot file", LARGEST >> 20);
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        anyhow::anyhow!("{name} is no text: byte {} is not UTF-8; a robot file is TOML in UTF-8", at + 1)
    })
}
