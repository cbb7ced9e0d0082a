//! `frf`: frequency responses and their peaks.

use super::found;
use super::shared::Models;
use crate::at_rest::{self, AtRest};
use crate::columns::{Columns, ResultTable, Tabled, column};
use crate::error::Cancelled;
use crate::request::{self, FrequencyRange, ResponseRange};
use crate::rows::{DeclaredRow, Described, RowKey, key, put, rows, schema_of};
use crate::shared_ropes::refuse_ropes_over_sheaves;
use crate::signals::{Input, Output, SignalLists, response_unit};
use crate::table::Column;
use crate::text::{counted, significant};
use crate::{Silent, Watch};
use anyhow::{Result, bail};
use funicular::dynamics::{Dynamics, Linearisation};
use funicular::math::{Complex, Vec3};
use funicular::modes;
use funicular::response::adaptive::{Resolution, Resolved, resolve};
use funicular::response::missed_peaks::{MISSED, MissedPeaks, missed_peaks};
use funicular::response::{self, Measured, Peak, Port, Quantity, Signal};
use funicular::robot::Robot;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// Number of frequencies between two progress reports: some 10 ms of work. It is a multiple of every number of SIMD
/// lanes, so that the results do not depend on it.
const CHUNK: usize = 16_384;

/// Minimum number of frequencies that are read as a curve, whose missed peaks are reported. Fewer are single values.
const MIN_CURVE: usize = 10;

/// Maximum number of natural frequencies in the range of a curve whose peaks are checked; 5,000 take about 0.1 s.
const MAX_CHECKED: usize = 5_000;

/// Results of `frf`: frequency responses and their peaks. The JSON of one response has its keys at the top; several are
/// listed as `responses`.
pub struct Frf {
    pub robot: String,
    pub models: Models,
    /// Responses of all pairs: the first output to all inputs, then the next output.
    pub responses: Vec<PairRow>,
    pub adaptive: bool,
    pub prominence_db: f64,
    pub frequency_hz: Vec<f64>,
    pub warnings: Vec<String>,
}

rows! {
    /// Response of one output to one input.
    pub struct PairRow {
        /// Input signal.
        pub input: String;
        /// Place of the input.
        pub input_place: PlaceRow<true> = spread;
        /// Output signal.
        pub output: String;
        /// Place of the output.
        pub output_place: PlaceRow<false> = spread;
        /// Unit of the response.
        pub unit: String;
        /// Peaks in the range.
        pub peaks: Vec<PeakRow>;
        /// Undamped resonances of an adaptive response, whose peaks have no finite height.
        pub undamped_hz: Vec<f64> = sparse;
        /// Real part of the response at every frequency.
        pub real: Vec<f64>;
        /// Imaginary part of the response at every frequency.
        pub imag: Vec<f64>;
    }
}

rows! {
    /// Peak of a response.
    pub struct PeakRow {
        pub frequency_hz: f64;
        pub prominence_db: f64;
        pub magnitude: f64;
    }
}

impl From<Peak> for PeakRow {
    fn from(peak: Peak) -> Self {
        let Peak { frequency_hz, prominence_db, magnitude } = peak;
        Self { frequency_hz, prominence_db, magnitude }
    }
}

impl Serialize for Frf {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut object = to.serialize_map(None)?;
        let map = &mut object;
        put!(map, &self.models, models spread);
        if let [one] = &self.responses[..] {
            put!(map, &one.input, input);
            put!(map, &one.input_place, input_place spread);
            put!(map, &one.output, output);
            put!(map, &one.output_place, output_place spread);
            put!(map, &one.unit, unit);
            put!(map, &self.prominence_db, prominence_db);
            put!(map, &one.peaks, peaks);
            put!(map, &one.undamped_hz, undamped_hz sparse);
            put!(map, &self.frequency_hz, frequency_hz);
            put!(map, &one.real, real);
            put!(map, &one.imag, imag);
        } else {
            put!(map, &self.prominence_db, prominence_db);
            put!(map, &self.frequency_hz, frequency_hz);
            put!(map, &self.responses, responses);
        }
        object.end()
    }
}

