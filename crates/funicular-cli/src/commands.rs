//! Commands: this file makes the request of a command from the arguments and the files that they name. [`answering`]
//! runs it. The other files, one per command, write the results as text.

mod answering;
mod cable;
mod calibrate;
mod check;
mod clearance;
mod compare;
mod design;
mod estimate;
mod frf;
mod gradient;
mod gust;
mod identify;
mod loads;
mod merge;
mod modes;
mod observability;
mod parameters;
mod payload;
mod pose_error;
mod profile_table;
mod prove;
mod reduce;
mod request;
mod settle;
mod simulate;
mod speeds;
mod statics;
mod stiffness;
mod trajectory;
mod uncertainty;
mod validate;
mod winches;
mod workspace;

use crate::args::{Cli, RequestArgs, RunArgs};
use crate::{errors, shell, sweep_run};
use answering::Asked;
use anyhow::{Context, Result, anyhow};
use funicular::robot::Robot;
use funicular_answers::inputs::{FileKey, FilesRead, read_robot};
use funicular_study::request::{CommandInfo, Request, RequestRobot, RobotText};
use funicular_study::wording::Words;
use serde_json::{Map, Value};
use std::path::PathBuf;

/// Runs a command, or prints its request.
pub(crate) fn run(cli: &Cli) -> Result<()> {
    if shell::printed(cli)? {
        return Ok(());
    }
    let mut read = FilesRead::default();
    let (request, wanted) = match cli.name.as_str() {
        "request" => request::read(&cli.files::<RequestArgs>()?.file, &mut read)?,
        _ => (request_of(cli, &mut read)?, Vec::new()),
    };
    read.notes.iter().for_each(|note| errors::note(note));
    let asked = Asked::of(cli, request.command(), wanted)?;
    if cli.print_request {
        return request::print(&request, &asked.wanted);
    }

    let guard = &mut read.guard();
    match &request {
        Request::Map(_) | Request::Sweep(_) => sweep_run::run(&request, guard, &cli.files::<RunArgs>()?),
        Request::Merge(of) => {
            let to: Option<&PathBuf> = cli.value("output_file");
            merge::run(of, to.context("a request of `merge` needs ⟪output_file⟫, the file of all rows")?)
        }
        _ => answering::run(cli, &request, asked, guard),
    }
}

/// Request of a command, with the values of the files that it names.
fn request_of(cli: &Cli, read: &mut FilesRead) -> Result<Request> {
    let info = cli.info()?;
    let mut keys = cli.keys(info);
    keys.insert("command".to_owned(), info.name.into());
    let mut robot = None;
    if info.robot != RequestRobot::None {
        let path = cli.robot_path().map(|path| &**path);
        let text = read_robot(path, &cli.changes(None), "the robot file", read)?;
        keys.insert("robot".to_owned(), serde_json::to_value(&text)?);
        robot = Some(text);
    }
    add_files(cli, info, robot.as_ref(), &mut keys, read)?;
    if info.name == "identify" {
        keys.insert("experiments".to_owned(), Value::Array(Vec::new()));
    }

    let mut request =
        Request::from_value(Value::Object(keys)).map_err(|error| anyhow!("{}", error.message(Words::Program)))?;
    if let Request::Identify(of) = &mut request {
        identify::complete(of, cli, read)?;
    }
    Ok(request)
}

/// Adds the values of keys that stand in files.
fn add_files(
    cli: &Cli,
    info: &CommandInfo,
    text: Option<&RobotText>,
    keys: &mut Map<String, Value>,
    read: &mut FilesRead,
) -> Result<()> {
    let mut robot: Option<Robot> = None;
    for key in &info.keys {
        let Some(file) = key.file else { continue };
        let paths: Vec<PathBuf> = cli.values(key.name);
        let changes = &cli.changes(Some(key.name));
        if paths.is_empty() {
            // Changes without a file are those of the robot itself.
            if let Some(text) = text.filter(|_| !changes.is_empty()) {
                let changed = RobotText { set: [&text.set[..], changes].concat(), ..text.clone() };
                keys.insert(key.name.to_owned(), serde_json::to_value(changed)?);
            }
            continue;
        }
        if let (None, Some(text)) = (&robot, text) {
            robot = Some(text.read()?.robot);
        }
        let value = FileKey { command: info.name, key: key.name, file, changes }.read(&paths, robot.as_ref(), read)?;
        keys.insert(key.name.to_owned(), value);
    }
    Ok(())
}
