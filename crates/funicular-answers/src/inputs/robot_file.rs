//! Reading of the robot file's text. The study crate interprets it.

use super::FilesRead;
use anyhow::{Context, Result, bail};
use funicular_files::beside;
use funicular_study::request::{Change, RobotText};
use funicular_study::robot_file::{self, MAX_BYTES};
use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reads the text of a robot file with changes, or without a path the robot that is built into the program. `role` is
/// the name of the file in messages.
///
/// # Errors
/// A file that cannot be read.
pub fn read(path: Option<&Path>, changes: &[Change], role: &'static str, read: &mut FilesRead) -> Result<RobotText> {
    let (name, text) = match path {
        None => {
            let RobotText { name, text, .. } = RobotText::embedded();
            (name, text)
        }
        Some(path) if path.as_os_str() == "-" => {
            let name = "<stdin>".to_owned();
            read.add(role, Path::new("/dev/stdin"));
            let text = limited(io::stdin().lock(), &name)?;
            let text = with_meshes(&name, text, Path::new(""), read)?;
            (name, text)
        }
        Some(path) => {
            let name = path.display().to_string();
            let text = limited(open(path, &name)?, &name)?;
            read.add(role, path);
            let text = with_meshes(&name, text, path.parent().unwrap_or(Path::new("")), read)?;
            (name, text)
        }
    };
    Ok(RobotText { name, text, set: changes.to_vec() })
}

/// Text of a robot file in this folder with the meshes that it names.
fn with_meshes(name: &str, text: String, folder: &Path, read: &mut FilesRead) -> Result<String> {
    let bytes_of = beside(folder);
    let files = RefCell::new(read);
    robot_file::with_meshes(name, text, |mesh| {
        files.borrow_mut().add("the mesh", &folder.join(mesh));
        bytes_of(mesh)
    })
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
