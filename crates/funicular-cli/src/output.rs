//! Destination of a result: standard output, or a file that is written completely or not at all.

use crate::args::{Format, OutputArgs};
use crate::errors;
use anyhow::{Result, bail};
use funicular::suggest::visible;
use funicular_answers::destination::Bytes;
use funicular_answers::outputs::{as_csv, told};
use funicular_answers::{Content, Destination};
use funicular_files::endings::Kind;
use funicular_files::{Guard, parquet_of_result};
use funicular_study::analyses::Found;
use funicular_study::columns::Tabled;
use funicular_study::wording::Words;
use funicular_study::{NoSolution, json, wording};
use std::io::{self, Write};
use std::path::Path;

/// Results in the forms that the program prints.
pub(crate) trait Printed: Found + Tabled {
    /// Name of the command, for results that several commands share.
    fn command(&self) -> &'static str {
        Self::COMMAND
    }

    /// Rounded tables for reading.
    fn text(&self) -> String;
}

impl<R: Printed> Printed for Box<R> {
    fn command(&self) -> &'static str {
        (**self).command()
    }

    fn text(&self) -> String {
        (**self).text()
    }
}

/// Refuses a page under the name of a figure, and names the commands that write figures.
pub(crate) fn refuse_page_as_figure(path: &Path) -> Result<()> {
    if matches!(Kind::of(path), Some(Kind::Svg | Kind::Pdf)) {
        bail!(
            "{} would hold one figure, but the page has many: write one with `funicular statics`, `modes`, `frf`, \
             `compare` or `plot` and -o {}, or choose a name that ends in .html and use the buttons SVG, PNG and PDF \
             of the page",
            path.display(),
            path.display()
        );
    }
    Ok(())
}

/// Standard output, or a file that is written completely or not at all.
pub(crate) struct Target {
    file: Option<Destination>,
}

impl Target {
    /// Checks that bytes can be written, before long work begins. No path or `-` is standard output.
    ///
    /// # Errors
    /// Those of [`Destination::open`].
    pub(crate) fn open(path: Option<&Path>, content: Content<'_>, guard: &mut Guard) -> Result<Self> {
        let path = path.filter(|path| path.as_os_str() != "-");
        Ok(Self { file: path.map(|path| Destination::open(path, content, guard)).transpose()? })
    }

    /// True if the output becomes a file, not standard output or a device.
    pub(crate) fn is_file(&self) -> bool {
        self.file.is_some()
    }

    /// Writes all bytes, and tells of a file, with its size in words.
    pub(crate) fn write(&self, bytes: Vec<u8>, size: Option<&str>) -> Result<()> {
        let Some(file) = &self.file else { return to_stdout(&bytes) };
        file.write(&Bytes::File(bytes))?;
        if file.is_kept() {
            errors::note(&told(&file.path, size));
        }
        Ok(())
    }
}

/// Destination and format of a result.
pub(crate) struct Sink {
    form: Form,
    target: Target,
}

/// Forms of a result's bytes: the formats, and the file that only an ending requests.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    As(Format),
    Parquet,
}

impl Sink {
    /// Chooses the requested format, or else the format of the file's ending. Refuses to overwrite a file that the
    /// guard knows. `others` are the kinds of files that the command also writes: messages then name their endings.
    pub(crate) fn open(args: &OutputArgs, others: &[Kind], guard: &mut Guard) -> Result<Self> {
        let path = args.output_file.as_deref();
        if let Some(path) = path.filter(|path| args.format.is_none() && Kind::of(path) == Some(Kind::Parquet)) {
            funicular_files::Format::of(path)?;
            let content = Content { name: "the result", in_words: "a Parquet file", fitting: &[Kind::Parquet] };
            return Ok(Self { form: Form::Parquet, target: Target::open(Some(path), content, guard)? });
        }
        let format = args.format.unwrap_or(match path.and_then(Kind::of) {
            Some(Kind::Json) => Format::Json,
            Some(Kind::Csv) => Format::Csv,
            Some(Kind::Latex) => Format::Latex,
            Some(Kind::Markdown) => Format::Markdown,
            _ => Format::Text,
        });
        let all =
            [&[Kind::Json, Kind::Csv, Kind::Parquet], others, &[Kind::Latex, Kind::Markdown, Kind::Text]].concat();
        let (in_words, fitting): (_, &[Kind]) = match (args.format, format) {
            (None, Format::Text) => ("text", &all),
            (_, Format::Text) => ("text", &[Kind::Markdown, Kind::Text]),
            (_, Format::Latex) => ("LaTeX", &[Kind::Latex, Kind::Text]),
            (_, Format::Markdown) => ("Markdown", &[Kind::Markdown, Kind::Text]),
            (_, Format::Json) => ("JSON", &[Kind::Json, Kind::Text]),
            (_, Format::Csv) => ("CSV", &[Kind::Csv, Kind::Text]),
        };
        let content = Content { name: "the result", in_words, fitting };
        Ok(Self { form: Form::As(format), target: Target::open(path, content, guard)? })
    }

    /// Writes the result. Its warnings also go to stderr.
    pub(crate) fn write<R: Printed>(&self, results: &R) -> Result<()> {
        self.write_bytes(self.render(results)?)?;
        results.warnings().iter().for_each(|warning| errors::warn(warning));
        Ok(())
    }

    /// Writes what [`Sink::render`] has made.
    pub(crate) fn write_bytes(&self, bytes: Vec<u8>) -> Result<()> {
        self.target.write(bytes, None)
    }

    /// Result in the form that is wanted.
    ///
    /// # Errors
    /// A result that is not a finite number.
    pub(crate) fn render<R: Printed>(&self, results: &R) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self.form {
            Form::Parquet => {
                as_json(&mut Vec::new(), results)?;
                bytes = parquet_of_result(results.command(), results.table())?;
            }
            Form::As(Format::Json) => as_json(&mut bytes, results)?,
            Form::As(format) => {
                // Only finite numbers are printed: this check is the same for all formats.
                as_json(&mut Vec::new(), results)?;
                bytes = match format {
                    Format::Text => self.text(results)?,
                    Format::Latex => visible(&results.table().reading().latex()).into_bytes(),
                    Format::Markdown => visible(&results.table().reading().markdown()).into_bytes(),
                    _ => as_csv(results.table())?,
                };
            }
        }

        Ok(bytes)
    }
}

impl Sink {
    /// Tables for reading; a file has the warnings too.
    fn text<R: Printed>(&self, results: &R) -> Result<Vec<u8>> {
        let mut bytes = visible(&results.text()).into_bytes();
        if self.target.is_file() {
            for warning in in_words(results) {
                writeln!(bytes, "\nwarning: {warning}")?;
            }
        }
        Ok(bytes)
    }
}

fn as_json<R: Printed>(out: &mut Vec<u8>, results: &R) -> Result<(), NoSolution> {
    json::write(out, results.command(), results.robot(), results, &in_words(results))
}

/// Warnings with the options of the program.
fn in_words<R: Printed>(results: &R) -> Vec<String> {
    results.warnings().iter().map(|warning| wording::told(warning, Words::Program)).collect()
}

fn to_stdout(bytes: &[u8]) -> Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(of_stdout)
}

/// Error of standard output. A closed pipe is passed on unchanged, because it does not count as an error: the reader
/// has stopped.
pub(crate) fn of_stdout(error: io::Error) -> anyhow::Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => error.into(),
        _ => anyhow::Error::new(error).context("cannot write to standard output"),
    }
}
