//! Files of commands: the printed result, another file of their own, and a page.

use crate::args::OutputArgs;
use crate::errors;
use crate::output::{Content, Printed, Sink, Target};
use anyhow::{Result, bail};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use std::path::{Path, PathBuf};

/// File that a command writes besides its result.
#[derive(Clone, Copy)]
pub(super) struct OtherFile<'a> {
    /// Key of its option.
    key: &'static str,
    path: Option<&'a Path>,
    content: Content<'a>,
    /// Kind of files that `-o` may name for it.
    by_ending: Option<Kind>,
}

impl<'a> OtherFile<'a> {
    /// Robot file with values that a command has found.
    pub(super) fn robot(key: &'static str, path: Option<&'a Path>) -> Self {
        let content = Content { name: "the robot file", in_words: "a robot file", fitting: &[Kind::Toml] };
        Self { key, path, content, by_ending: Some(Kind::Toml) }
    }

    /// Animated drawing.
    pub(super) fn animation(path: Option<&'a Path>) -> Self {
        Self { key: "animation", path, content: Content::ANIMATION, by_ending: None }
    }

    /// Lengths for a controller.
    pub(super) fn lengths(path: Option<&'a Path>) -> Self {
        Self { key: "lengths", path, content: Content::LENGTHS, by_ending: None }
    }
}

/// Opened files of a result.
pub(super) struct ResultFiles {
    sink: Sink,
    other: Option<(Target, PathBuf)>,
    page: Option<(Target, PathBuf)>,
}

impl ResultFiles {
    /// Opens the files before the work. `-o` may name the page, or the other file by its ending.
    ///
    /// # Errors
    /// A file that cannot be written, that the command reads, or that is named twice.
    pub(super) fn open(output: &OutputArgs, other: OtherFile, page: Option<&Path>, guard: &mut Guard) -> Result<Self> {
        let file = output.output_file.as_deref();
        let kind = file.and_then(Kind::of).filter(|_| output.format.is_none());
        let [to_other, to_page] =
            [other.by_ending, Some(Kind::Html)].map(|wanted| file.filter(|_| wanted.is_some() && kind == wanted));
        let given = |option: Option<&Path>, by_ending: Option<&Path>, name: &str| match (option, by_ending) {
            (Some(_), Some(_)) => {
                bail!("⟪{name}⟫ and -o name a file of the same kind: leave out one of them")
            }
            (option, by_ending) => Ok(option.or(by_ending).map(Path::to_owned)),
        };
        let (to_other, to_page, elsewhere) = (
            given(other.path, to_other, other.key)?,
            given(page, to_page, "page")?,
            to_other.is_some() || to_page.is_some(),
        );

        let printed =
            OutputArgs { format: output.format, output_file: output.output_file.clone().filter(|_| !elsewhere) };
        let others: Vec<Kind> = other.by_ending.into_iter().chain([Kind::Html]).collect();
        let sink = Sink::open(&printed, &others, guard)?;
        let mut open = |path: Option<PathBuf>, content: Content| {
            path.map(|path| anyhow::Ok((Target::open(Some(&path), content, guard)?, path))).transpose()
        };
        Ok(Self { sink, other: open(to_other, other.content)?, page: open(to_page, Content::PAGE)? })
    }

    /// Prints the result, and writes the other file and the page, which are made only if they are wanted.
    ///
    /// # Errors
    /// A file that cannot be written, or a page that cannot be made.
    pub(super) fn write(
        self,
        found: &impl Printed,
        other: impl FnOnce() -> Result<Vec<u8>>,
        page: impl FnOnce() -> Result<String>,
    ) -> Result<()> {
        self.sink.write(found)?;
        if let Some((target, path)) = self.other {
            target.write(&other()?)?;
            errors::note(&format!("wrote {}", path.display()));
        }
        if let Some((target, path)) = self.page {
            target.write(page()?.as_bytes())?;
            errors::note(&format!("wrote {}", path.display()));
        }
        Ok(())
    }
}
