//! Commands: this file reads the files that the arguments name, makes the request and runs it. The other files, one per
//! command, write the results as text and CSV.

mod cable;
mod check;
mod compare;
mod design;
mod frf;
mod gradient;
mod identify;
mod modes;
mod page;
mod parameters;
mod payload;
mod pose_error;
mod reduce;
mod request;
mod result_files;
mod statics;
mod stiffness;
mod uncertainty;
mod validate;

use crate::args::{
    Cli, Command, DesignArgs, ExportArgs, FigureArgs, ImportArgs, MapArgs, MergeArgs, NewArgs, OutputArgs, ReduceArgs,
    RobotArgs, UncertaintyArgs,
};
use crate::output::{Content, FigureSink, Sink, Target, refuse_without_figure};
use crate::progress::{TerminalProgress, WaitingSpinner};
use crate::table::counted;
use crate::{errors, pose_csv, robot_file, sweep_run};
use anyhow::{Context, Result, bail};
use funicular::robot::Robot;
use funicular_files::Guard;
use funicular_files::endings::Kind;
use funicular_study::analyses;
use funicular_study::export::ExportFormat;
use funicular_study::figures;
use funicular_study::import::SourceFile;
use funicular_study::new_robot;
use funicular_study::request::{self as requests, Request, RobotText};
use funicular_study::robot_file::schema;
use funicular_study::wording::Words;
use funicular_study::{Results, run_on};
use funicular_study::{at_rest, export, import};
use reduce::ModelFile;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Runs a command, or prints its request.
pub(crate) fn run(cli: &Cli) -> Result<()> {
    if cli.print_request {
        return request::print(&request_of(&cli.command)?);
    }
    match &cli.command {
        Command::Request(args) => request::run(args),
        Command::Map(args) => {
            let mut guard = robot_file::guard(Some(&args.robot.robot));
            if let Some(poses) = &args.poses {
                guard.reads("the poses", poses);
            }
            sweep_run::run(&request_of(&cli.command)?, &mut guard, &args.run)
        }
        Command::Sweep(args) => {
            let mut guard = robot_file::guard(Some(&args.robot.robot));
            sweep_run::run(&request_of(&cli.command)?, &mut guard, &args.run)
        }
        Command::Merge(args) => merge(args),
        Command::Plot(args) => page::plot(args),
        Command::Live(args) => page::live(&request_of(&cli.command)?, args.robot.robot.as_deref(), &args.output_file),
        Command::Report(args) => {
            page::report(&request_of(&cli.command)?, args.robot.robot.as_deref(), &args.output_file)
        }
        Command::Paper(args) => page::paper(&args.output_file),
        Command::New(args) => {
            let mut guard = Guard::default();
            if let Some(table) = &args.from_csv {
                guard.reads("the table of points", table);
            }
            write_new(&new_request(args)?, &mut guard, &args.output_file)
        }
        Command::Schema(args) => write_schema(&mut Guard::default(), &args.output_file),
        Command::Import(args) => import(args),
        Command::Export(args) => export(&request_of(&cli.command)?, args),
        Command::Reduce(args) => reduce(&request_of(&cli.command)?, args),
        Command::Identify(args) => identify::run(&request_of(&cli.command)?, args),
        Command::Design(args) => design::run(&request_of(&cli.command)?, args),
        Command::Check(args) | Command::Parameters(args) => {
            analyse(&request_of(&cli.command)?, &args.output, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::Statics(args) => {
            let guard = robot_file::guard(Some(&args.robot.robot));
            analyse_or_draw(&request_of(&cli.command)?, &args.output, args.figure, None, guard)
        }
        Command::Stiffness(args) => {
            analyse(&request_of(&cli.command)?, &args.output, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::Modes(args) => {
            let guard = robot_file::guard(Some(&args.robot.robot));
            analyse_or_draw(&request_of(&cli.command)?, &args.sink, args.figure, args.figure_mode, guard)
        }
        Command::Frf(args) => {
            let guard = robot_file::guard(Some(&args.robot.robot));
            analyse_or_draw(&request_of(&cli.command)?, &args.sink, args.figure, None, guard)
        }
        Command::Compare(args) => {
            let guard = robot_file::guard(Some(&args.robot.robot));
            analyse_or_draw(&request_of(&cli.command)?, &args.output, args.figure, None, guard)
        }
        Command::Gradient(args) => {
            analyse(&request_of(&cli.command)?, &args.sink, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::Uncertainty(args) => {
            let Request::Uncertainty(of) = request_of(&cli.command)? else {
                bail!("this is not a request of `uncertainty`")
            };
            let mut guard = robot_file::guard(Some(&args.robot.robot));
            if let Some(poses) = &args.poses {
                guard.reads("the poses", poses);
            }
            uncertainty::run(&of, args, &mut guard)
        }
        Command::Payload(args) => {
            analyse(&request_of(&cli.command)?, &args.output, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::PoseError(args) => {
            analyse(&request_of(&cli.command)?, &args.output, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::Cable(args) => {
            analyse(&request_of(&cli.command)?, &args.output, robot_file::guard(Some(&args.robot.robot)))
        }
        Command::Validate(args) => analyse(&request_of(&cli.command)?, &args.output, Guard::default()),
    }
}

/// Request of a command, with the texts of the files that it names.
fn request_of(command: &Command) -> Result<Request> {
    let robot = |args: &RobotArgs| robot_file::read(Some(&args.robot), &args.changes);
    Ok(match command {
        Command::Check(args) => Request::Check(requests::CheckRequest { robot: robot(&args.robot)? }),
        Command::Parameters(args) => Request::Parameters(requests::ParametersRequest { robot: robot(&args.robot)? }),
        Command::Statics(args) => Request::Statics(args.request(robot(&args.robot)?)),
        Command::Stiffness(args) => Request::Stiffness(args.request(robot(&args.robot)?)),
        Command::Modes(args) => Request::Modes(args.request(robot(&args.robot)?)),
        Command::Frf(args) => Request::Frf(args.request(robot(&args.robot)?)),
        Command::Compare(args) => Request::Compare(args.request(robot(&args.robot)?)),
        Command::Gradient(args) => Request::Gradient(args.request(robot(&args.robot)?)),
        Command::Uncertainty(args) => Request::Uncertainty(uncertainty_request(args, robot(&args.robot)?)?),
        Command::Payload(args) => Request::Payload(args.request(robot(&args.robot)?)),
        Command::PoseError(args) => Request::PoseError(args.request(robot(&args.robot)?)),
        Command::Cable(args) => Request::Cable(args.request(robot(&args.robot)?)),
        Command::Reduce(args) => Request::Reduce(args.request(robot(&args.robot)?)),
        Command::Identify(args) => Request::Identify(identify::request(args, robot(&args.robot)?)?),
        Command::Design(args) => Request::Design(design_request(args, robot(&args.robot)?)?),
        Command::Map(args) => Request::Map(map_request(args, robot(&args.robot)?)?),
        Command::Sweep(args) => Request::Sweep(args.request(robot(&args.robot)?)),
        Command::Merge(args) => Request::Merge(args.request()),
        Command::Plot(args) => Request::Plot(args.request()),
        Command::Report(args) => {
            Request::Report(args.request(robot_file::read(args.robot.robot.as_deref(), &args.robot.changes)?))
        }
        Command::Live(args) => {
            Request::Live(args.request(robot_file::read(args.robot.robot.as_deref(), &args.robot.changes)?))
        }
        Command::Paper(_) => Request::Paper(requests::PaperRequest {}),
        Command::New(args) => Request::New(new_request(args)?),
        Command::Schema(_) => Request::Schema(requests::SchemaRequest {}),
        Command::Import(args) => Request::Import(args.request(sources(&args.files)?)),
        Command::Export(args) => Request::Export(args.request(robot(&args.robot)?)),
        Command::Validate(_) => Request::Validate(requests::ValidateRequest {}),
        Command::Request(args) => request::read(&args.file)?,
    })
}

/// Request of a map. Errors of its poses name the line in the file of poses.
fn map_request(args: &MapArgs, robot: RobotText) -> Result<requests::MapRequest> {
    let poses = match &args.poses {
        Some(path) => Some(pose_csv::read(path, &robot.read()?.robot)?),
        None => None,
    };
    Ok(args.request(robot, poses))
}

/// Request of a design. Errors of its poses name the line in the file of poses.
fn design_request(args: &DesignArgs, robot: RobotText) -> Result<requests::DesignRequest> {
    let poses = match &args.poses {
        Some(path) => Some(pose_csv::read(path, &robot.read()?.robot)?),
        None => None,
    };
    Ok(args.request(robot, poses))
}

/// Request of `uncertainty`, with the poses of its file.
fn uncertainty_request(args: &UncertaintyArgs, robot: RobotText) -> Result<requests::UncertaintyRequest> {
    let poses = match &args.poses {
        Some(path) => Some(pose_csv::read(path, &robot.read()?.robot)?),
        None => None,
    };
    Ok(args.request(robot, poses))
}

/// Runs a request whose results are printed, or drawn if the ending of the file means a figure.
fn analyse_or_draw(
    request: &Request,
    output: &OutputArgs,
    figure: FigureArgs,
    mode: Option<usize>,
    mut guard: Guard,
) -> Result<()> {
    let others: &[Kind] = match request {
        Request::Statics(_) | Request::Compare(_) => &[Kind::Svg, Kind::Pdf],
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
fn analyse(request: &Request, output: &OutputArgs, mut guard: Guard) -> Result<()> {
    let robot = request.robot().map(RobotText::read).transpose()?.map(|file| file.robot);
    print_results(request, robot, &Sink::open(output, &[], &mut guard)?)
}

fn print_results(request: &Request, robot: Option<Robot>, sink: &Sink) -> Result<()> {
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
        Results::Compare(found) => sink.write(found),
        Results::Gradient(found) => sink.write(found),
        Results::Uncertainty(found) => sink.write(found),
        Results::Payload(found) => sink.write(found),
        Results::PoseError(found) => sink.write(found),
        Results::Cable(found) => sink.write(found),
        Results::Reduce(found) => sink.write(found),
        Results::Identify(found) => sink.write(&**found),
        Results::Design(found) => sink.write(&**found),
        Results::Validate(found) => {
            sink.write(found)?;
            Ok(found.verdict()?)
        }
    }
}

/// Runs `reduce`: prints the model and writes its matrices to files.
fn reduce(request: &Request, args: &ReduceArgs) -> Result<()> {
    let Request::Reduce(of) = request else { bail!("this is not a request of `reduce`") };
    let robot = of.robot.read()?.robot;
    let mut guard = robot_file::guard(Some(&args.robot.robot));
    let sink = Sink::open(&args.sink, &[], &mut guard)?;
    let file = args.matrices.as_deref().map(|path| ModelFile::open(path, &mut guard)).transpose()?;

    let mut watch = TerminalProgress::new();
    let mut found = analyses::reduce::run(robot, of, &mut watch)?;
    drop(watch);
    found.set_matrices_file(args.matrices.as_ref().map(|path| path.display().to_string()));
    if let Some(file) = file {
        file.write(&found)?;
    }
    sink.write(&found)
}

/// Combines parts in one file.
fn merge(args: &MergeArgs) -> Result<()> {
    let rows = funicular_files::merge(&args.parts, &args.output_file)?;
    errors::note(&format!("{} in {}", counted(rows, "row"), args.output_file.display()));
    Ok(())
}

/// Request of a new robot, with the table that it names.
fn new_request(args: &NewArgs) -> Result<requests::NewRequest> {
    let table = match &args.from_csv {
        Some(path) => sources(std::slice::from_ref(path))?.pop(),
        None => None,
    };
    Ok(args.request(table))
}

/// Writes a new robot file. An existing file may hold numbers that somebody has written by hand, so it is never replaced.
fn write_new(request: &requests::NewRequest, guard: &mut Guard, path: &Path) -> Result<()> {
    let content = Content { name: "the robot file", option: "-o", in_words: "a robot file", fitting: &[Kind::Toml] };
    let target = Target::open(Some(path), content, guard)?;
    if target.is_file() && path.is_file() {
        bail!("{} exists and may hold your own numbers: name another file, or remove it", path.display());
    }
    let made = new_robot::run(request, Words::Program)?;
    target.write(made.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    made.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

/// Writes the JSON Schema of the robot file.
fn write_schema(guard: &mut Guard, path: &Path) -> Result<()> {
    let content = Content { name: "the schema", option: "-o", in_words: "a JSON Schema", fitting: &[Kind::Json] };
    let target = Target::open(Some(path), content, guard)?;
    target.write(schema::text().as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    Ok(())
}

/// Converts files of other programs to a robot file.
fn import(args: &ImportArgs) -> Result<()> {
    let request = args.request(sources(&args.files)?);
    let mut guard = Guard::default();
    for source in &args.files {
        guard.reads("the source file", source);
    }
    write_import(&request, &mut guard, &args.output_file)
}

fn write_import(request: &requests::ImportRequest, guard: &mut Guard, path: &Path) -> Result<()> {
    let content = Content { name: "the robot file", option: "-o", in_words: "a robot file", fitting: &[Kind::Toml] };
    let target = Target::open(Some(path), content, guard)?;
    let imported = import::run(request, Words::Program)?;
    target.write(imported.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    for assumed in &imported.assumed {
        errors::warn(&format!("assumed: {assumed}"));
    }
    for lost in &imported.lost {
        errors::warn(&format!("not carried over: {lost}"));
    }
    Ok(())
}

/// Reads the files of another program as text.
fn sources(paths: &[PathBuf]) -> Result<Vec<SourceFile>> {
    let read = |path: &PathBuf| {
        let shown = path.display().to_string();
        if path.is_dir() {
            bail!("cannot read {shown}: it is a directory; name the files in it");
        }
        let file = File::open(path).with_context(|| format!("cannot read {shown}"))?;
        let mut bytes = Vec::new();
        // One byte is read beyond the limit, which shows that a file is too large.
        file.take(import::MAX_BYTES as u64 + 1)
            .read_to_end(&mut bytes)
            .with_context(|| format!("cannot read {shown}"))?;
        SourceFile::decode(shown, &bytes)
    };
    paths.iter().map(read).collect()
}

/// Writes the robot at its equilibrium as a file of another program.
fn export(request: &Request, args: &ExportArgs) -> Result<()> {
    let Request::Export(of) = request else { bail!("this is not a request of `export`") };
    let robot = of.robot.read()?.robot;
    write_export(of, robot, &mut robot_file::guard(Some(&args.robot.robot)), &args.output_file)
}

fn write_export(of: &requests::ExportRequest, robot: Robot, guard: &mut Guard, path: &Path) -> Result<()> {
    let (in_words, fitting): (_, &[Kind]) = match of.to {
        ExportFormat::Opensees => ("a Python script for OpenSees", &[Kind::Python]),
        ExportFormat::Moordyn => ("an input file of MoorDyn", &[Kind::Text]),
        ExportFormat::Vtk => ("curves and polygons of VTK", &[Kind::Vtp]),
    };
    let content = Content { name: "the exported robot", option: "-o", in_words, fitting };
    let target = Target::open(Some(path), content, guard)?;
    export::refuse(of)?;
    let at_rest = at_rest::equilibrium(robot, &of.robot, &of.state, &of.tensions)?;
    let exported = export::run(&at_rest, of)?;
    target.write(exported.text.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {}", path.display()));
    }
    exported.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}
