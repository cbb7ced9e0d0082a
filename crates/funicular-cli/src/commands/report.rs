//! `report`: the page of one robot.

use crate::args::ReportArgs;
use crate::commands::frf;
use crate::errors;
use crate::output::{Content, Target};
use crate::page::report::{ReportInput, report};
use crate::page::table::listed;
use crate::progress::Waiting;
use crate::robot_file::{self, RobotFile};
use crate::state;
use anyhow::{Context, Error, Result, bail};
use funicular::math::Vec3;
use funicular::ports::{Input, Output};
use funicular::response::Quantity;
use funicular::robot::Robot;
use std::path::Path;

pub(crate) fn run(args: &ReportArgs) -> Result<()> {
    let path = args.robot.as_deref();
    let RobotFile { robot, name, text } = robot_file::read(path, &args.changes)?;
    let target = Target::open(Some(&args.output_file), Content::PAGE, &mut robot_file::guard(path))?;
    let waiting = Waiting::for_("the robot's figures and tables");
    let (from, to) = response(args, &robot)?;
    if let Some(name) = [(&from.on_cable, &from.name), (&to.on_cable, &to.name)]
        .into_iter()
        .find_map(|(place, name)| place.is_some().then_some(name))
    {
        bail!("{name} is on a cable, and the report's response is the platform's: use `funicular frf` for it");
    }
    let (input, output) = state::directions(&robot, &from, &to, &args.points)?;
    let at_rest = state::equilibrium(robot, &args.state)?;
    let pose = &at_rest.equilibrium.pose;
    let page = report(&ReportInput {
        at_rest: &at_rest,
        file_label: &name,
        robot_text: &text,
        linearisation: state::linearisation(&args.model, at_rest.equilibrium.model),
        below_hz: args.below_hz,
        frf_input: (input_in_words(&from, args.points.input_point_m), input.vector(pose)),
        frf_output: (output_in_words(&to, args.points.output_point_m), output.vector(pose), to.quantity),
        frf_unit: &frf::unit(&from, &to),
        command_line: command_line()?,
    })?;
    drop(waiting);
    write(&target, &args.output_file, &page.html)?;
    page.warnings.iter().for_each(|warning| errors::warn(warning));
    Ok(())
}

/// Input and output of the response: those asked for, else along z, or along x where a guide holds z.
fn response(args: &ReportArgs, robot: &Robot) -> Result<(Input, Output)> {
    const Z: usize = 2;
    let (force, acceleration) =
        if robot.platform.freedoms.components().contains(&Z) { ("fz", "az") } else { ("fx", "ax") };
    let input = args.input.clone().map_or_else(|| Input::parse(force), Ok);
    let output = args.output.clone().map_or_else(|| Output::parse(acceleration), Ok);
    Ok((input.map_err(Error::msg)?, output.map_err(Error::msg)?))
}

/// Writes a page and says so, where it is a file.
pub(crate) fn write(target: &Target, path: &Path, page: &str) -> Result<()> {
    target.write(page.as_bytes())?;
    if target.is_file() {
        errors::note(&format!("wrote {} ({:.1} MB)", path.display(), page.len() as f64 / 1e6));
    }
    Ok(())
}

/// What was typed, quoted for the shell.
pub(crate) fn command_line() -> Result<String> {
    let arguments: Vec<String> = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let words = std::iter::once("funicular").chain(arguments.iter().map(String::as_str));
    shlex::try_join(words).context("the command line cannot be quoted for the page")
}

fn input_in_words(input: &Input, point: Option<Vec3>) -> String {
    let along = axis_in_words(input.direction_w);
    if input.is_moment {
        format!("a moment about {along}")
    } else {
        format!("a force along {along} {}", at("at", point))
    }
}

fn output_in_words(output: &Output, point: Option<Vec3>) -> String {
    let along = axis_in_words(output.direction_w);
    let of_platform = || at("of", point);
    match (output.is_rotation, output.quantity) {
        (false, Quantity::Displacement) => format!("the displacement along {along} {}", of_platform()),
        (false, Quantity::Velocity) => format!("the velocity along {along} {}", of_platform()),
        (false, Quantity::Acceleration) => format!("the acceleration along {along} {}", of_platform()),
        (true, Quantity::Displacement) => format!("the rotation about {along}"),
        (true, Quantity::Velocity) => format!("the angular velocity about {along}"),
        (true, Quantity::Acceleration) => format!("the angular acceleration about {along}"),
    }
}

fn axis_in_words(direction_w: Vec3) -> String {
    let axes = [(Vec3::x(), "x"), (Vec3::y(), "y"), (Vec3::z(), "z")];
    match axes.iter().find(|(axis, _)| *axis == direction_w) {
        Some((_, name)) => (*name).to_owned(),
        None => format!("({})", listed(direction_w.as_slice(), 3)),
    }
}

fn at(preposition: &str, point: Option<Vec3>) -> String {
    match point {
        None => format!("{preposition} the platform origin"),
        Some(point) => format!("{preposition} the platform's point ({}) m", listed(point.as_slice(), 3)),
    }
}