impl Described for Frf {
    fn schema() -> Value {
        let of = |about: &str, own: Vec<RowKey>| {
            let mut keys = Models::keys();
            keys.extend(key::<f64>("prominence_db", &["Smallest height of a peak over the valleys beside it."], false));
            keys.extend(key::<Vec<f64>>("frequency_hz", &["Frequencies."], false));
            keys.extend(own);
            schema_of("Frf", &[about], keys)
        };
        let several = key::<Vec<PairRow>>("responses", &["Response of every output to every input."], false);
        let forms = [of("One frequency response.", PairRow::keys()), of("Several frequency responses.", several)];
        json!({ "oneOf": forms })
    }
}

/// Computes frequency responses and their peaks.
///
/// # Errors
/// A request that contradicts itself or the robot, a robot without such an equilibrium, an undamped resonance at one of
/// the frequencies, or work that was stopped.
pub fn run(robot: Robot, request: &request::FrfRequest, watch: &mut dyn Watch) -> Result<Frf> {
    // A range that the request gives completely is checked before the work.
    if let ResponseRange { from_hz: Some(from_hz), to_hz: Some(to_hz), points, log } = request.range {
        FrequencyRange { from_hz, to_hz, points, log }.starts()?;
    }
    request::check_not_negative("prominence_db", request.prominence_db)?;

    // Signals that the robot does not have are refused before the work.
    let pairs = Pairs {
        inputs: request.input.names(),
        outputs: request.output.names(),
        points: request.signal_points,
        model: request.model,
    };
    signals(&robot, &pairs)?;
    let at_rest = at_rest::equilibrium(robot, &request.robot, &request.state, &request.tensions)?;
    let linearisation = at_rest::linearisation(&request.model, at_rest.equilibrium.model);
    let range = at_rest.response_range(&request.range, linearisation)?;
    let adaptive = request.is_adaptive();
    let frequencies = if adaptive { range.starts()? } else { range.frequencies()? };
    about(&at_rest, &pairs, frequencies, adaptive, request.prominence_db, watch)
}

/// Computes responses at the equilibrium of a robot: at the frequencies [Hz], or from them on `adaptive`.
///
/// # Errors
/// As [`run`].
pub fn about(
    at_rest: &AtRest,
    pairs: &Pairs<'_>,
    frequencies: Vec<f64>,
    adaptive: bool,
    prominence_db: f64,
    watch: &mut dyn Watch,
) -> Result<Frf> {
    let response = response(at_rest, pairs, frequencies, adaptive, watch)?;

    let responses = (0..response.values.len()).map(|i| response.row(i, pairs, prominence_db)).collect();
    let Response { linearisation, frequencies_hz, caveat, mut warnings, .. } = response;
    warnings.extend(caveat);
    Ok(Frf {
        robot: at_rest.robot.name.clone(),
        models: Models::of(at_rest, linearisation),
        responses,
        adaptive,
        prominence_db,
        frequency_hz: frequencies_hz,
        warnings,
    })
}

/// Inputs and outputs of responses, and the linearisation of the robot.
#[derive(Debug, Clone, Copy)]
pub struct Pairs<'a> {
    /// Names of the input signals.
    pub inputs: &'a [String],
    /// Names of the output signals.
    pub outputs: &'a [String],
    /// Points of the platform, for all inputs and all outputs.
    pub points: request::ResponsePoints,
    /// Linearisation.
    pub model: request::Model,
}

/// Responses of all outputs to all inputs at frequencies, with their signals.
pub struct Response {
    /// Input signals.
    inputs: Vec<Input>,
    /// Output signals.
    outputs: Vec<Output>,
    /// Ports of the inputs.
    input_ports: Vec<Port>,
    /// Ports of the outputs.
    output_ports: Vec<(Port, Quantity)>,
    /// Models of the linearised robot.
    linearisation: Linearisation,
    /// Frequencies [Hz]: the given ones, and those that an adaptive response has added.
    pub frequencies_hz: Vec<f64>,
    /// One row per pair, with one value per frequency: the first output with all inputs, then the next output.
    pub values: Vec<Vec<Complex>>,
    /// Responses of an adaptive computation.
    resolved: Option<Resolved>,
    /// Sentence about peaks that the frequencies miss.
    pub caveat: Option<String>,
    /// Sentences that the user should know before trusting the values.
    warnings: Vec<String>,
}

