//! `merge`: parts of a sweep become one file.

use crate::args::MergeArgs;
use crate::errors;
use crate::table::counted;
use anyhow::Result;

pub(crate) fn run(args: &MergeArgs) -> Result<()> {
    let rows = funicular_files::merge(&args.parts, &args.output_file)?;
    errors::note(&format!("{} in {}", counted(rows, "row"), args.output_file.display()));
    Ok(())
}
