//! Destination of a result: standard output, or a file that is written completely or not at all.

use crate::args::{FigureArgs, Format, OutputArgs};
use anyhow::{Context, Result, anyhow, bail};
use funicular::suggest::visible;
use funicular_files::atomic_file::{TemporaryFile, is_regular_or_new};
use funicular_files::endings::{self, Kind};
use funicular_files::{Guard, parquet_of_result};
use funicular_pages::figures::{Figure, Size};
use funicular_study::analyses::Found;
use funicular_study::columns::{ResultTable, Tabled};
use funicular_study::wording::{Words, told};
use funicular_study::{NoSolution, json};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Results in the forms that the program prints.
pub(crate) trait Printed: Found + Tabled {
    /// Name of the command, for results that several commands share.
    fn command(&self) -> &'static str {
        Self::COMMAND
    }

    /// Rounded tables for reading.
    fn text(&self) -> String;

    /// Universal File, for results that such a file can hold.
    ///
    /// # Errors
    /// Results that it cannot hold.
    fn uff(&self) -> Result<Vec<u8>> {
        bail!("results of `{}` cannot be written as a Universal File", self.command())
    }
}

/// Kind of an output file: its name in messages and the endings it may have.
#[derive(Clone, Copy)]
pub(crate) struct Content<'a> {
    /// Name of the output in messages: "the result".
    pub(crate) name: &'static str,
    /// Kind of the file in messages: "a page".
    pub(crate) in_words: &'static str,
    /// File name endings of this kind.
    pub(crate) fitting: &'a [Kind],
}

impl Content<'static> {
    /// Lengths for a controller.
    pub(crate) const LENGTHS: Self = Self { name: "the lengths", in_words: "CSV", fitting: &[Kind::Csv] };
    /// Animated drawing.
    pub(crate) const ANIMATION: Self =
        Self { name: "the animation", in_words: "an animated drawing", fitting: &[Kind::Svg] };
    /// HTML page.
    pub(crate) const PAGE: Self = Self { name: "the page", in_words: "a page", fitting: &[Kind::Html] };

    /// Figure for a paper.
    const FIGURE: Self = Self { name: "the figure", in_words: "a figure", fitting: &[Kind::Svg, Kind::Pdf] };
}

/// Format of a figure's file.
#[derive(Clone, Copy)]
enum FigureFormat {
    Svg,
    Pdf,
}

impl FigureFormat {
    /// Format given by the ending of the file; `None` if the file does not hold a figure.
    fn of(path: Option<&Path>) -> Option<Self> {
        match Kind::of(path?)? {
            Kind::Svg => Some(Self::Svg),
            Kind::Pdf => Some(Self::Pdf),
            _ => None,
        }
    }
}

/// Destination of a figure.
pub(crate) struct FigureSink {
    format: FigureFormat,
    size: Size,
    target: Target,
}

impl FigureSink {
    /// Destination of a figure if the ending of the file asks for one.
    ///
    /// # Errors
    /// A size out of its limits, a size without such a file, or a destination that cannot be written.
    pub(crate) fn open(path: Option<&Path>, args: FigureArgs, guard: &mut Guard) -> Result<Option<Self>> {
        let FigureArgs { figure_width_mm, font_size_pt } = args;
        let size = Size::new(figure_width_mm, font_size_pt)?;
        let Some(format) = FigureFormat::of(path) else {
            for (given, key) in [(figure_width_mm, "figure_width_mm"), (font_size_pt, "font_size_pt")] {
                refuse_without_figure(given.is_some(), key)?;
            }
            return Ok(None);
        };
        Ok(Some(Self { format, size, target: Target::open(path, Content::FIGURE, guard)? }))
    }

    /// Draws and writes a figure.
    pub(crate) fn write(&self, figure: &Figure) -> Result<()> {
        let bytes = match self.format {
            FigureFormat::Svg => figure.svg(self.size).into_bytes(),
            FigureFormat::Pdf => figure.pdf(self.size),
        };
        self.target.write(&bytes)
    }
}

/// Refuses an option of figures where no figure is written.
pub(crate) fn refuse_without_figure(is_given: bool, key: &str) -> Result<()> {
    if is_given {
        bail!("⟪{key}⟫ belongs to a figure: write one with -o FILE.svg or -o FILE.pdf, or leave it out");
    }
    Ok(())
}

