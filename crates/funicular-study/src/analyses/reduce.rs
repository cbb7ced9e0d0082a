//! `reduce`: model of the robot for control design, as a state space ([`control_model`]) or in second-order form.

pub mod control_model;

use super::shared::Models;
use super::{Found, found};
use crate::Watch;
use crate::at_rest::{self, AtRest};
use crate::columns::{ResultTable, Tabled};
use crate::error::Cancelled;
use crate::names::{ModelForm, Named};
use crate::request;
use crate::rows::{Described, rows};
use crate::signals::{Input, Output, SignalLists};
use crate::table::Column;
use crate::text::significant;
use anyhow::{Result, bail};
use control_model::{ControlStateSpace, StatesRow};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::Vec3;
use funicular::modes;
use funicular::reduced_model::{Coordinate, DampingAt, ReductionError, RequestedModel, STEPS, SecondOrder, reduce};
use funicular::response::{Quantity, Signal};
use funicular::robot::Robot;
use serde::Serialize;
use serde_json::{Value, json};

/// Maximum number of natural frequencies of one model. It has about twice as many coordinates.
const MAX_MODES: usize = 400;

/// Maximum error of a response relative to its peak, if a request gives none.
pub const DEFAULT_TOLERANCE: f64 = 0.01;
/// Maximum relative error due to omitted modes of the second-order form, if a request gives none.
pub const DEFAULT_SECOND_ORDER_TOLERANCE: f64 = 1e-3;
/// Maximum number of states that a request may ask for.
const MAX_ORDER: usize = 400;

/// Results of `reduce` in the requested form.
#[derive(Serialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "each variant is named after its form and holds its results")]
pub enum ReducedForm {
    StateSpace(Box<ControlStateSpace>),
    SecondOrder(Box<Reduced>),
}

impl Described for ReducedForm {
    fn schema() -> Value {
        json!({ "oneOf": [ControlStateSpace::schema(), Reduced::schema()] })
    }
}

impl Found for ReducedForm {
    const COMMAND: &'static str = Reduced::COMMAND;

    fn robot(&self) -> &str {
        match self {
            Self::StateSpace(found) => found.robot(),
            Self::SecondOrder(found) => found.robot(),
        }
    }

    fn warnings(&self) -> &[String] {
        match self {
            Self::StateSpace(found) => found.warnings(),
            Self::SecondOrder(found) => found.warnings(),
        }
    }
}

impl ReducedForm {
    /// Notes the file or folder to which a front end writes the matrices.
    pub fn set_matrices_file(&mut self, file: Option<String>) {
        match self {
            Self::StateSpace(found) => found.matrices_file = file,
            Self::SecondOrder(found) => found.matrices_file = file,
        }
    }
}

