//! `frf`: one frequency response and its peaks.

use crate::args::FrfArgs;
use crate::grid;
use crate::output::Results;
use crate::progress::Progress;
use crate::state::{self, Models, directions};
use crate::table::{Table, counted, decimals, significant, vector};
use anyhow::Result;
use funicular::math::{Complex, Vec3};
use funicular::ports::{Input, Output, Places};
use funicular::response::{self, Peak, Quantity};
use funicular::robot::Robot;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Frequencies between two looks at the clock: some 10 ms. A multiple of every number of lanes, so that the numbers do
/// not depend on it.
const CHUNK: usize = 16_384;

#[derive(Serialize)]
pub(crate) struct Frf {
    #[serde(skip)]
    robot: String,
    #[serde(flatten)]
    models: Models,
    input: String,
    #[serde(flatten, serialize_with = "input_place")]
    input_place: PlaceRow,
    output: String,
    #[serde(flatten, serialize_with = "output_place")]
    output_place: PlaceRow,
    unit: String,
    prominence_db: f64,
    peaks: Vec<PeakRow>,
    frequency_hz: Vec<f64>,
    real: Vec<f64>,
    imag: Vec<f64>,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PeakRow {
    frequency_hz: f64,
    prominence_db: f64,
    magnitude: f64,
}

impl From<Peak> for PeakRow {
    fn from(peak: Peak) -> Self {
        let Peak { frequency_hz, prominence_db, magnitude } = peak;
        Self { frequency_hz, prominence_db, magnitude }
    }
}

pub(crate) fn run(robot: Robot, args: &FrfArgs) -> Result<Frf> {
    let frequencies = grid::frequencies(&args.range)?;
    let (input, output) = directions(&robot, &args.input, &args.output, &args.points)?;
    let at_rest = state::equilibrium(robot, &args.state)?;
    let linearisation = state::linearisation(&args.model, at_rest.equilibrium.model);
    let (dynamics, warnings) = at_rest.dynamics(linearisation, args.range.to_hz)?;

    let places = at_rest.places(&dynamics, args.input.on_cable.as_ref(), args.output.on_cable.as_ref())?;
    let pose = &at_rest.equilibrium.pose;
    let input = places.port(places.input, input.vector(pose), args.input.direction_w);
    let output = places.port(places.output, output.vector(pose), args.output.direction_w);
    let mut values: Vec<Complex> = Vec::with_capacity(frequencies.len());
    let mut progress = Progress::new(frequencies.len(), "frequencies");
    for chunk in frequencies.chunks(CHUNK) {
        values.extend(response::between(&dynamics, chunk, &input, &output, args.output.quantity)?);
        progress.advance(chunk.len());
    }
    let peaks = response::peaks(&frequencies, &values, args.prominence_db);
    Ok(Frf {
        robot: at_rest.robot.name.clone(),
        models: Models::of(&at_rest.equilibrium, linearisation),
        input: args.input.name.clone(),
        input_place: PlaceRow::of(&places, places.input, args.points.input_point_m),
        output: args.output.name.clone(),
        output_place: PlaceRow::of(&places, places.output, args.points.output_point_m),
        unit: unit(&args.input, &args.output),
        prominence_db: args.prominence_db,
        peaks: peaks.into_iter().map(PeakRow::from).collect(),
        frequency_hz: frequencies,
        real: values.iter().map(|value| value.re).collect(),
        imag: values.iter().map(|value| value.im).collect(),
        warnings,
    })
}

/// Where one end of a response is.
struct PlaceRow {
    /// The point is one of the world, at rest, and not of the platform frame.
    on_cable: bool,
    point_m: [f64; 3],
}

impl PlaceRow {
    fn of(places: &Places, place: Option<(usize, usize)>, point: Option<Vec3>) -> Self {
        match place {
            None => Self { on_cable: false, point_m: point.unwrap_or_default().into() },
            Some((at, station)) => Self { on_cable: true, point_m: places.stations[at].points_w[station].into() },
        }
    }

    fn serialize<S: Serializer>(&self, keys: [&'static str; 2], to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(Some(1))?;
        map.serialize_entry(keys[usize::from(self.on_cable)], &self.point_m)?;
        map.end()
    }

    fn text(&self) -> String {
        format!("({}) m{}", vector(&self.point_m, 3), if self.on_cable { " of the world" } else { "" })
    }
}

fn input_place<S: Serializer>(place: &PlaceRow, to: S) -> Result<S::Ok, S::Error> {
    place.serialize(["input_point_m", "input_point_w_m"], to)
}

fn output_place<S: Serializer>(place: &PlaceRow, to: S) -> Result<S::Ok, S::Error> {
    place.serialize(["output_point_m", "output_point_w_m"], to)
}

/// Unit of motion over excitation.
pub(crate) fn unit(input: &Input, output: &Output) -> String {
    let motion = if output.is_rotation { "rad" } else { "m" };
    let by_time = match output.quantity {
        Quantity::Displacement => "",
        Quantity::Velocity => "/s",
        Quantity::Acceleration => "/s²",
    };
    let effort = if input.is_moment { "(N·m)" } else { "N" };
    if by_time.is_empty() { format!("{motion}/{effort}") } else { format!("({motion}{by_time})/{effort}") }
}

impl Results for Frf {
    const COMMAND: &'static str = "frf";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let mut peaks = Table::new(&["peak [Hz]", "prominence [dB]", &format!("magnitude [{}]", self.unit)]);
        for peak in &self.peaks {
            peaks.row(vec![
                decimals(peak.frequency_hz, 4),
                decimals(peak.prominence_db, 2),
                significant(peak.magnitude, 5),
            ]);
        }
        let points = self.frequency_hz.len();
        let magnitude = |i: usize| significant(self.real[i].hypot(self.imag[i]), 5);
        let largest = (0..points)
            .max_by(|&i, &j| self.real[i].hypot(self.imag[i]).total_cmp(&self.real[j].hypot(self.imag[j])))
            .unwrap_or(0);
        format!(
            "{}: response of {} at {} to {} at {}\n{}\n\n\
             {points} frequencies from {} to {} Hz; largest magnitude {} {} at {} Hz\n\n{}\
             {} of at least {} dB. The whole curve: --format csv or --format json.\n",
            self.robot,
            self.output,
            self.output_place.text(),
            self.input,
            self.input_place.text(),
            self.models.line(),
            self.frequency_hz[0],
            self.frequency_hz[points - 1],
            magnitude(largest),
            self.unit,
            significant(self.frequency_hz[largest], 6),
            if self.peaks.is_empty() { String::new() } else { format!("{peaks}\n") },
            counted(self.peaks.len(), "peak"),
            self.prominence_db,
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record(["frequency_hz", "real", "imag", "magnitude", "phase_deg"])?;
        for ((frequency, re), im) in self.frequency_hz.iter().zip(&self.real).zip(&self.imag) {
            out.serialize((frequency, re, im, re.hypot(*im), im.atan2(*re).to_degrees()))?;
        }
        Ok(())
    }
}
