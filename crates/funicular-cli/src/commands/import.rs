//! `import`: a robot file from files of other programs.

use crate::args::{Cli, ImportArgs};
use crate::errors;
use crate::output::{Content, Target};
use anyhow::{Context, Result, bail};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_formats::import::{self, SourceFile};
use funicular_study::request::{ImportRequest, Request};
use funicular_study::wording::Words;
use serde_json::{Map, Value};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Request with the texts of the files.
pub(super) fn request(cli: &Cli, mut further: Map<String, Value>) -> Result<Request> {
    let files = sources(&cli.files::<ImportArgs>()?.files)?;
    further.insert("files".to_owned(), serde_json::to_value(files)?);
    cli.request(further)
}

/// Converts files of other programs to a robot file.
pub(super) fn run(request: &ImportRequest, args: &ImportArgs) -> Result<()> {
    let mut guard = Guard::default();
    for source in &args.files {
        guard.reads("the source file", source);
    }
    write(request, &mut guard, &args.to.output_file)
}

/// Writes the robot file, or the table of a trajectory, of files of other programs.
pub(super) fn write(request: &ImportRequest, guard: &mut Guard, path: &Path) -> Result<()> {
    let content = match request.trajectory {
        None => Content { name: "the robot file", in_words: "a robot file", fitting: &[Kind::Toml] },
        Some(_) => Content { name: "the table", in_words: "a table", fitting: &[Kind::Csv] },
    };
    let target = Target::open(Some(path), content, guard)?;
    let imported = import::run(request, Words::Program)?;
    target.write(imported.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    for assumed in &imported.assumed {
        errors::warn(&format!("assumed: {assumed}"));
    }
    for lost in &imported.lost {
        errors::warn(&format!("not carried over: {lost}"));
    }
    Ok(())
}

/// Reads the files of another program as text.
pub(super) fn sources(paths: &[PathBuf]) -> Result<Vec<SourceFile>> {
    let read = |path: &PathBuf| {
        let shown = path.display().to_string();
        if path.is_dir() {
            bail!("cannot read {shown}: it is a directory; name the files in it");
        }
        let file = File::open(path).with_context(|| format!("cannot read {shown}"))?;
        let mut bytes = Vec::new();
        // One byte is read beyond the limit, which shows that a file is too large.
        file.take(import::MAX_BYTES as u64 + 1)
            .read_to_end(&mut bytes)
            .with_context(|| format!("cannot read {shown}"))?;
        SourceFile::decode(shown, &bytes)
    };
    paths.iter().map(read).collect()
}
