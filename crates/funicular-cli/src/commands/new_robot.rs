//! `new`: a robot file with starting values.

use super::import::sources;
use crate::args::{Cli, NewArgs};
use crate::errors;
use crate::output::{Content, Target};
use anyhow::{Result, bail};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_formats::new_robot;
use funicular_study::request::{NewRequest, Request};
use funicular_study::wording::Words;
use serde_json::{Map, Value};
use std::path::Path;
use std::slice;

/// Request of a new robot, with the table that it names.
pub(super) fn request(cli: &Cli, mut further: Map<String, Value>) -> Result<Request> {
    if let Some(path) = cli.files::<NewArgs>()?.from_csv {
        let table = sources(slice::from_ref(&path))?.pop();
        further.insert("from_csv".to_owned(), serde_json::to_value(table)?);
    }
    cli.request(further)
}

/// Runs `new`.
pub(super) fn run(request: &NewRequest, args: &NewArgs) -> Result<()> {
    let mut guard = Guard::default();
    if let Some(table) = &args.from_csv {
        guard.reads("the table of points", table);
    }
    write(request, &mut guard, &args.output_file)
}

/// Writes a new robot file. An existing file may hold numbers that somebody has written by hand, so it is never
/// replaced.
pub(super) fn write(request: &NewRequest, guard: &mut Guard, path: &Path) -> Result<()> {
    let content = Content { name: "the robot file", in_words: "a robot file", fitting: &[Kind::Toml] };
    let target = Target::open(Some(path), content, guard)?;
    if target.is_file() && path.is_file() {
        bail!("{} exists and may hold your own numbers: name another file, or remove it", path.display());
    }
    let made = new_robot::run(request, Words::Program)?;
    target.write(made.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
        errors::note(&made.pose_line());
    }
    made.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}
