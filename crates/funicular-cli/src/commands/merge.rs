//! `merge`: one file of the parts of a map or sweep.

use crate::args::MergeArgs;
use crate::errors;
use crate::table::counted;
use anyhow::Result;
use std::path::{Path, PathBuf};

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
