//! `import`: files of other programs become a robot file.

use crate::args::ImportArgs;
use crate::errors;
use crate::import::text::SourceFile;
use crate::import::{self, Wanted};
use crate::output::Target;
use anyhow::Result;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &ImportArgs) -> Result<()> {
    let files = args.files.iter().map(|path| SourceFile::read(path)).collect::<Result<Vec<_>>>()?;
    let target = target(&args.output_file, &args.files)?;
    let mut draft = import::read(&files, &Wanted { cable_set: args.cable_set.as_deref() })?;
    draft.complete(&args.ropes, &args.platform)?;
    let text = draft.to_toml()?;
    target.write(text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", args.output_file.display()));
    }
    for assumed in &draft.assumed {
        errors::warn(&format!("assumed: {assumed}"));
    }
    for lost in &draft.lost {
        errors::warn(&format!("not carried over: {lost}"));
    }
    Ok(())
}

/// Where the robot file goes: over none of the files that are read.
fn target(path: &Path, sources: &[PathBuf]) -> Result<Target> {
    let mut target = Target::open(Some(path), None)?;
    for source in sources {
        target = Target::open(Some(path), Some(source))?;
    }
    Ok(target)
}