/// Signals of responses, checked for this robot.
fn signals(robot: &Robot, pairs: &Pairs<'_>) -> Result<SignalLists> {
    let Pairs { inputs, outputs, points, .. } = *pairs;
    points.check()?;
    for (key, names) in [("input", inputs), ("output", outputs)] {
        if names.is_empty() {
            bail!("⟪{key}⟫ is an empty list: name at least one signal");
        }
    }
    let [from, to] = [points.input_point_m, points.output_point_m].map(|point| point.map(Vec3::from));
    let input = |name: &String| {
        let input = request::input(name)?;
        let signal = input.signal(robot, from)?;
        Ok((input, signal))
    };
    let output = |name: &String| {
        let output = request::output(name)?;
        let signal = output.signal(robot, to)?;
        Ok((output, signal))
    };
    Ok((inputs.iter().map(input).collect::<Result<_>>()?, outputs.iter().map(output).collect::<Result<_>>()?))
}

/// Computes the responses of a robot at equilibrium at frequencies [Hz], none of them negative. With `adaptive` the
/// frequencies ascend, and others are added between them.
///
/// # Errors
/// Signals that the robot does not have, an undamped resonance at one of the frequencies, frequencies that cannot be
/// the start of an adaptive response, or work that was stopped.
pub fn response(
    at_rest: &AtRest,
    pairs: &Pairs<'_>,
    frequencies: Vec<f64>,
    adaptive: bool,
    watch: &mut dyn Watch,
) -> Result<Response> {
    let ascends = frequencies.windows(2).all(|pair| pair[0] < pair[1]);
    if adaptive && !(ascends && frequencies.len() >= 2) {
        bail!("⟪adaptive⟫ needs at least two frequencies in ascending order: they are the range and the first points");
    }
    let (mut response, dynamics) = Response::without_values(at_rest, pairs, frequencies)?;

    if adaptive {
        response.resolve(&dynamics, watch)?;
    } else {
        response.compute(&dynamics, watch)?;
        if ascends && response.frequencies_hz.len() >= MIN_CURVE {
            response.caveat = response.missed(&dynamics)?;
        }
    }
    Ok(response)
}

/// Computes the responses of a robot at equilibrium at frequencies [Hz] without the search for missed peaks, which
/// takes longer than the responses.
///
/// # Errors
/// The errors of [`response()`].
pub fn values_alone(at_rest: &AtRest, pairs: &Pairs<'_>, frequencies: Vec<f64>) -> Result<Response> {
    let (mut response, dynamics) = Response::without_values(at_rest, pairs, frequencies)?;
    response.compute(&dynamics, &mut Silent)?;
    Ok(response)
}

impl Response {
    /// Response whose values are not computed yet, and the linearised robot.
    fn without_values(at_rest: &AtRest, pairs: &Pairs<'_>, frequencies: Vec<f64>) -> Result<(Self, Dynamics)> {
        refuse_ropes_over_sheaves("frf", &at_rest.robot)?;
        let at_rest = &*at_rest.vibrating();
        let (inputs, outputs) = signals(&at_rest.robot, pairs)?;
        let linearisation = at_rest::linearisation(&pairs.model, at_rest.equilibrium.model);
        let highest_hz = frequencies.iter().copied().fold(0.0, f64::max);
        let (dynamics, mut warnings) = at_rest.dynamics(linearisation, highest_hz)?;
        warnings.extend(at_rest.without_damping());

        // Ports. All points of one cable belong together, whether forces or motions.
        let all: Vec<Signal> = inputs.iter().map(|of| of.1).chain(outputs.iter().map(|of| of.1)).collect();
        let mut input_ports = Port::all(&at_rest.robot, &at_rest.equilibrium, &dynamics, &all, true)?;
        let output_ports = input_ports.split_off(inputs.len());
        let quantities = outputs.iter().map(|(output, _)| output.quantity);
        let response = Self {
            output_ports: output_ports.into_iter().zip(quantities).collect(),
            inputs: inputs.into_iter().map(|of| of.0).collect(),
            outputs: outputs.into_iter().map(|of| of.0).collect(),
            input_ports,
            linearisation,
            frequencies_hz: frequencies,
            values: Vec::new(),
            resolved: None,
            caveat: None,
            warnings,
        };
        Ok((response, dynamics))
    }