rows! {
    /// Results of `reduce` in second-order form: a model and its errors.
    pub struct Reduced {
        pub robot: String = hidden;
        pub form: &'static str;
        pub below_hz: f64;
        pub models: Models = spread;
        pub order: usize;
        pub frequency_error: f64;
        pub truncation_error: Option<f64>;
        pub damping_error: Option<f64>;
        pub damping: String;
        pub inputs: Vec<ChannelRow>;
        pub outputs: Vec<ChannelRow>;
        pub coordinates: Vec<CoordinateRow>;
        /// File or folder to which a front end has written the matrices.
        pub matrices_file: Option<String>;
        /// Model with its matrices.
        pub model: SecondOrder = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Input or output of the model.
    pub struct ChannelRow {
        pub name: String;
        pub unit: &'static str;
    }
}

rows! {
    /// Coordinate of the model.
    pub struct CoordinateRow in tables() {
        /// Name of the coordinate.
        pub name: String => one("coordinate");
        /// Unit of the coordinate.
        pub unit: &'static str => one;
        /// Frequency of a mode of a cable with both ends fixed.
        pub clamped_frequency_hz: Option<f64> => one;
    }
}

/// Makes a model of the robot for control design, in the requested form.
///
/// # Errors
/// A signal that the robot does not have, a robot without such an equilibrium or model, too many modes, or work that
/// was stopped.
pub fn run(robot: Robot, request: &request::ReduceRequest, watch: &mut dyn Watch) -> Result<ReducedForm> {
    check(&robot, request)?;
    about(&at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?, request, watch)
}

/// Makes the model for a robot at equilibrium. The state of the request is not used.
///
/// # Errors
/// The errors of [`run`].
pub fn about(at_rest: &AtRest, request: &request::ReduceRequest, watch: &mut dyn Watch) -> Result<ReducedForm> {
    let at_rest = &*at_rest.vibrating();
    Ok(match request.form {
        ModelForm::StateSpace => ReducedForm::StateSpace(Box::new(control_model::about(at_rest, request, watch)?)),
        ModelForm::SecondOrder => ReducedForm::SecondOrder(Box::new(second_order(at_rest, request, watch)?)),
    })
}

/// Refuses numbers out of range, keys that exclude each other, and signals that the robot does not have.
fn check(robot: &Robot, request: &request::ReduceRequest) -> Result<SignalLists> {
    request::check_positive("below_hz", request.below_hz)?;

    match (request.form, request.order, request.tolerance) {
        (ModelForm::SecondOrder, Some(_), _) => bail!(
            "⟪order⟫ chooses modes of a state space, and the second-order form keeps all of them: take ⟪form⟫ \
             `state-space`, or leave ⟪order⟫ out"
        ),
        (ModelForm::SecondOrder, None, Some(tolerance)) => request::check_not_negative("tolerance", tolerance)?,
        (ModelForm::StateSpace, Some(_), Some(_)) => {
            bail!("⟪order⟫ and ⟪tolerance⟫ both decide the number of states: give one of them")
        }
        (ModelForm::StateSpace, Some(order), None) if !(2..=MAX_ORDER).contains(&order) => {
            bail!("⟪order⟫ is {order}: give a number of states from 2 to {MAX_ORDER}; a mode needs two")
        }
        (ModelForm::StateSpace, None, Some(tolerance)) => request::check_positive("tolerance", tolerance)?,
        _ => {}
    }

    if let Some(hz) = request.damping_at_hz {
        request::check_positive("damping_at_hz", hz)?;
    }
    request.points.check()?;

    Ok((inputs(robot, request)?, outputs(robot, request)?))
}

/// Robot at equilibrium, linearised for a model.
struct Linearised {
    dynamics: Dynamics,
    linearisation: Linearisation,
    warnings: Vec<String>,
    damping_at: DampingAt,
    from: Vec<Signal>,
    to: Vec<(Signal, Quantity)>,
}

/// Linearises the robot and checks the number of its modes.
fn linearised(
    at_rest: &AtRest,
    request: &request::ReduceRequest,
    (inputs, outputs): &SignalLists,
) -> Result<Linearised> {
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let (dynamics, mut warnings) = at_rest.dynamics(linearisation, request.below_hz)?;
    warnings.extend(at_rest.without_damping());
    modes::check_count(&dynamics, request.below_hz, MAX_MODES)?;
    Ok(Linearised {
        dynamics,
        linearisation,
        warnings,
        damping_at: request.damping_at_hz.map_or(DampingAt::NaturalFrequencies, DampingAt::Hz),
        from: inputs.iter().map(|(_, signal)| *signal).collect(),
        to: outputs.iter().map(|(output, signal)| (*signal, output.quantity)).collect(),
    })
}

/// Reports the number of finished steps of a reduction; `false` if it shall stop.
pub(super) fn goes_on(watch: &mut dyn Watch, done: usize) -> bool {
    watch.progress(done, STEPS, "steps");
    !watch.is_cancelled()
}

/// Error of a reduction; that of stopped work has its own type.
pub(super) fn stopped_or_error(error: ReductionError) -> anyhow::Error {
    if error == ReductionError::Stopped { Cancelled.into() } else { error.into() }
}

/// Sentence about the treatment of damping.
fn damping_in_words(is_exact: bool, damping_at: DampingAt) -> String {
    match (is_exact, damping_at) {
        (true, _) => "viscous, without approximation".to_owned(),
        (false, DampingAt::NaturalFrequencies) => {
            "constant ratios approximated by viscous damping, correct at every natural frequency".to_owned()
        }
        (false, DampingAt::Hz(hz)) => format!("constant ratios approximated by viscous damping, correct at {hz} Hz"),
    }
}

/// Makes the second-order form for a robot at equilibrium.
fn second_order(at_rest: &AtRest, request: &request::ReduceRequest, watch: &mut dyn Watch) -> Result<Reduced> {
    let signals = check(&at_rest.robot, request)?;
    let Linearised { dynamics, linearisation, warnings, damping_at, from, to } =
        linearised(at_rest, request, &signals)?;

    let tolerance = request.tolerance.unwrap_or(DEFAULT_SECOND_ORDER_TOLERANCE);
    let requested = RequestedModel { below_hz: request.below_hz, tolerance, damping_at };
    let report = &mut |done| goes_on(watch, done);
    let model = reduce(&at_rest.robot, &at_rest.equilibrium, &dynamics, &from, &to, requested, report)
        .map_err(stopped_or_error)?;

    let mut reduced = Reduced {
        robot: at_rest.robot.name.clone(),
        form: ModelForm::SecondOrder.name(),
        below_hz: request.below_hz,
        models: Models::of(at_rest, linearisation),
        order: model.mass.nrows(),
        frequency_error: model.frequency_error,
        truncation_error: model.truncation_error,
        damping_error: model.damping_error,
        damping: damping_in_words(model.damping_error == Some(0.0), damping_at),
        inputs: input_rows(&signals.0),
        outputs: output_rows(&signals.1),
        coordinates: model.coordinates.iter().map(|of| CoordinateRow::of(&at_rest.robot, of)).collect(),
        matrices_file: None,
        model,
        warnings,
    };
    if reduced.truncation_error.is_some_and(|error| error > tolerance) {
        reduced.warnings.push(format!(
            "with all modes of the cables the error is {}, above the requested {}: the motion beside a force on a \
             cable has a kink, which modes do not have",
            significant(reduced.truncation_error.unwrap_or_default(), 2),
            tolerance
        ));
    }

    if let Err(error) = reduced.model.state_space() {
        reduced.warnings.push(format!("the state space of this model is left out: {error}"));
    }

    Ok(reduced)
}

/// Signals with these names, or else those of all possible motions of the platform.
fn requested<T>(
    robot: &Robot,
    names: &[String],
    of_motions: [&str; 6],
    read: impl Fn(&str) -> Result<T>,
) -> Result<Vec<T>> {
    if names.is_empty() {
        return robot.platform.motion.components().iter().map(|&i| read(of_motions[i])).collect();
    }
    names.iter().map(|name| read(name)).collect()
}

/// Requested inputs, or else every force and moment on the platform.
fn inputs(robot: &Robot, request: &request::ReduceRequest) -> Result<Vec<(Input, Signal)>> {
    let requested = requested(robot, &request.input, ["fx", "fy", "fz", "mx", "my", "mz"], request::input)?;
    let point_p = request.points.input_point_m.map(Vec3::from);
    requested.into_iter().map(|input| Ok(input.signal(robot, point_p).map(|signal| (input, signal))?)).collect()
}

/// Requested outputs, or else every displacement and rotation of the platform.
fn outputs(robot: &Robot, request: &request::ReduceRequest) -> Result<Vec<(Output, Signal)>> {
    let requested = requested(robot, &request.output, ["x", "y", "z", "rx", "ry", "rz"], request::output)?;
    let point_p = request.points.output_point_m.map(Vec3::from);
    requested.into_iter().map(|output| Ok(output.signal(robot, point_p).map(|signal| (output, signal))?)).collect()
}

fn input_rows(inputs: &[(Input, Signal)]) -> Vec<ChannelRow> {
    let unit = Input::unit;
    inputs.iter().map(|(input, _)| ChannelRow { name: input.name.clone(), unit: unit(input) }).collect()
}

fn output_rows(outputs: &[(Output, Signal)]) -> Vec<ChannelRow> {
    outputs.iter().map(|(output, _)| ChannelRow { name: output.name.clone(), unit: unit(output) }).collect()
}

fn unit(output: &Output) -> &'static str {
    match (output.is_rotation(), output.quantity) {
        (_, Quantity::Displacement) => output.unit(),
        (false, Quantity::Velocity) => "m/s",
        (false, Quantity::Acceleration) => "m/s²",
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
            Coordinate::Support { support, axis } => Self {
                name: format!("support {} {}", robot.supports[*support].name, ["x", "y", "z"][*axis]),
                unit: "m",
                clamped_frequency_hz: None,
            },
        }
    }
}

impl Tabled for ReducedForm {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![
            ("`form` state-space", StatesRow::columns().described()),
            ("`form` second-order", CoordinateRow::columns().described()),
        ]
    }

    fn table(&self) -> ResultTable<'_> {
        match self {
            Self::StateSpace(found) => ResultTable::new(StatesRow::columns(), &found.states),
            Self::SecondOrder(found) => ResultTable::new(CoordinateRow::columns(), &found.coordinates),
        }
    }
}

found!(Reduced, "reduce");
