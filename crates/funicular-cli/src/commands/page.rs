//! HTML pages: `report`, `live`, `paper`, `plot`.

use crate::args::{Cli, PlotArgs};
use crate::errors;
use crate::output::{Content, FigureSink, Target, refuse_page_as_figure, refuse_without_figure};
use crate::progress::{TerminalProgress, WaitingSpinner};
use crate::robot_file;
use anyhow::{Context, Result, bail};
use funicular_files::{Guard, SweepFile};
use funicular_pages::pages;
use funicular_study::Request;
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::path::Path;

/// Writes the page of one robot.
pub(crate) fn report(request: &Request, robot_path: Option<&Path>, output: &Path) -> Result<()> {
    let Request::Report(of) = request else { bail!("this is not a request of `report`") };
    let file = of.robot.read()?;
    refuse_page_as_figure(output)?;
    let target = Target::open(Some(output), Content::PAGE, &mut robot_file::guard(robot_path))?;
    let waiting = WaitingSpinner::for_("the robot's figures and tables");
    let page = pages::report::of_request(of, file, command_line()?)?;
    drop(waiting);
    write(&target, output, &page.html)?;
    page.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

/// Writes the page on which a robot can be moved.
pub(crate) fn live(request: &Request, robot_path: Option<&Path>, output: &Path) -> Result<()> {
    let Request::Live(of) = request else { bail!("this is not a request of `live`") };
    refuse_page_as_figure(output)?;
    let target = Target::open(Some(output), Content::PAGE, &mut robot_file::guard(robot_path))?;
    // The page words its messages itself.
    let page = pages::live::live(of)?;
    target.write(page.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {} ({:.1} MB)", output.display(), page.len() as f64 / 1e6));
    }
    Ok(())
}

/// Writes the page about Yuan et al. 2014.
pub(crate) fn paper(output: &Path) -> Result<()> {
    refuse_page_as_figure(output)?;
    let target = Target::open(Some(output), Content::PAGE, &mut Guard::default())?;
    let waiting = WaitingSpinner::for_("the paper's figures and tables");
    let page = pages::paper::paper(command_line()?)?;
    drop(waiting);
    write(&target, output, &page)
}

/// Request with the path of the file of a map or sweep.
pub(crate) fn plot_request(cli: &Cli, mut further: Map<String, Value>) -> Result<Request> {
    let file = cli.files::<PlotArgs>()?.file.display().to_string();
    further.insert("file".to_owned(), file.into());
    cli.request(further)
}

/// Writes the page of a map or sweep, or one figure of it.
pub(crate) fn plot(args: &PlotArgs) -> Result<()> {
    let file = SweepFile::open(&args.file)?;
    let to = args.output_file.clone().unwrap_or_else(|| args.file.with_extension("html"));
    let mut guard = Guard::default();
    guard.reads("the rows in", &args.file);

    if let Some(sink) = FigureSink::open(Some(&to), args.figure, &mut guard)? {
        let choice = pages::plot::SweepFigureChoice {
            quantity: args.quantity.clone(),
            plane: args.plane.clone().map(|plane| plane.0),
            at: args.at.clone(),
        };
        let made = pages::plot::figure(&file, &args.file.display().to_string(), &choice)?;
        sink.write(&made.figure)?;
        made.notes.iter().for_each(|note| errors::note(note));
        return Ok(());
    }
    refuse_without_figure(args.quantity.is_some(), "quantity")?;
    refuse_without_figure(args.plane.is_some(), "plane")?;
    refuse_without_figure(!args.at.is_empty(), "at")?;
    let target = Target::open(Some(&to), Content::PAGE, &mut guard)?;
    let (mut watch, waiting) = (TerminalProgress::new(), WaitingSpinner::for_("the figures"));
    let page = pages::plot::plot(&file, args.file.display().to_string(), command_line()?, &mut watch)?;
    drop((watch, waiting));
    write(&target, &to, &page.html)?;
    page.notes.iter().for_each(|note| errors::warn(note));
    Ok(())
}

/// Writes a page, and a note if it is a file.
fn write(target: &Target, path: &Path, page: &str) -> Result<()> {
    let page = worded(page, Words::Program);
    target.write(page.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {} ({:.1} MB)", path.display(), page.len() as f64 / 1e6));
    }
    Ok(())
}

/// Command line of this run, quoted for the shell.
pub(super) fn command_line() -> Result<String> {
    let arguments: Vec<String> = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let words = std::iter::once("funicular").chain(arguments.iter().map(String::as_str));
    shlex::try_join(words).context("the command line cannot be quoted for the page")
}
