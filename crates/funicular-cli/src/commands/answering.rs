//! Run of a command with results or with a file of its own: opens every file in one order, runs, prints, and writes.
//!
//! One rule for all commands: the text goes to standard output unless `-o` names it or `--quiet` is given, and each
//! file that was written is told on stderr.

use super::simulate::PartialRows;
use crate::args::{Cli, Format, OutputArgs, ReducedTo};
use crate::interrupt::{self, STOPPED, stop_at_next_row};
use crate::output::{Printed, Sink, Target, refuse_page_as_figure};
use crate::progress::{TerminalProgress, WaitingSpinner};
use crate::{args::values::Plane, errors};
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular_answers::answer::{self, Answer, Running};
use funicular_answers::document::{self, Form};
use funicular_answers::outputs::{self, Answered, Opened, Wanted, told};
use funicular_answers::{Content, FigureOptions};
use funicular_files::endings::Kind;
use funicular_files::{Begin, Guard, SweepFile, threads};
use funicular_pages::pages::plot::SweepFigureChoice;
use funicular_study::analyses::simulate::{BegunRun, RowNames};
use funicular_study::request::{Request, RobotText, ValidateRequest};
use funicular_study::text::counted;
use funicular_study::wording::Words;
use funicular_study::{Results, with_found};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Files that the command line asks for.
pub(super) struct Asked {
    /// Format and file of the result itself.
    result: OutputArgs,
    /// Files besides the result.
    pub(super) wanted: Vec<Wanted>,
    options: FigureOptions,
    samples: Option<PathBuf>,
    begin: Begin,
}

impl Asked {
    /// Files of a command line, and those that the request wants itself.
    ///
    /// # Errors
    /// A unit of a simulation without its file.
    pub(super) fn of(cli: &Cli, command: &str, mut wanted: Vec<Wanted>) -> Result<Self> {
        let format: Option<Format> = cli.value("format").copied();
        let mut output_file: Option<PathBuf> = cli.value("output_file").cloned();
        let want = |key: &str, path: PathBuf| Wanted { key: key.to_owned(), path };
        if cli.value("to") == Some(&ReducedTo::Fmu) {
            let path = output_file.take().filter(|path| Kind::of(path) == Some(Kind::Fmu));
            wanted.extend(path.map(|path| want("matrices", path)));
            if wanted.is_empty() {
                bail!("--to fmu writes a Functional Mock-up Unit: give -o FILE.fmu");
            }
        }
        // With --format the result is printed, and an ending that means another file is refused.
        let named = output_file.as_deref().filter(|_| format.is_none());
        if let Some(output) = named.and_then(|path| outputs::by_ending(command, path)) {
            wanted.extend(output_file.take().map(|path| want(output.key, path)));
        }
        for output in outputs::all() {
            wanted.extend(cli.values(output.key).into_iter().map(|path| want(output.key, path)));
        }

        let of_rows = SweepFigureChoice {
            quantity: cli.value("quantity").cloned(),
            plane: cli.value("plane").map(|Plane(axes)| axes.clone()),
            at: cli.values("at"),
        };
        let options = FigureOptions {
            width_mm: cli.value("figure_width_mm").copied(),
            font_size_pt: cli.value("font_size_pt").copied(),
            mode: cli.value("figure_mode").copied(),
            of_rows,
        };
        Ok(Self {
            result: OutputArgs { format, output_file, quiet: cli.is_on("quiet") },
            wanted,
            options,
            samples: cli.value("samples_file").cloned(),
            begin: Begin::of(cli.is_on("resume"), cli.is_on("discard")),
        })
    }
}

/// Runs a request and writes its files.
pub(super) fn run(cli: &Cli, request: &Request, asked: Asked, guard: &mut Guard) -> Result<()> {
    // Errors of the robot file are reported before errors of the destinations.
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    if let Request::Validate(of) = request {
        return validate(request, of, asked, guard);
    }
    match document::form(request) {
        Some(form) => document(cli, request, form, asked, guard),
        None => results(request, robot, asked, cli.value("threads").copied(), guard),
    }
}