/// Refuses a page under the name of a figure, and names the commands that write figures.
pub(crate) fn refuse_page_as_figure(path: &Path) -> Result<()> {
    if FigureFormat::of(Some(path)).is_some() {
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
    file: Option<PathBuf>,
}

impl Target {
    /// Checks that bytes can be written, before long work begins. No path or `-` is standard output.
    ///
    /// # Errors
    /// A destination that cannot be written; a file that the command also reads or writes; or a file whose ending means
    /// another format.
    pub(crate) fn open(path: Option<&Path>, content: Content<'_>, guard: &mut Guard) -> Result<Self> {
        let Some(path) = path.filter(|path| path.as_os_str() != "-") else { return Ok(Self { file: None }) };
        let shown = path.display();
        // A symbolic link is followed: its target is replaced, not the link.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if target.is_dir() {
            bail!("cannot write to {shown}: it is a directory; add a file name");
        }
        guard.writes(content.name, path)?;
        endings::check(path, content.in_words, content.fitting)?;
        if is_regular_or_new(&target) {
            if fs::metadata(&target).is_ok_and(|metadata| metadata.permissions().readonly()) {
                bail!("cannot write to {shown}: it is read-only");
            }
            TemporaryFile::beside(&target).with_context(|| format!("cannot write to {shown}"))?;
        }
        Ok(Self { file: Some(target) })
    }

    /// True if the output becomes a file, not standard output or a device.
    pub(crate) fn is_file(&self) -> bool {
        self.file.is_some()
    }

    /// Writes all bytes.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        match &self.file {
            None => to_stdout(bytes),
            Some(path) => to_file(path, bytes).with_context(|| format!("cannot write to {}", path.display())),
        }
    }
}

/// Destination and format of a result.
pub(crate) struct Sink {
    form: Form,
    target: Target,
}

/// Forms of a result's bytes: the formats, and the files that only an ending requests.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    As(Format),
    Parquet,
    Uff,
}

impl Sink {
    /// Chooses the requested format, or else the format of the file's ending. Refuses to overwrite a file that the
    /// guard knows. `others` are the kinds of files that the command also writes: messages then name their endings.
    pub(crate) fn open(args: &OutputArgs, others: &[Kind], guard: &mut Guard) -> Result<Self> {
        let path = args.output_file.as_deref();
        if args.format.is_none() && path.and_then(Kind::of) == Some(Kind::Uff) && others.contains(&Kind::Uff) {
            let in_words = "a Universal File";
            let content = Content { name: "the result", in_words, fitting: &[Kind::Uff] };
            return Ok(Self { form: Form::Uff, target: Target::open(path, content, guard)? });
        }
        if let Some(path) = path.filter(|path| args.format.is_none() && Kind::of(path) == Some(Kind::Parquet)) {
            funicular_files::Format::of(path)?;
            let content = Content { name: "the result", in_words: "a Parquet file", fitting: &[Kind::Parquet] };
            return Ok(Self { form: Form::Parquet, target: Target::open(Some(path), content, guard)? });
        }
        let format = args.format.unwrap_or(match path.and_then(Kind::of) {
            Some(Kind::Json) => Format::Json,
            Some(Kind::Csv) => Format::Csv,
            _ => Format::Text,
        });
        let all = [&[Kind::Json, Kind::Csv, Kind::Parquet], others, &[Kind::Markdown, Kind::Text]].concat();
        let (in_words, fitting): (_, &[Kind]) = match (args.format, format) {
            (None, Format::Text) => ("text", &all),
            (_, Format::Text) => ("text", &[Kind::Markdown, Kind::Text]),
            (_, Format::Json) => ("JSON", &[Kind::Json, Kind::Text]),
            (_, Format::Csv) => ("CSV", &[Kind::Csv, Kind::Text]),
        };
        let content = Content { name: "the result", in_words, fitting };
        Ok(Self { form: Form::As(format), target: Target::open(path, content, guard)? })
    }

    /// Writes the result. Its warnings also go to stderr.
    pub(crate) fn write<R: Printed>(&self, results: &R) -> Result<()> {
        self.target.write(&self.render(results)?)?;
        results.warnings().iter().for_each(|warning| crate::errors::warn(warning));
        Ok(())
    }

    fn render<R: Printed>(&self, results: &R) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self.form {
            Form::Uff => {
                as_json(&mut Vec::new(), results)?;
                bytes = results.uff()?;
            }
            Form::Parquet => {
                as_json(&mut Vec::new(), results)?;
                bytes = parquet_of_result(results.command(), results.table())?;
            }
            Form::As(Format::Json) => as_json(&mut bytes, results)?,
            Form::As(format) => {
                // Only finite numbers are printed: this check is the same for all formats.
                as_json(&mut Vec::new(), results)?;
                if format == Format::Text {
                    bytes = visible(&results.text()).into_bytes();
                    if self.target.is_file() {
                        for warning in in_words(results) {
                            writeln!(bytes, "\nwarning: {warning}")?;
                        }
                    }
                } else {
                    bytes = as_csv(results.table())?;
                }
            }
        }

        Ok(bytes)
    }
}

/// Table as CSV with a header.
pub(crate) fn as_csv(ResultTable { columns, mut rows }: ResultTable<'_>) -> Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(columns.iter().map(|column| &column.name))?;
    rows.try_for_each(|row| table.serialize(row))?;
    table.into_inner().map_err(|error| anyhow!("{}", error.error()))
}

fn as_json<R: Printed>(out: &mut Vec<u8>, results: &R) -> Result<(), NoSolution> {
    json::write(out, results.command(), results.robot(), results, &in_words(results))
}

/// Warnings with the options of the program.
fn in_words<R: Printed>(results: &R) -> Vec<String> {
    results.warnings().iter().map(|warning| told(warning, Words::Program)).collect()
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

fn to_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if !is_regular_or_new(path) {
        return fs::OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let mut file = TemporaryFile::beside(path)?;
    file.as_file_mut().write_all(bytes)?;
    file.persist(path)
}
