//! `merge`: one file of the parts of a map or sweep.

use crate::errors;
use crate::table::counted;
use anyhow::Result;
use funicular_answers::outputs::told;
use funicular_study::request::MergeRequest;
use std::path::{Path, PathBuf};

/// Combines the parts in one file.
pub(super) fn run(of: &MergeRequest, to: &Path) -> Result<()> {
    let parts: Vec<PathBuf> = of.parts.iter().map(PathBuf::from).collect();
    let rows = funicular_files::merge(&parts, to)?;
    errors::note(&told(to, Some(&counted(rows, "row"))));
    Ok(())
}