    /// Computes the values at the frequencies.
    fn compute(&mut self, dynamics: &Dynamics, watch: &mut dyn Watch) -> Result<()> {
        let total = self.frequencies_hz.len();
        let (first, rest) = self.frequencies_hz.split_at(CHUNK.min(total));
        let compute = |chunk: &[f64]| response::matrix(dynamics, chunk, &self.input_ports, &self.output_ports);
        let mut done = 0;
        let mut count = |chunk: &[f64]| {
            done += chunk.len();
            watch.progress(done, total, "frequencies");
            if watch.is_cancelled() { Err(Cancelled) } else { Ok(()) }
        };

        // The rows of the first chunk grow, so that a single chunk is not copied.
        let mut values = compute(first)?;
        for row in &mut values {
            row.reserve_exact(rest.len());
        }
        count(first)?;
        for chunk in rest.chunks(CHUNK) {
            for (row, new) in values.iter_mut().zip(compute(chunk)?) {
                row.extend(new);
            }
            count(chunk)?;
        }
        self.values = values;
        Ok(())
    }

    /// Adds frequencies until every peak has its height, and computes the values.
    fn resolve(&mut self, dynamics: &Dynamics, watch: &mut dyn Watch) -> Result<()> {
        let (from_hz, to_hz) = (self.frequencies_hz[0], self.frequencies_hz[self.frequencies_hz.len() - 1]);
        let count = modes::count_within(dynamics, from_hz, to_hz);
        if count > modes::MAX_MODES {
            bail!(
                "{count} natural frequencies lie between {from_hz} and {to_hz} Hz, ⟪adaptive⟫ resolves at most {}: \
                 choose a narrower range",
                modes::MAX_MODES
            );
        }

        let resolution = Resolution::default();
        let mut done = 0;
        let resolved = resolve(
            &self.frequencies_hz,
            &modes::within(dynamics, from_hz, to_hz),
            resolution,
            |frequencies| -> Result<Vec<Vec<Measured>>> {
                let mut rows = Vec::with_capacity(frequencies.len());
                for chunk in frequencies.chunks(CHUNK) {
                    rows.extend(response::measured(dynamics, chunk, &self.input_ports, &self.output_ports)?);
                    done += chunk.len();
                    watch.progress(done, done.max(resolution.max_points), "frequencies");
                    if watch.is_cancelled() {
                        return Err(Cancelled.into());
                    }
                }
                Ok(rows)
            },
        )?;

        if resolved.unresolved > 0 {
            self.caveat = Some(format!(
                "the response is not resolved in {} between its frequencies, because {} frequencies are the limit: \
                 choose a narrower range",
                counted(resolved.unresolved, "interval"),
                resolution.max_points
            ));
        }
        self.frequencies_hz.clone_from(&resolved.frequencies_hz);
        self.values.clone_from(&resolved.values);
        self.resolved = Some(resolved);
        Ok(())
    }

    /// Sentence about the peaks that the frequencies miss.
    fn missed(&self, dynamics: &Dynamics) -> Result<Option<String>> {
        let (from_hz, to_hz) = (self.frequencies_hz[0], self.frequencies_hz[self.frequencies_hz.len() - 1]);
        let count = modes::count_within(dynamics, from_hz, to_hz);
        if count > MAX_CHECKED {
            return Ok(Some(format!(
                "{count} natural frequencies lie between {from_hz} and {to_hz} Hz; whether the heights of their peaks \
                 are read correctly is checked for at most {MAX_CHECKED}: choose a narrower range"
            )));
        }

        let found = missed_peaks(
            &self.frequencies_hz,
            &self.values,
            &modes::within(dynamics, from_hz, to_hz),
            |frequencies| response::measured(dynamics, frequencies, &self.input_ports, &self.output_ports),
        )?;
        Ok(found.map(|MissedPeaks { count, worst }| {
            let (input, output) = self.pair(worst.response);
            let unit = response_unit(input, output);
            let of =
                if self.values.len() > 1 { format!(", of {} to {},", output.name, input.name) } else { String::new() };
            format!(
                "{} between the frequencies {} read more than {} % too low; the {}{of} has {} {unit} at {} Hz, but {} \
                 {unit} at {} Hz is read: give ⟪adaptive⟫, or more frequencies",
                counted(count, "peak"),
                if count == 1 { "is" } else { "are" },
                100.0 * MISSED,
                if count == 1 { "peak" } else { "worst" },
                significant(worst.height, 4),
                significant(worst.frequency_hz, 6),
                significant(worst.read, 4),
                significant(worst.read_hz, 6),
            )
        }))
    }

    /// Unit of the values of row `i`.
    pub fn unit(&self, i: usize) -> String {
        let (input, output) = self.pair(i);
        response_unit(input, output)
    }

    /// Input and output of the pair of row `i`.
    fn pair(&self, i: usize) -> (&Input, &Output) {
        (&self.inputs[i % self.inputs.len()], &self.outputs[i / self.inputs.len()])
    }