/// Makes comparisons, prints them and writes their files. One out of tolerance is an error.
fn validate(request: &Request, of: &ValidateRequest, asked: Asked, guard: &mut Guard) -> Result<()> {
    let Asked { result, wanted, options, samples, begin } = asked;
    refuse_parts(request, &wanted, samples.is_some(), begin)?;
    let sink = Sink::open(&result, &kinds_by_ending(request), guard)?;
    let opened = Opened::open(request, &wanted, options, guard)?;

    let computes = interrupt::stop_analysis();
    let found = funicular_validation::run(of)?;
    drop(computes);
    let text = sink.render(&found)?;
    let call = if opened.is_empty() { String::new() } else { command_line()? };
    let at = Answered { request, results: None, validated: Some(&found), call: &call, words: Words::Program };
    let files = opened.make(at, &mut TerminalProgress::new())?;

    if !result.quiet || result.output_file.is_some() {
        sink.write_bytes(text)?;
    }
    write(&files, &mut Vec::new())?;
    Ok(found.verdict()?)
}

/// Kinds of files that `-o` means by their ending.
fn kinds_by_ending(request: &Request) -> Vec<Kind> {
    let outputs = outputs::of(request.command()).iter().filter(|output| output.by_ending);
    outputs.flat_map(|output| output.kinds).copied().collect()
}

/// Runs a request, prints its results, and writes its files.
fn results(
    request: &Request,
    robot: Option<Robot>,
    asked: Asked,
    threads: Option<NonZeroUsize>,
    guard: &mut Guard,
) -> Result<()> {
    let Asked { result, wanted, options, samples, begin } = asked;
    refuse_parts(request, &wanted, samples.is_some(), begin)?;
    let sink = Sink::open(&result, &kinds_by_ending(request), guard)?;
    let opened = Opened::open(request, &wanted, options, guard)?;
    if let Some(path) = &samples {
        guard.writes_rows(path, true)?;
    }
    let (mut partial, begun) = partial_rows(request, robot.as_ref(), &result, begin, guard)?;

    if matches!(request, Request::Workspace(_) | Request::Uncertainty(_)) {
        stop_at_next_row(when_stopped(request, samples.as_deref()))?;
    }
    let mut watch = TerminalProgress::new();
    let waiting = matches!(request, Request::Statics(_)).then(|| WaitingSpinner::for_("the equilibrium"));
    let running = Running {
        watch: &mut watch,
        threads: threads::or_all(threads),
        cancel: &STOPPED,
        samples: samples.as_deref().map(|path| (path, begin)),
        has_figure: opened.has_figure(),
        keeper: partial.as_mut().map(|partial| (partial as _, begun)),
    };
    let Answer { mut results, stopped } = answer::run(request, robot, running)?;
    drop(waiting);

    opened.tell(&mut results);
    let text = with_found!(&results, found => rendered(&sink, found))?;
    let call = if opened.is_empty() { String::new() } else { command_line()? };
    let waiting = (!opened.is_empty()).then(|| WaitingSpinner::for_("the files"));
    let at = Answered { request, results: Some(&results), validated: None, call: &call, words: Words::Program };
    let files = opened.make(at, &mut watch)?;
    drop((watch, waiting));

    if !result.quiet || result.output_file.is_some() {
        sink.write_bytes(text)?;
    }
    let mut warnings = results.warnings().to_vec();
    write(&files, &mut warnings)?;
    if let (Some(path), Results::Uncertainty(found)) = (&samples, &results)
        && found.evaluations > 0
    {
        errors::note(&told(path, Some(&counted(found.evaluations, "robot"))));
    }
    for warning in &warnings {
        errors::warn(warning);
    }
    partial.into_iter().for_each(PartialRows::remove);
    stopped.map_or(Ok(()), Err)
}

fn rendered<R: Printed>(sink: &Sink, found: &R) -> Result<Vec<u8>> {
    sink.render(found)
}

/// Writes files, tells each, and adds their warnings to those that are known.
fn write(files: &[outputs::Written], warnings: &mut Vec<String>) -> Result<()> {
    for file in files {
        errors::note(&file.write()?);
        file.notes.iter().for_each(|note| errors::note(note));
        let new: Vec<&String> = file.warnings.iter().filter(|warning| !warnings.contains(warning)).collect();
        let new: Vec<String> = new.into_iter().cloned().collect();
        warnings.extend(new);
    }
    Ok(())
}

