//! `merge`: one file of the parts of a map or sweep.

use crate::args::{Cli, MergeArgs};
use crate::errors;
use crate::table::counted;
use anyhow::Result;
use funicular_study::request::Request;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// Request with the paths of the parts.
pub(super) fn request(cli: &Cli, mut further: Map<String, Value>) -> Result<Request> {
    let parts = cli.files::<MergeArgs>()?.parts;
    let shown: Vec<String> = parts.iter().map(|part| part.display().to_string()).collect();
    further.insert("parts".to_owned(), shown.into());
    cli.request(further)
}

/// Combines the parts that the arguments name.
pub(super) fn run(args: &MergeArgs) -> Result<()> {
    write(&args.parts, &args.output_file)
}

/// Combines parts in one file.
pub(super) fn write(parts: &[PathBuf], to: &Path) -> Result<()> {
    let rows = funicular_files::merge(parts, to)?;
    errors::note(&format!("{} in {}", counted(rows, "row"), to.display()));
    Ok(())
}
