//! `import`: files of other programs become a robot file.

use crate::args::ImportArgs;
use crate::errors;
use crate::import::text::SourceFile;
use crate::import::{self, Wanted};
use crate::output::{Content, Target};
use anyhow::Result;
use funicular_files::Guard;
use funicular_files::endings::Kind;

pub(crate) fn run(args: &ImportArgs) -> Result<()> {
    let files = args.files.iter().map(|path| SourceFile::read(path)).collect::<Result<Vec<_>>>()?;
    let mut guard = Guard::default();
    for path in &args.files {
        guard.reads("the source file", path);
    }
    let content = Content { name: "the robot file", option: "-o", in_words: "a robot file", fitting: &[Kind::Toml] };
    let target = Target::open(Some(&args.output_file), content, &mut guard)?;
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