/// Refuses parts of an earlier run where nothing keeps them.
fn refuse_parts(request: &Request, wanted: &[Wanted], has_samples: bool, begin: Begin) -> Result<()> {
    if has_samples && !matches!(request, Request::Uncertainty(_)) {
        bail!("⟪samples_file⟫ belongs to `uncertainty`: leave it out for `{}`", request.command());
    }
    if begin == Begin::Anew {
        return Ok(());
    }
    match request {
        Request::Simulate(_) => match wanted.iter().find(|of| of.key == "page" || of.key == "animation") {
            Some(of) if begin == Begin::Resume => {
                bail!("a run that is continued has no moving picture of its beginning: leave out ⟪{}⟫", of.key)
            }
            _ => Ok(()),
        },
        Request::Uncertainty(_) if has_samples => Ok(()),
        Request::Uncertainty(_) => bail!("⟪resume⟫ and ⟪discard⟫ are about robots in a file: give ⟪samples_file⟫"),
        other => bail!("`{}` leaves no part of a result: leave out ⟪resume⟫ and ⟪discard⟫", other.command()),
    }
}

/// Rows of a simulation that are kept while they are computed, and the run that has begun.
fn partial_rows(
    request: &Request,
    robot: Option<&Robot>,
    result: &OutputArgs,
    begin: Begin,
    guard: &mut Guard,
) -> Result<(Option<PartialRows>, Option<BegunRun>)> {
    let (Request::Simulate(of), Some(robot)) = (request, robot) else { return Ok((None, None)) };
    let names = RowNames::of(robot, &of.point);
    let (partial, begun) = PartialRows::beside(result.output_file.as_deref(), of, names, begin, guard)?;
    Ok((Some(partial), begun))
}

/// Message of work on several threads that is stopped and takes too long to end.
fn when_stopped(request: &Request, samples: Option<&Path>) -> Option<String> {
    match (request, samples) {
        // A stopped search keeps its positions, however long their surface takes.
        (Request::Workspace(_), _) => None,
        (_, Some(path)) => Some(format!(
            "stopped: the finished robots are safe beside {}; continue with the same command and --resume",
            path.display()
        )),
        (_, None) => {
            Some("stopped, and the robots are not stored: give --samples-file to be able to continue later".to_owned())
        }
    }
}

/// Makes the file of a command whose result is one.
fn document(cli: &Cli, request: &Request, form: Form, asked: Asked, guard: &mut Guard) -> Result<()> {
    if let Request::Plot(of) = request {
        guard.reads("the rows in", Path::new(&of.file));
        SweepFile::open(Path::new(&of.file))?;
    }
    let Asked { result, wanted, options, .. } = asked;
    let by_default = || match (cli.name.as_str(), request) {
        ("request", request) if !matches!(request, Request::Plot(_)) => None,
        _ => document::default_path(request),
    };
    // Without a name of its own the file is not written if -o names another one.
    let names_another = result.output_file.is_none() && cli.is_given("output_file");
    let path = result.output_file.clone().or_else(by_default);
    let target = if names_another { None } else { Some(open(path.as_deref(), form, guard)?) };
    let opened = Opened::open(request, &wanted, options, guard)?;

    let command_line = command_line()?;
    let mut watch = TerminalProgress::new();
    let waiting = WaitingSpinner::for_(form.name);
    let made = match &target {
        Some(_) => Some(document::make(request, &command_line, Words::Program, &mut watch)?),
        None => None,
    };
    let at = Answered { request, results: None, validated: None, call: &command_line, words: Words::Program };
    let files = opened.make(at, &mut watch)?;
    drop((watch, waiting));

    let mut warnings = Vec::new();
    if let (Some(target), Some(made)) = (target, made) {
        target.write(made.bytes.unwrap_or_else(|| made.text.into_bytes()), made.size.as_deref())?;
        if target.is_file() {
            made.notes.iter().for_each(|note| errors::note(note));
        }
        warnings = made.warnings;
    }
    write(&files, &mut warnings)?;
    for warning in &warnings {
        errors::warn(warning);
    }
    Ok(())
}

/// Opens the file of a command before the work.
fn open(path: Option<&Path>, form: Form, guard: &mut Guard) -> Result<Target> {
    let Form { name, in_words, kinds, is_new } = form;
    if let Some(path) = path.filter(|_| kinds == [Kind::Html]) {
        refuse_page_as_figure(path)?;
    }
    let target = Target::open(path, Content { name, in_words, fitting: kinds }, guard)?;
    match path {
        // A file that exists may hold numbers that somebody has written by hand.
        Some(path) if is_new && target.is_file() && path.is_file() => {
            bail!("{} exists and may hold your own numbers: name another file, or remove it", path.display())
        }
        _ => Ok(target),
    }
}

/// Command line of this run, quoted for the shell.
fn command_line() -> Result<String> {
    let arguments: Vec<String> = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let words = std::iter::once("funicular").chain(arguments.iter().map(String::as_str));
    shlex::try_join(words).context("the command line cannot be quoted for the page")
}