    /// Results of row `i` with its peaks.
    fn row(&self, i: usize, pairs: &Pairs<'_>, prominence_db: f64) -> PairRow {
        let (input, output) = self.pair(i);
        let (from, to) = (&self.input_ports[i % self.inputs.len()], &self.output_ports[i / self.inputs.len()].0);
        let peaks = match &self.resolved {
            Some(resolved) => resolved.peaks(i, prominence_db),
            None => response::peaks(&self.frequencies_hz, &self.values[i], prominence_db),
        };
        PairRow {
            input: input.name.clone(),
            input_place: PlaceRow::of(from, pairs.points.input_point_m),
            output: output.name.clone(),
            output_place: PlaceRow::of(to, pairs.points.output_point_m),
            unit: response_unit(input, output),
            peaks: peaks.into_iter().map(PeakRow::from).collect(),
            undamped_hz: self.resolved.as_ref().map_or_else(Vec::new, |resolved| resolved.undamped_resonances_hz(i)),
            real: self.values[i].iter().map(|value| value.re).collect(),
            imag: self.values[i].iter().map(|value| value.im).collect(),
        }
    }
}

/// Place of the input of a response, or of its output.
#[derive(Clone, Copy)]
pub struct PlaceRow<const IS_INPUT: bool> {
    /// True if the point is on a cable. It is then in world axes, at equilibrium, and not in the platform frame.
    pub on_cable: bool,
    /// `None` for a signal of a drive or a motion of the frame, which have no point.
    pub point_m: Option<[f64; 3]>,
}

impl<const IS_INPUT: bool> PlaceRow<IS_INPUT> {
    /// Key of a point of the platform, and that of a point on a cable.
    const KEYS: [&'static str; 2] =
        if IS_INPUT { ["input_point_m", "input_point_w_m"] } else { ["output_point_m", "output_point_w_m"] };

    fn of(port: &Port, point: Option<[f64; 3]>) -> Self {
        match (port, port.cable_point_w()) {
            (Port::Drive { .. } | Port::Frame(_), _) => Self { on_cable: true, point_m: None },
            (_, None) => Self { on_cable: false, point_m: Some(point.unwrap_or_default()) },
            (_, Some(point_w)) => Self { on_cable: true, point_m: Some(point_w.into()) },
        }
    }
}

impl<const IS_INPUT: bool> DeclaredRow for PlaceRow<IS_INPUT> {
    fn keys() -> Vec<RowKey> {
        let abouts = ["Point of the platform, its frame.", "Point on the cable at equilibrium, world frame."];
        Self::KEYS.iter().zip(abouts).flat_map(|(name, about)| key::<Option<[f64; 3]>>(name, &[about], false)).collect()
    }

    fn put<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        match &self.point_m {
            Some(point) => map.serialize_entry(Self::KEYS[usize::from(self.on_cable)], point),
            None => Ok(()),
        }
    }
}

/// Value of a response at a frequency.
struct ValueAt<'a> {
    pair: &'a PairRow,
    hz: f64,
    re: f64,
    im: f64,
}

impl ValueAt<'_> {
    /// Columns; those of several responses begin with input and output.
    fn columns(several: bool) -> Columns<Self> {
        Columns::new([
            column("input", "", "input signal", |row: &Self| row.pair.input.clone()).only_if(several),
            column("output", "", "output signal", |row: &Self| row.pair.output.clone()).only_if(several),
            column("frequency_hz", "Hz", "frequency", |row: &Self| row.hz),
            column("real", "", "real part of the response, in the unit of output over input", |row: &Self| row.re),
            column("imag", "", "imaginary part", |row: &Self| row.im),
            column("magnitude", "", "magnitude", |row: &Self| row.re.hypot(row.im)),
            column("phase_deg", "deg", "phase", |row: &Self| row.im.atan2(row.re).to_degrees()),
        ])
    }
}

impl Tabled for Frf {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("one response", ValueAt::columns(false).described()), ("several", ValueAt::columns(true).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        let rows = self.responses.iter().flat_map(|pair| {
            let values = self.frequency_hz.iter().zip(&pair.real).zip(&pair.imag);
            values.map(move |((hz, re), im)| ValueAt { pair, hz: *hz, re: *re, im: *im })
        });
        ResultTable::new(ValueAt::columns(self.responses.len() > 1), rows)
    }
}

found!(Frf, "frf");
