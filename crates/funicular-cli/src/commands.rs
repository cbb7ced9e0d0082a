//! Commands: this file makes the request of a command and runs it. The other files, one per command, read the files
//! that the arguments name, and write the results.

mod analysis;
mod cable;
mod calibrate;
mod check;
mod clearance;
mod compare;
mod design;
mod export;
mod frf;
mod gradient;
mod gust;
mod identify;
mod import;
mod loads;
mod map;
mod merge;
mod modes;
mod new_robot;
mod page;
mod parameters;
mod payload;
mod pose_error;
mod profile_table;
mod reduce;
mod request;
mod result_files;
mod schema;
mod settle;
mod simulate;
mod speeds;
mod statics;
mod stiffness;
mod trajectory;
mod uncertainty;
mod validate;
mod workspace;

use crate::args::{Cli, DrawArgs, DrawModesArgs, FileArgs, OutputArgs, PageArgs, RequestArgs, RunArgs};
use crate::{robot_file, shell, sweep_run};
use anyhow::Result;
use funicular_files::Guard;
use funicular_study::request::{Request, RequestRobot, commands};
use serde_json::Map;

/// Runs a command, or prints its request.
pub(crate) fn run(cli: &Cli) -> Result<()> {
    if shell::printed(cli)? {
        return Ok(());
    }
    if cli.name == "request" {
        let args: RequestArgs = cli.files()?;
        return if cli.print_request { request::print(&request::read(&args.file)?) } else { request::run(&args) };
    }
    let request = request_of(cli)?;
    if cli.print_request {
        return request::print(&request);
    }

    let guard = || robot_file::guard(cli.robot_path().map(|path| &**path));
    let page = || Ok::<_, anyhow::Error>(cli.files::<PageArgs>()?.output_file);
    match &request {
        Request::Statics(_) | Request::Frf(_) | Request::Compare(_) => {
            let DrawArgs { output, figure } = cli.files()?;
            analysis::print_or_draw(&request, &output, figure, None, guard())
        }
        Request::Modes(_) => {
            let DrawModesArgs { drawn, figure_mode } = cli.files()?;
            analysis::print_or_draw(&request, &drawn.output, drawn.figure, figure_mode, guard())
        }
        Request::Uncertainty(of) => uncertainty::run(of, &cli.files()?, &mut guard()),
        Request::Gust(_) => gust::run(&request, &cli.files()?, guard()),
        Request::Settle(of) => settle::run(of, &cli.files()?, guard()),
        Request::Trajectory(of) => trajectory::run(of, &cli.files()?, &mut guard()),
        Request::Simulate(of) => simulate::run(of, &cli.files()?, &mut guard()),
        Request::Reduce(of) => reduce::run(of, &cli.files()?, guard()),
        Request::Identify(of) => identify::run(of, &cli.files()?, &mut guard()),
        Request::Calibrate(of) => calibrate::run(of, &cli.files()?, &mut guard()),
        Request::Design(of) => design::run(of, &cli.files()?, &mut guard()),
        Request::Workspace(of) => workspace::run(of, &cli.files()?, &mut guard()),
        Request::Map(_) => map::run(&request, &cli.files()?, &mut guard()),
        Request::Sweep(_) => sweep_run::run(&request, &mut guard(), &cli.files::<RunArgs>()?),
        Request::Merge(_) => merge::run(&cli.files()?),
        Request::Plot(_) => page::plot(&cli.files()?),
        Request::Live(_) => page::live(&request, cli.robot_path().map(|path| &**path), &page()?),
        Request::Report(_) => page::report(&request, cli.robot_path().map(|path| &**path), &page()?),
        Request::Paper(_) => page::paper(&page()?),
        Request::New(of) => new_robot::run(of, &cli.files()?),
        Request::Schema(of) => schema::write(of, &mut Guard::default(), &cli.files::<FileArgs>()?.output_file),
        Request::Import(of) => import::run(of, &cli.files()?),
        Request::Export(of) => export::run(of, &cli.files()?, &mut guard()),
        _ => analysis::print(&request, &cli.files::<OutputArgs>()?, guard()),
    }
}

/// Request of a command, with the texts of the files that it names.
fn request_of(cli: &Cli) -> Result<Request> {
    let mut further = Map::new();
    let robot = commands().iter().find(|info| info.name == cli.name).map(|info| info.robot);
    if robot.is_some_and(|robot| robot != RequestRobot::None) {
        let robot = robot_file::read(cli.robot_path().map(|path| &**path), &cli.changes()?)?;
        further.insert("robot".to_owned(), serde_json::to_value(robot)?);
    }

    match cli.name.as_str() {
        "uncertainty" => uncertainty::request(cli, further),
        "identify" => identify::request(cli, further),
        "calibrate" => calibrate::request(cli, further),
        "design" => design::request(cli, further),
        "workspace" => workspace::request(cli, further),
        "map" => map::request(cli, further),
        "settle" => settle::request(cli, further),
        "gust" => gust::request(cli, further),
        "trajectory" => trajectory::request(cli, further),
        "simulate" => simulate::request(cli, further),
        "export" => export::request(cli, further),
        "merge" => merge::request(cli, further),
        "plot" => page::plot_request(cli, further),
        "new" => new_robot::request(cli, further),
        "import" => import::request(cli, further),
        _ => cli.request(further),
    }
}
