//! The program `funicular`: a robot file and options in, one result out.

mod args;
mod commands;
mod errors;
mod export;
mod grid;
mod import;
mod json;
mod output;
mod page;
mod poses;
mod progress;
mod robot_file;
mod state;
mod sweeping;
mod table;
mod validation;

use anyhow::Result;
use args::{Cli, Command, OutputArgs, RobotArgs, ValidateArgs};
use clap::Parser;
use funicular::robot::Robot;
use funicular_files::Guard;
use output::{Results, Sink};
use std::io::{self, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => match run(&cli.command) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => errors::report(&error),
        },
        Err(usage) => tell(&usage),
    }
}

/// Prints help or the version, which were asked for, to standard output; what is wrong with the command line to stderr.
fn tell(usage: &clap::Error) -> ExitCode {
    let printed = usage.print().and_then(|()| io::stdout().flush());
    match printed {
        // Help for a closed pipe is help for nobody, and so is a message to a closed stderr.
        Err(error) if !usage.use_stderr() => errors::report(&output::of_stdout(error)),
        _ => ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2)),
    }
}

fn run(command: &Command) -> Result<()> {
    match command {
        Command::Check(args) => steps(&args.robot, &args.output, |robot| Ok(commands::check::run(robot))),
        Command::Statics(args) => steps(&args.robot, &args.output, |robot| commands::statics::run(robot, args)),
        Command::Stiffness(args) => steps(&args.robot, &args.output, |robot| commands::stiffness::run(robot, args)),
        Command::Modes(args) => steps(&args.robot, &args.sink, |robot| commands::modes::run(robot, args)),
        Command::Frf(args) => steps(&args.robot, &args.sink, |robot| commands::frf::run(robot, args)),
        Command::Compare(args) => steps(&args.robot, &args.output, |robot| commands::compare::run(robot, args)),
        Command::PoseError(args) => steps(&args.robot, &args.output, |robot| commands::pose_error::run(&robot, args)),
        Command::Cable(args) => steps(&args.robot, &args.output, |robot| commands::cable::run(robot, args)),
        Command::Reduce(args) => {
            guarded_steps(&args.robot, &args.sink, |robot, guard| commands::reduce::run(robot, args, guard))
        }
        Command::Map(args) => commands::map::run(args),
        Command::Sweep(args) => commands::sweep::run(args),
        Command::Merge(args) => commands::merge::run(args),
        Command::Plot(args) => commands::plot::run(args),
        Command::Report(args) => commands::report::run(args),
        Command::Paper(args) => commands::paper::run(args),
        Command::Import(args) => commands::import::run(args),
        Command::Export(args) => commands::export::run(args),
        Command::Validate(args) => validate(args),
    }
}

/// What every command does that prints a result.
fn steps<R: Results>(robot: &RobotArgs, output: &OutputArgs, analyse: impl FnOnce(Robot) -> Result<R>) -> Result<()> {
    guarded_steps(robot, output, |robot, _| analyse(robot))
}

/// The steps of a command that writes other files, too.
fn guarded_steps<R: Results>(
    robot: &RobotArgs,
    output: &OutputArgs,
    analyse: impl FnOnce(Robot, &mut Guard) -> Result<R>,
) -> Result<()> {
    let file = robot_file::read(Some(&robot.robot), &robot.changes)?;
    let mut guard = robot_file::guard(Some(&robot.robot));
    let sink = Sink::open(output, &mut guard)?;
    let results = analyse(file.robot, &mut guard)?;
    sink.write(&results)
}

/// The command without a robot.
fn validate(args: &ValidateArgs) -> Result<()> {
    let sink = Sink::open(&args.output, &mut Guard::default())?;
    let results = commands::validate::run()?;
    sink.write(&results)?;
    results.verdict()
}
