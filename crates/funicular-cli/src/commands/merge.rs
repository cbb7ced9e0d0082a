//! `merge`: one file of the parts of a map or sweep.

use crate::args::MergeArgs;
use crate::errors;
use crate::table::counted;
use anyhow::Result;

/// Combines parts in one file.
pub(super) fn run(args: &MergeArgs) -> Result<()> {
    let rows = funicular_files::merge(&args.parts, &args.output_file)?;
    errors::note(&format!("{} in {}", counted(rows, "row"), args.output_file.display()));
    Ok(())
}
