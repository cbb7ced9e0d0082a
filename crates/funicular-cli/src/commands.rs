//! Commands: this file makes the request of a command and runs it. The other files, one per command, read the files
//! that the arguments name, and write the results.

mod analysis;
mod cable;
mod check;
mod compare;
mod design;
mod export;
mod frf;
mod gradient;
mod identify;
mod import;
mod map;
mod merge;
mod modes;
mod new_robot;
mod page;
mod parameters;
mod payload;
mod pose_error;
mod reduce;
mod request;
mod result_files;
mod schema;
mod statics;
mod stiffness;
mod sweep;
mod uncertainty;
mod validate;

use crate::args::{Cli, Command, FigureArgs, OptionalRobotArgs, OutputArgs, RobotArgs};
use crate::robot_file;
use anyhow::Result;
use funicular_files::Guard;
use funicular_study::request::{self as requests, Request};

/// Runs a command, or prints its request.
pub(crate) fn run(cli: &Cli) -> Result<()> {
    let request = || request_of(&cli.command);
    if cli.print_request {
        return request::print(&request()?);
    }

    let print = |robot: &RobotArgs, output: &OutputArgs| {
        analysis::print(&request()?, output, robot_file::guard(Some(&robot.robot)))
    };
    let draw = |robot: &RobotArgs, output: &OutputArgs, figure: FigureArgs, mode: Option<usize>| {
        analysis::print_or_draw(&request()?, output, figure, mode, robot_file::guard(Some(&robot.robot)))
    };
    match &cli.command {
        Command::Check(args) | Command::Parameters(args) => print(&args.robot, &args.output),
        Command::Statics(args) => draw(&args.robot, &args.output, args.figure, None),
        Command::Stiffness(args) => print(&args.robot, &args.output),
        Command::Modes(args) => draw(&args.robot, &args.sink, args.figure, args.figure_mode),
        Command::Frf(args) => draw(&args.robot, &args.sink, args.figure, None),
        Command::Compare(args) => draw(&args.robot, &args.output, args.figure, None),
        Command::Gradient(args) => print(&args.robot, &args.sink),
        Command::Payload(args) => print(&args.robot, &args.output),
        Command::PoseError(args) => print(&args.robot, &args.output),
        Command::Cable(args) => print(&args.robot, &args.output),
        Command::Validate(args) => analysis::print(&request()?, &args.output, Guard::default()),

        Command::Uncertainty(args) => uncertainty::run(&request()?, args),
        Command::Reduce(args) => reduce::run(&request()?, args),
        Command::Identify(args) => identify::run(&request()?, args),
        Command::Design(args) => design::run(&request()?, args),
        Command::Map(args) => map::run(&request()?, args),
        Command::Sweep(args) => sweep::run(&request()?, args),
        Command::Merge(args) => merge::run(args),

        Command::Plot(args) => page::plot(args),
        Command::Live(args) => page::live(&request()?, args.robot.robot.as_deref(), &args.output_file),
        Command::Report(args) => page::report(&request()?, args.robot.robot.as_deref(), &args.output_file),
        Command::Paper(args) => page::paper(&args.output_file),

        Command::New(args) => new_robot::run(args),
        Command::Schema(args) => schema::write(&mut Guard::default(), &args.output_file),
        Command::Import(args) => import::run(args),
        Command::Export(args) => export::run(&request()?, args),
        Command::Request(args) => request::run(args),
    }
}

/// Request of a command, with the texts of the files that it names.
fn request_of(command: &Command) -> Result<Request> {
    let robot = |args: &RobotArgs| robot_file::read(Some(&args.robot), &args.changes);
    let optional = |args: &OptionalRobotArgs| robot_file::read(args.robot.as_deref(), &args.changes);
    Ok(match command {
        Command::Check(args) => Request::Check(requests::CheckRequest { robot: robot(&args.robot)? }),
        Command::Parameters(args) => Request::Parameters(requests::ParametersRequest { robot: robot(&args.robot)? }),
        Command::Statics(args) => Request::Statics(args.request(robot(&args.robot)?)),
        Command::Stiffness(args) => Request::Stiffness(args.request(robot(&args.robot)?)),
        Command::Modes(args) => Request::Modes(args.request(robot(&args.robot)?)),
        Command::Frf(args) => Request::Frf(args.request(robot(&args.robot)?)),
        Command::Compare(args) => Request::Compare(args.request(robot(&args.robot)?)),
        Command::Gradient(args) => Request::Gradient(args.request(robot(&args.robot)?)),
        Command::Uncertainty(args) => Request::Uncertainty(uncertainty::request(args, robot(&args.robot)?)?),
        Command::Payload(args) => Request::Payload(args.request(robot(&args.robot)?)),
        Command::PoseError(args) => Request::PoseError(args.request(robot(&args.robot)?)),
        Command::Cable(args) => Request::Cable(args.request(robot(&args.robot)?)),
        Command::Reduce(args) => Request::Reduce(args.request(robot(&args.robot)?)),
        Command::Identify(args) => Request::Identify(identify::request(args, robot(&args.robot)?)?),
        Command::Design(args) => Request::Design(design::request(args, robot(&args.robot)?)?),
        Command::Map(args) => Request::Map(map::request(args, robot(&args.robot)?)?),
        Command::Sweep(args) => Request::Sweep(args.request(robot(&args.robot)?)),
        Command::Merge(args) => Request::Merge(args.request()),
        Command::Plot(args) => Request::Plot(args.request()),
        Command::Report(args) => Request::Report(args.request(optional(&args.robot)?)),
        Command::Live(args) => Request::Live(args.request(optional(&args.robot)?)),
        Command::Paper(_) => Request::Paper(requests::PaperRequest {}),
        Command::New(args) => Request::New(new_robot::request(args)?),
        Command::Schema(_) => Request::Schema(requests::SchemaRequest {}),
        Command::Import(args) => Request::Import(args.request(import::sources(&args.files)?)),
        Command::Export(args) => Request::Export(args.request(robot(&args.robot)?)),
        Command::Validate(_) => Request::Validate(requests::ValidateRequest {}),
        Command::Request(args) => request::read(&args.file)?,
    })
}
