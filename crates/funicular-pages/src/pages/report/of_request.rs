//! Report of a request: the robot at its state, with a default response if none is requested.

use super::{Report, ReportInput, report};
use crate::pages::table::listed;
use anyhow::{Result, anyhow};
use funicular::math::Vec3;
use funicular::response::{Quantity, Signal};
use funicular::robot::Robot;
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request;
use funicular_study::robot_file::RobotFile;
use funicular_study::signals::{Input, Output, Place, response_unit};

/// Writes the page of a request for a robot file; `command_line` is the command that writes it again.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without this equilibrium, or no finite response there.
pub fn of_request(request: &request::ReportRequest, file: RobotFile, command_line: String) -> Result<Report> {
    request.check()?;
    let RobotFile { robot, name, text } = file;
    // Invalid signals are refused before the computation.
    let (from, to) = response(request, &robot)?;
    at_rest::signals(&robot, &from, &to, &request.points)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    about(&at_rest, request, &name, &text, command_line)
}

/// Writes the page of a robot at a known equilibrium; the state in the request is ignored. `name` and `text` are those
/// of the robot file.
///
/// # Errors
/// The errors of [`of_request`].
pub fn about(
    at_rest: &AtRest,
    request: &request::ReportRequest,
    name: &str,
    text: &str,
    command_line: String,
) -> Result<Report> {
    request.check()?;

    let (from, to) = response(request, &at_rest.robot)?;
    let [input, output] = at_rest::signals(&at_rest.robot, &from, &to, &request.points)?;

    let vector = |signal: Signal, name: &str| {
        signal.platform_vector(&at_rest.equilibrium.pose).ok_or_else(|| {
            anyhow!("{name} is on a cable, but the report shows a response of the platform: use `funicular frf` for it")
        })
    };

    report(&ReportInput {
        platform_share: request.platform_share,
        at_rest,
        file_label: name,
        robot_text: text,
        linearisation: at_rest::linearisation(&request.model, at_rest.equilibrium.model),
        below_hz: request.below_hz,
        frf_input: (input_in_words(&from, request.points.input_point_m), vector(input, &from.name)?),
        frf_output: (output_in_words(&to, request.points.output_point_m), vector(output, &to.name)?, to.quantity),
        frf_unit: &response_unit(&from, &to),
        command_line,
    })
}

/// Input and output of the response: those of the request; by default along z, or along x if a guide holds z.
fn response(request: &request::ReportRequest, robot: &Robot) -> Result<(Input, Output)> {
    const Z: usize = 2;
    let (force, acceleration) =
        if robot.platform.motion.components().contains(&Z) { ("fz", "az") } else { ("fx", "ax") };
    let input = request::input(request.input.as_deref().unwrap_or(force))?;
    let output = request::output(request.output.as_deref().unwrap_or(acceleration))?;
    Ok((input, output))
}

fn input_in_words(input: &Input, point: Option<[f64; 3]>) -> String {
    match &input.place {
        Place::Platform { turns: true, direction_w } => format!("a moment about {}", axis_in_words(*direction_w)),
        Place::Platform { turns: false, direction_w } => {
            format!("a force along {} {}", axis_in_words(*direction_w), at("at", point))
        }
        _ => input.name.clone(),
    }
}

fn output_in_words(output: &Output, point: Option<[f64; 3]>) -> String {
    let Place::Platform { turns, direction_w } = &output.place else { return output.name.clone() };
    let along = axis_in_words(*direction_w);
    let of_platform = || at("of", point);
    match (turns, output.quantity) {
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

fn at(preposition: &str, point: Option<[f64; 3]>) -> String {
    match point {
        None => format!("{preposition} the platform origin"),
        Some(point) => format!("{preposition} the platform's point ({}) m", listed(&point, 3)),
    }
}
