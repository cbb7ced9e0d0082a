//! Commands whose results are printed or drawn: how they run. Their text and CSV are in the file of each command.

use super::validate;
use crate::args::{FigureArgs, OutputArgs};
use crate::errors;
use crate::output::{FigureSink, Sink, refuse_without_figure};
use crate::progress::{TerminalProgress, WaitingSpinner};
use anyhow::{Context, Result};
use funicular::robot::Robot;
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_pages::figures;
use funicular_study::request::{Request, RobotText};
use funicular_study::{Results, run_on};

/// Runs a request whose results are printed, or drawn if the ending of the file means a figure.
pub(super) fn print_or_draw(
    request: &Request,
    output: &OutputArgs,
    figure: FigureArgs,
    mode: Option<usize>,
    mut guard: Guard,
) -> Result<()> {
    let others: &[Kind] = match request {
        Request::Statics(_) | Request::Gust(_) | Request::Compare(_) => &[Kind::Svg, Kind::Pdf],
        Request::Modes(_) | Request::Frf(_) => &[Kind::Svg, Kind::Pdf, Kind::Uff],
        _ => &[],
    };
    // Errors of the robot file are reported before errors of the destination.
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    // With --format the result is printed, and an ending that means a figure is refused.
    let path = output.output_file.as_deref().filter(|_| !others.is_empty() && output.format.is_none());
    let Some(sink) = FigureSink::open(path, figure, &mut guard)? else {
        refuse_without_figure(mode.is_some(), "figure_mode")?;
        return print_results(request, robot, &Sink::open(output, others, &mut guard)?);
    };

    let robot = robot.context("a figure needs a robot")?;
    let mut watch = TerminalProgress::new();
    let waiting = WaitingSpinner::for_("the figure");
    let made = figures::of_request(request, robot, &figures::FigureChoice { mode }, &mut watch)?;
    drop((watch, waiting));
    sink.write(&made.figure)?;
    made.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

/// Runs a request whose results are printed.
pub(super) fn print(request: &Request, output: &OutputArgs, mut guard: Guard) -> Result<()> {
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    print_results(request, robot, &Sink::open(output, &[], &mut guard)?)
}

fn print_results(request: &Request, robot: Option<Robot>, sink: &Sink) -> Result<()> {
    if matches!(request, Request::Validate(_)) {
        return validate::print(sink);
    }
    let mut watch = TerminalProgress::new();
    let waiting = matches!(request, Request::Statics(_)).then(|| WaitingSpinner::for_("the equilibrium"));
    let results = run_on(request, robot, &mut watch)?;
    drop((watch, waiting));

    match &results {
        Results::Check(found) => sink.write(found),
        Results::Parameters(found) => sink.write(found),
        Results::Statics(found) => sink.write(found),
        Results::Stiffness(found) => sink.write(found),
        Results::Modes(found) => sink.write(found),
        Results::Frf(found) => sink.write(found),
        Results::Settle(found) => sink.write(found),
        Results::Trajectory(found) => sink.write(found),
        Results::Gust(found) => sink.write(found),
        Results::Compare(found) => sink.write(found),
        Results::Gradient(found) => sink.write(found),
        Results::Uncertainty(found) => sink.write(found),
        Results::Payload(found) => sink.write(found),
        Results::Loads(found) => sink.write(found),
        Results::Speeds(found) => sink.write(found),
        Results::Simulate(found) => sink.write(&**found),
        Results::Clearance(found) => sink.write(found),
        Results::PoseError(found) => sink.write(found),
        Results::Cable(found) => sink.write(found),
        Results::Reduce(found) => sink.write(found),
        Results::Identify(found) => sink.write(&**found),
        Results::Calibrate(found) => sink.write(&**found),
        Results::Workspace(found) => sink.write(&**found),
        Results::Design(found) => sink.write(&**found),
    }
}
