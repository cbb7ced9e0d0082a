//! `reduce`: small second-order model of the robot for control design.

use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::request;
use crate::signals::{Input, Output};
use crate::text::significant;
use anyhow::Result;
use funicular::math::Vec3;
use funicular::modes;
use funicular::reduced_model::{Coordinate, DampingAt, RequestedModel, SecondOrder, reduce};
use funicular::response::{Quantity, Signal};
use funicular::robot::Robot;
use serde::Serialize;

/// Maximum number of natural frequencies of one model. It has about twice as many coordinates.
const MAX_MODES: usize = 400;

/// Results of `reduce`: a second-order model and its errors.
#[derive(Serialize)]
pub struct Reduced {
    #[serde(skip)]
    pub robot: String,
    pub below_hz: f64,
    #[serde(flatten)]
    pub models: Models,
    pub order: usize,
    pub frequency_error: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub truncation_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_error: Option<f64>,
    pub damping: String,
    pub inputs: Vec<ChannelRow>,
    pub outputs: Vec<ChannelRow>,
    pub coordinates: Vec<CoordinateRow>,
    /// File or folder to which a front end has written the matrices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrices_file: Option<String>,
    /// Model with its matrices.
    #[serde(skip)]
    pub model: SecondOrder,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Input or output of the model.
#[derive(Serialize)]
pub struct ChannelRow {
    pub name: String,
    pub unit: &'static str,
}

/// Coordinate of the model.
#[derive(Serialize)]
pub struct CoordinateRow {
    pub name: String,
    pub unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clamped_frequency_hz: Option<f64>,
}

/// Makes a second-order model of the robot for control design.
///
/// # Errors
/// A signal that the robot does not have, a robot without such an equilibrium, or too many modes.
pub fn run(robot: Robot, request: &request::ReduceRequest) -> Result<Reduced> {
    check(&robot, request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request)
}

/// Inputs and outputs of a model.
type Signals = (Vec<(Input, Signal)>, Vec<(Output, Signal)>);

/// Refuses numbers out of range and signals that the robot does not have.
fn check(robot: &Robot, request: &request::ReduceRequest) -> Result<Signals> {
    request::check_positive("below_hz", request.below_hz)?;
    request::check_not_negative("tolerance", request.tolerance)?;
    if let Some(hz) = request.damping_at_hz {
        request::check_positive("damping_at_hz", hz)?;
    }
    request.points.check()?;
    Ok((inputs(robot, request)?, outputs(robot, request)?))
}

/// Makes the model for a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &request::ReduceRequest) -> Result<Reduced> {
    let (inputs, outputs) = check(&at_rest.robot, request)?;
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let (dynamics, warnings) = at_rest.dynamics(linearisation, request.below_hz)?;
    modes::check_count(&dynamics, request.below_hz, MAX_MODES)?;
    let damping_at = request.damping_at_hz.map_or(DampingAt::NaturalFrequencies, DampingAt::Hz);

    let requested = RequestedModel { below_hz: request.below_hz, tolerance: request.tolerance, damping_at };
    let from: Vec<Signal> = inputs.iter().map(|(_, signal)| *signal).collect();
    let to: Vec<(Signal, Quantity)> = outputs.iter().map(|(output, signal)| (*signal, output.quantity)).collect();
    let model = reduce(&at_rest.robot, &at_rest.equilibrium, &dynamics, &from, &to, requested)?;

    let mut reduced = Reduced {
        robot: at_rest.robot.name.clone(),
        below_hz: request.below_hz,
        models: Models::of(at_rest, linearisation),
        order: model.mass.nrows(),
        frequency_error: model.frequency_error,
        truncation_error: model.truncation_error,
        damping_error: model.damping_error,
        damping: match (model.damping_error, damping_at) {
            (Some(0.0), _) => "viscous, without approximation".to_owned(),
            (_, DampingAt::NaturalFrequencies) => {
                "constant ratios approximated by viscous damping, correct at every natural frequency".to_owned()
            }
            (_, DampingAt::Hz(hz)) => format!("constant ratios approximated by viscous damping, correct at {hz} Hz"),
        },
        inputs: inputs
            .iter()
            .map(|(input, _)| ChannelRow { name: input.name.clone(), unit: if input.is_moment { "N m" } else { "N" } })
            .collect(),
        outputs: outputs
            .iter()
            .map(|(output, _)| ChannelRow { name: output.name.clone(), unit: unit(output) })
            .collect(),
        coordinates: model.coordinates.iter().map(|of| CoordinateRow::of(&at_rest.robot, of)).collect(),
        matrices_file: None,
        model,
        warnings,
    };
    if reduced.truncation_error.is_some_and(|error| error > request.tolerance) {
        reduced.warnings.push(format!(
            "with all modes of the cables the error is {}, above the requested {}: the motion beside a force on a \
             cable has a kink, which modes do not have",
            significant(reduced.truncation_error.unwrap_or_default(), 2),
            request.tolerance
        ));
    }

    Ok(reduced)
}

/// Requested inputs, or else every force and moment on the platform.
fn inputs(robot: &Robot, request: &request::ReduceRequest) -> Result<Vec<(Input, Signal)>> {
    let all = ["fx", "fy", "fz", "mx", "my", "mz"];
    let requested = if request.input.is_empty() {
        let possible = robot.platform.motion.components();
        possible.iter().map(|&i| request::input(all[i])).collect::<Result<Vec<_>>>()?
    } else {
        request.input.iter().map(|name| request::input(name)).collect::<Result<Vec<_>>>()?
    };
    let point_p = request.points.input_point_m.map(Vec3::from);
    requested.into_iter().map(|input| Ok(input.signal(robot, point_p).map(|signal| (input, signal))?)).collect()
}

/// Requested outputs, or else every displacement and rotation of the platform.
fn outputs(robot: &Robot, request: &request::ReduceRequest) -> Result<Vec<(Output, Signal)>> {
    let all = ["x", "y", "z", "rx", "ry", "rz"];
    let requested = if request.output.is_empty() {
        let possible = robot.platform.motion.components();
        possible.iter().map(|&i| request::output(all[i])).collect::<Result<Vec<_>>>()?
    } else {
        request.output.iter().map(|name| request::output(name)).collect::<Result<Vec<_>>>()?
    };
    let point_p = request.points.output_point_m.map(Vec3::from);
    requested.into_iter().map(|output| Ok(output.signal(robot, point_p).map(|signal| (output, signal))?)).collect()
}

fn unit(output: &Output) -> &'static str {
    match (output.is_rotation, output.quantity) {
        (false, Quantity::Displacement) => "m",
        (false, Quantity::Velocity) => "m/s",
        (false, Quantity::Acceleration) => "m/s²",
        (true, Quantity::Displacement) => "rad",
        (true, Quantity::Velocity) => "rad/s",
        (true, Quantity::Acceleration) => "rad/s²",
    }
}

impl CoordinateRow {
    fn of(robot: &Robot, coordinate: &Coordinate) -> Self {
        match coordinate {
            Coordinate::Platform(i) => Self {
                name: robot.platform.motion.coordinate_names()[*i].to_owned(),
                unit: if robot.platform.motion.is_rotation(*i) { "rad" } else { "m" },
                clamped_frequency_hz: None,
            },
            Coordinate::Clamped { cable, out_of_plane, frequency_hz } => Self {
                name: format!(
                    "cable {} {}",
                    robot.cables[*cable].name,
                    if *out_of_plane { "out of plane" } else { "in plane" }
                ),
                unit: "m √kg",
                clamped_frequency_hz: Some(*frequency_hz),
            },
        }
    }
}

found!(Reduced, "reduce");
