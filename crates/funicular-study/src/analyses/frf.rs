//! `frf`: frequency response and its peaks.

use super::found;
use super::shared::Models;
use crate::Watch;
use crate::at_rest::{self, AtRest};
use crate::error::Cancelled;
use crate::request;
use crate::signals::{Input, Output};
use anyhow::Result;
use funicular::dynamics::Linearisation;
use funicular::math::Complex;
use funicular::response::{self, Peak, Port, Quantity};
use funicular::robot::Robot;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Number of frequencies between two progress reports: some 10 ms of work. It is a multiple of every number of SIMD
/// lanes, so that the results do not depend on it.
const CHUNK: usize = 16_384;

/// Results of `frf`: a frequency response and its peaks.
#[derive(Serialize)]
pub struct Frf {
    #[serde(skip)]
    pub robot: String,
    #[serde(flatten)]
    pub models: Models,
    pub input: String,
    #[serde(flatten, serialize_with = "input_place")]
    pub input_place: PlaceRow,
    pub output: String,
    #[serde(flatten, serialize_with = "output_place")]
    pub output_place: PlaceRow,
    pub unit: String,
    pub prominence_db: f64,
    pub peaks: Vec<PeakRow>,
    pub frequency_hz: Vec<f64>,
    pub real: Vec<f64>,
    pub imag: Vec<f64>,
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Peak of a response.
#[derive(Serialize)]
pub struct PeakRow {
    pub frequency_hz: f64,
    pub prominence_db: f64,
    pub magnitude: f64,
}

impl From<Peak> for PeakRow {
    fn from(peak: Peak) -> Self {
        let Peak { frequency_hz, prominence_db, magnitude } = peak;
        Self { frequency_hz, prominence_db, magnitude }
    }
}

/// Computes a frequency response and its peaks.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without such an equilibrium, an undamped resonance at one of
/// the frequencies, or work that was stopped.
pub fn run(robot: Robot, request: &request::FrfRequest, watch: &mut dyn Watch) -> Result<Frf> {
    let frequencies = request.range.frequencies()?;
    request::check_not_negative("prominence_db", request.prominence_db)?;

    // Signals that the robot does not have are refused before the work.
    at_rest::signals(
        &robot,
        &request::input(&request.input)?,
        &request::output(&request.output)?,
        &request.signal_points,
    )?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let pair =
        Pair { input: &request.input, output: &request.output, points: request.signal_points, model: request.model };
    let Response { from, to, input_place, output_place, linearisation, values, warnings } =
        response(&at_rest, &pair, &frequencies, watch)?;
    let peaks = response::peaks(&frequencies, &values, request.prominence_db);

    Ok(Frf {
        robot: at_rest.robot.name.clone(),
        models: Models::of(&at_rest, linearisation),
        unit: unit(&from, &to),
        input: from.name,
        input_place,
        output: to.name,
        output_place,
        prominence_db: request.prominence_db,
        peaks: peaks.into_iter().map(PeakRow::from).collect(),
        frequency_hz: frequencies,
        real: values.iter().map(|value| value.re).collect(),
        imag: values.iter().map(|value| value.im).collect(),
        warnings,
    })
}

/// Signals of a response and the linearisation of the robot.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// Name of the input signal.
    pub input: &'a str,
    /// Name of the output signal.
    pub output: &'a str,
    /// Points of the platform.
    pub points: request::ResponsePoints,
    /// Linearisation.
    pub model: request::Model,
}

/// Response at frequencies, with its signals.
pub struct Response {
    /// Input signal.
    pub from: Input,
    /// Output signal.
    pub to: Output,
    /// Place of the input.
    pub input_place: PlaceRow,
    /// Place of the output.
    pub output_place: PlaceRow,
    /// Models of the linearised robot.
    pub linearisation: Linearisation,
    /// One value per frequency.
    pub values: Vec<Complex>,
    /// Sentences that the user should know before trusting the values.
    pub warnings: Vec<String>,
}

/// Computes the response of a robot at equilibrium at frequencies [Hz], none of them negative.
///
/// # Errors
/// Signals that the robot does not have, an undamped resonance at one of the frequencies, or work that was stopped.
pub fn response(at_rest: &AtRest, pair: &Pair<'_>, frequencies: &[f64], watch: &mut dyn Watch) -> Result<Response> {
    let (from, to) = (request::input(pair.input)?, request::output(pair.output)?);
    let signals = at_rest::signals(&at_rest.robot, &from, &to, &pair.points)?;
    let linearisation = at_rest::linearisation(&pair.model, at_rest.equilibrium.model);
    let highest_hz = frequencies.iter().copied().fold(0.0, f64::max);
    let (dynamics, warnings) = at_rest.dynamics(linearisation, highest_hz)?;

    let [input, output] = at_rest.ports(&dynamics, signals)?;
    let mut values: Vec<Complex> = Vec::with_capacity(frequencies.len());
    for chunk in frequencies.chunks(CHUNK) {
        values.extend(response::between(&dynamics, chunk, &input, &output, to.quantity)?);
        watch.progress(values.len(), frequencies.len(), "frequencies");
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
    }
    let input_place = PlaceRow::of(&input, pair.points.input_point_m);
    let output_place = PlaceRow::of(&output, pair.points.output_point_m);
    Ok(Response { from, to, input_place, output_place, linearisation, values, warnings })
}

/// Place of the input or output of a response.
pub struct PlaceRow {
    /// True if the point is on a cable. It is then in world axes, at equilibrium, and not in the platform frame.
    pub on_cable: bool,
    pub point_m: [f64; 3],
}

impl PlaceRow {
    fn of(port: &Port, point: Option<[f64; 3]>) -> Self {
        match port.cable_point_w() {
            None => Self { on_cable: false, point_m: point.unwrap_or_default() },
            Some(point_w) => Self { on_cable: true, point_m: point_w.into() },
        }
    }

    fn serialize<S: Serializer>(&self, keys: [&'static str; 2], to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(Some(1))?;
        map.serialize_entry(keys[usize::from(self.on_cable)], &self.point_m)?;
        map.end()
    }
}

fn input_place<S: Serializer>(place: &PlaceRow, to: S) -> Result<S::Ok, S::Error> {
    place.serialize(["input_point_m", "input_point_w_m"], to)
}

fn output_place<S: Serializer>(place: &PlaceRow, to: S) -> Result<S::Ok, S::Error> {
    place.serialize(["output_point_m", "output_point_w_m"], to)
}

/// Unit of a response: motion divided by force or moment.
pub fn unit(input: &Input, output: &Output) -> String {
    let motion = if output.is_rotation { "rad" } else { "m" };
    let by_time = match output.quantity {
        Quantity::Displacement => "",
        Quantity::Velocity => "/s",
        Quantity::Acceleration => "/s²",
    };
    let effort = if input.is_moment { "(N·m)" } else { "N" };
    if by_time.is_empty() { format!("{motion}/{effort}") } else { format!("({motion}{by_time})/{effort}") }
}

found!(Frf, "frf");
