//! The robot file: found, read, changed as `--set` says, checked.

use crate::args::RobotArgs;
use crate::errors::Rendered;
use crate::set;
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest robot file [bytes]; a cable takes some 200, so this is no robot but another file given by mistake.
const LARGEST: u64 = 16 << 20;

/// Reads the robot that the arguments name.
pub(crate) fn read(args: &RobotArgs) -> Result<Robot> {
    let is_stdin = args.robot.as_os_str() == "-";
    let name = if is_stdin { "<stdin>".to_owned() } else { args.robot.display().to_string() };
    let text = if is_stdin { limited(io::stdin().lock(), &name)? } else { limited(open(&args.robot, &name)?, &name)? };
    if args.set.is_empty() {
        parse(&text, &name)
    } else {
        parse(&set::apply(&text, &args.set)?, &format!("{name} with --set"))
    }
}

fn parse(text: &str, name: &str) -> Result<Robot> {
    Robot::from_toml(text)
        .map_err(|error| Rendered(error.render(name, text, crate::errors::stderr_has_colour())).into())
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
