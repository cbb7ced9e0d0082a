//! Files that are wanted of a command: checked before the work, made of its results, then written.

use super::wanted::Wanted;
use super::{Answered, Drawn, FigureOptions, Given, Made, Make, Output, of, size_of_page};
use crate::destination::{Bytes, Destination};
use anyhow::{Result, bail};
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_pages::figures::Size;
use funicular_study::request::{Request, keys_of};
use funicular_study::wording::worded;
use funicular_study::{Results, Watch};
use serde_json::Map;
use std::path::Path;

/// Files that have been checked and can be written.
pub struct Opened {
    files: Vec<(&'static Output, Destination)>,
    options: FigureOptions,
    size: Size,
}

impl Opened {
    /// Checks the wanted files of a request, in the order of the table, before the work.
    ///
    /// # Errors
    /// Those of [`Opened::of_keys`].
    pub fn open(request: &Request, wanted: &[Wanted], options: FigureOptions, guard: &mut Guard) -> Result<Self> {
        let given = if wanted.is_empty() { Map::new() } else { keys_of(request)? };
        Self::of_keys(request.command(), &given, wanted, options, guard)
    }

    /// Checks the wanted files of a command with these keys.
    ///
    /// # Errors
    /// A file that the command does not have, that the request has not, that cannot be written, or that the command
    /// reads or writes otherwise; options of a figure without one.
    pub fn of_keys(
        command: &str,
        given: &Given,
        wanted: &[Wanted],
        options: FigureOptions,
        guard: &mut Guard,
    ) -> Result<Self> {
        let outputs = of(command);
        if let Some(other) = wanted.iter().find(|of| !outputs.iter().any(|output| output.key == of.key)) {
            let known: Vec<String> = outputs.iter().map(|output| format!("⟪{}⟫", output.key)).collect();
            let known = if known.is_empty() { "no other file".to_owned() } else { known.join(", ") };
            bail!("`{command}` writes no ⟪{}⟫: besides its result it writes {known}", other.key);
        }
        let size = Size::new(options.width_mm, options.font_size_pt)?;
        let mut files = Vec::new();
        for output in outputs {
            let paths: Vec<&Path> =
                wanted.iter().filter(|of| of.key == output.key).map(|of| of.path.as_path()).collect();
            if paths.len() > 1 && !output.several {
                bail!("⟪{}⟫ and -o name a file of the same kind: leave out one of them", output.key);
            }
            for path in paths {
                output.refuse(given, path)?;
                files.push((output, output.destination(path, guard)?));
            }
        }
        let opened = Self { files, options, size };
        if let Some(key) = opened.options.given().next().filter(|_| !opened.has_figure()) {
            bail!("⟪{key}⟫ belongs to a figure: write one with -o FILE.svg or -o FILE.pdf, or leave it out");
        }
        if opened.options.mode.is_some() && command != "modes" {
            bail!("⟪figure_mode⟫ chooses a mode shape of `modes`: leave it out for `{command}`");
        }
        Ok(opened)
    }

    /// True with a figure.
    pub fn has_figure(&self) -> bool {
        self.files.iter().any(|(output, _)| matches!(output.make, Make::Figure(_)))
    }

    /// True if some file is made of results.
    pub fn needs_results(&self) -> bool {
        self.files.iter().any(|(output, _)| !output.of_request)
    }

    /// True without any file.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Tells results where their files will be, if their text says so.
    pub fn tell(&self, results: &mut Results) {
        if let Results::Reduce(found) = results {
            found.set_matrices_file(self.files.first().map(|(_, to)| to.path.display().to_string()));
        }
    }

    /// Makes all files, in the order of the table.
    ///
    /// # Errors
    /// Results without such a file.
    pub fn make(self, at: Answered<'_>, watch: &mut dyn Watch) -> Result<Vec<Written>> {
        let Self { files, options, size } = self;
        let made = |(output, destination): (&Output, Destination)| {
            let kind = Kind::of(&destination.path);
            let Made { bytes, warnings, notes, size } = match output.make {
                Make::Page(make) => {
                    let page = worded(&make(&at)?, at.words);
                    Made { size: Some(size_of_page(page.len())), ..page.into_bytes().into() }
                }
                Make::Figure(make) => {
                    let Drawn { figure, warnings, notes } = make(&at, &options, watch)?;
                    let is_pdf = kind == Some(Kind::Pdf);
                    let bytes = if is_pdf { figure.pdf(size) } else { figure.svg(size).into_bytes() };
                    Made { warnings, notes, ..bytes.into() }
                }
                Make::Bytes(make) => make(&at, kind)?,
                Make::Document(make) => make(&at, watch)?,
            };
            Ok(Written { destination, bytes, size, warnings, notes })
        };
        files.into_iter().map(made).collect()
    }
}

/// File that has been made.
pub struct Written {
    destination: Destination,
    bytes: Bytes,
    size: Option<String>,
    /// Sentences about the file that the user should know.
    pub warnings: Vec<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl Written {
    /// Writes the file, and says so.
    ///
    /// # Errors
    /// The error of the system.
    pub fn write(&self) -> Result<String> {
        self.destination.write(&self.bytes)?;
        Ok(told(&self.destination.path, self.size.as_deref()))
    }
}

/// Sentence on a file that was written, with its size in words.
pub fn told(path: &Path, size: Option<&str>) -> String {
    match size {
        Some(size) => format!("wrote {} ({size})", path.display()),
        None => format!("wrote {}", path.display()),
    }
}
