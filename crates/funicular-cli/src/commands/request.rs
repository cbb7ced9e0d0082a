//! `request`: runs a request in JSON. Also prints the request of any command.

use super::{analysis, export, import, merge, new_robot, page, reduce, schema, uncertainty, workspace};
use crate::args::{OutputArgs, PlotArgs, RequestArgs};
use crate::output;
use crate::sweep_run;
use anyhow::{Context, Result, bail};
use funicular_files::Guard;
use funicular_study::request::Request;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Maximum size of a request [bytes]: a list of a million poses takes some 100 MB.
const MAX_BYTES: u64 = 1 << 30;

/// Reads a request; `-` is standard input.
pub(crate) fn read(path: &Path) -> Result<Request> {
    let shown = if path.as_os_str() == "-" { "<stdin>".to_owned() } else { path.display().to_string() };
    let cannot = || format!("cannot read the request {shown}");
    let mut source: Box<dyn Read> = match path.as_os_str().to_str() {
        Some("-") => Box::new(io::stdin().lock()),
        _ => Box::new(fs::File::open(path).with_context(cannot)?),
    };

    // One byte more than the maximum shows that there are more.
    let mut text = String::new();
    source.by_ref().take(MAX_BYTES + 1).read_to_string(&mut text).with_context(cannot)?;
    if text.len() as u64 > MAX_BYTES {
        bail!("{shown} has more than {} MB: no request is that large; choose another file", MAX_BYTES >> 20);
    }
    Request::from_json(&text).context(shown)
}

/// Prints a request as JSON.
pub(crate) fn print(request: &Request) -> Result<()> {
    let mut out = io::stdout().lock();
    let text = serde_json::to_string_pretty(&request.to_value())?;
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(output::of_stdout)
}

/// Runs the request of a file.
pub(crate) fn run(args: &RequestArgs) -> Result<()> {
    let request = read(&args.file)?;
    if args.matrices.is_some() && !matches!(request, Request::Reduce(_)) {
        bail!("⟪matrices⟫ belongs to a request of `reduce`, and this is one of `{}`: leave it out", request.command());
    }
    let mut guard = Guard::default();

    if args.file.as_os_str() != "-" {
        guard.reads("the request", &args.file);
    }

    let output = || OutputArgs { format: args.run.format, output_file: args.run.output_file.clone() };
    let place = || args.run.output_file.clone().unwrap_or_else(|| "-".into());

    match &request {
        Request::Map(_) | Request::Sweep(_) => sweep_run::run(&request, &mut guard, &args.run),
        Request::Uncertainty(of) => uncertainty::print(of, &output(), &mut guard),
        Request::Workspace(of) => workspace::print(of, &output(), &mut guard),
        Request::Report(_) => page::report(&request, Some(&args.file), &place()),
        Request::Live(_) => page::live(&request, Some(&args.file), &place()),
        Request::Paper(_) => page::paper(&place()),
        Request::New(of) => new_robot::write(of, &mut guard, &place()),
        Request::Schema(of) => schema::write(of, &mut guard, &place()),
        Request::Import(of) => import::write(of, &mut guard, &place()),
        Request::Export(of) => {
            let robot = of.robot.read()?.robot;
            export::write(of, robot, &mut guard, &place())
        }
        Request::Reduce(of) => reduce::print(of, &output(), args.matrices.as_deref(), guard),
        Request::Merge(of) => {
            let parts: Vec<PathBuf> = of.parts.iter().map(PathBuf::from).collect();
            let to = args.run.output_file.as_deref();
            merge::write(&parts, to.context("a request of `merge` needs ⟪output_file⟫, the file of all rows")?)
        }
        Request::Plot(of) => page::plot(&PlotArgs {
            file: PathBuf::from(&of.file),
            output_file: args.run.output_file.clone(),
            figure: args.figure,
            quantity: None,
            plane: None,
            at: Vec::new(),
        }),
        _ => analysis::print_or_draw(&request, &output(), args.figure, args.figure_mode, guard),
    }
}
