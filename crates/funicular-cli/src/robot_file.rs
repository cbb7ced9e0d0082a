//! Reading of the robot file's text. The study crate interprets it.

use crate::args::ChangeArgs;
use crate::read_files;
use anyhow::{Context, Result, bail};
use funicular_files::{Guard, beside};
use funicular_study::request::RobotText;
use funicular_study::robot_file::{self, MAX_BYTES};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reads the text of the robot file that the arguments name, or without a path the one that is built into the program.
pub(crate) fn read(path: Option<&Path>, changes: &ChangeArgs) -> Result<RobotText> {
    let (name, text) = match path {
        None => {
            let RobotText { name, text, .. } = RobotText::embedded();
            (name, text)
        }
        Some(path) if path.as_os_str() == "-" => {
            let name = "<stdin>".to_owned();
            let text = limited(io::stdin().lock(), &name)?;
            let text = with_meshes(&name, text, Path::new(""))?;
            (name, text)
        }
        Some(path) => {
            let name = path.display().to_string();
            let text = limited(open(path, &name)?, &name)?;
            read_files::note("the robot file", path);
            let text = with_meshes(&name, text, path.parent().unwrap_or(Path::new("")))?;
            (name, text)
        }
    };
    Ok(RobotText { name, text, set: changes.set.clone() })
}

/// Text of a robot file in this folder with the meshes that it names.
fn with_meshes(name: &str, text: String, folder: &Path) -> Result<String> {
    let read = beside(folder);
    robot_file::with_meshes(name, text, |mesh| {
        read_files::note("the mesh", &folder.join(mesh));
        read(mesh)
    })
}

/// Guard of a command's files that knows the robot file, also if it is standard input, and what has been read by the
/// names in other files.
pub(crate) fn guard(path: Option<&Path>) -> Guard {
    let mut guard = Guard::default();
    if let Some(path) = path {
        let path = if path.as_os_str() == "-" { Path::new("/dev/stdin") } else { path };
        guard.reads("the robot file", path);
    }
    read_files::tell(&mut guard);
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
    let most = MAX_BYTES as u64;
    reader.take(most + 1).read_to_end(&mut bytes).with_context(|| format!("cannot read the robot file {name}"))?;
    robot_file::decode(name, bytes)
}
