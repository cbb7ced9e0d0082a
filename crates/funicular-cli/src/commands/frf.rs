//! `frf`: one frequency response and its peaks.

use crate::args::values::{Input, OnCable, Output};
use crate::args::{FrfArgs, PointArgs};
use crate::grid;
use crate::output::Results;
use crate::progress::Progress;
use crate::set;
use crate::state::{self, AtRest, Models};
use crate::table::{Table, counted, decimals, significant, vector};
use anyhow::{Result, anyhow, bail};
use funicular::cable_motion::CableStations;
use funicular::dynamics::Dynamics;
use funicular::math::{Complex, Vec3, Vec6};
use funicular::response::{self, Direction, Peak, Port, Quantity};
use funicular::robot::{Freedoms, Robot};
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

    let places = Places::new(&at_rest, &dynamics, args.input.on_cable.as_ref(), args.output.on_cable.as_ref())?;
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
        input_place: places.row(places.input, args.points.input_point_m),
        output: args.output.name.clone(),
        output_place: places.row(places.output, args.points.output_point_m),
        unit: unit(&args.input, &args.output),
        prominence_db: args.prominence_db,
        peaks: peaks.into_iter().map(PeakRow::from).collect(),
        frequency_hz: frequencies,
        real: values.iter().map(|value| value.re).collect(),
        imag: values.iter().map(|value| value.im).collect(),
        warnings,
    })
}

/// The points on cables where a response begins or ends.
struct Places {
    stations: Vec<CableStations>,
    /// Which stations, and which of them; `None` on the platform.
    input: Option<(usize, usize)>,
    output: Option<(usize, usize)>,
}

impl Places {
    fn new(at_rest: &AtRest, dynamics: &Dynamics, input: Option<&OnCable>, output: Option<&OnCable>) -> Result<Self> {
        let AtRest { robot, equilibrium } = at_rest;
        let stations =
            |i: usize, fractions: &[f64]| CableStations::new(robot, equilibrium, dynamics, i, fractions, true);
        let cable = |place: &OnCable| cable_of(robot, place);
        let mut places = Self { stations: Vec::new(), input: None, output: None };
        if let (Some(from), Some(to)) = (input, output)
            && from.name == to.name
        {
            places.stations.push(stations(cable(from)?, &[from.fraction, to.fraction])?);
            return Ok(Self { input: Some((0, 0)), output: Some((0, 1)), ..places });
        }
        for (place, end) in [(input, &mut places.input), (output, &mut places.output)] {
            if let Some(place) = place {
                *end = Some((places.stations.len(), 0));
                places.stations.push(stations(cable(place)?, &[place.fraction])?);
            }
        }
        Ok(places)
    }

    /// The port at a place: with the platform's vector if it is not on a cable.
    fn port(&self, place: Option<(usize, usize)>, vector: Vec6, direction_w: Vec3) -> Port<'_> {
        match place {
            None => Port::Platform(vector),
            Some((at, station)) => {
                let stations = &self.stations[at];
                Port::Cable { stations, station, direction_w: direction_w.normalize() }
            }
        }
    }

    fn row(&self, place: Option<(usize, usize)>, point: Option<Vec3>) -> PlaceRow {
        match place {
            None => PlaceRow { on_cable: false, point_m: point.unwrap_or_default().into() },
            Some((at, station)) => PlaceRow { on_cable: true, point_m: self.stations[at].points_w[station].into() },
        }
    }
}

fn cable_of(robot: &Robot, place: &OnCable) -> Result<usize> {
    robot.cables.iter().position(|cable| cable.name == place.name).ok_or_else(|| {
        let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        anyhow!("the robot has no cable \"{}\"{}", place.name, set::suggestion(&place.name, &names))
    })
}

/// Where one end of a response is.
struct PlaceRow {
    /// The point is one of the world, at rest, and not of the platform frame.
    on_cable: bool,
    point_m: [f64; 3],
}

impl PlaceRow {
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

/// Input and output of a response, checked against what the robot can do.
pub(crate) fn directions(
    robot: &Robot,
    input: &Input,
    output: &Output,
    points: &PointArgs,
) -> Result<(Direction, Direction)> {
    let from = Side {
        option: "--input",
        name: &input.name,
        turns: input.is_moment,
        on_cable: input.on_cable.is_some(),
        direction_w: input.direction_w,
    };
    let to = Side {
        option: "--output",
        name: &output.name,
        turns: output.is_rotation,
        on_cable: output.on_cable.is_some(),
        direction_w: output.direction_w,
    };
    Ok((from.direction(robot, points.input_point_m)?, to.direction(robot, points.output_point_m)?))
}

/// One end of a response.
struct Side<'a> {
    option: &'static str,
    name: &'a str,
    /// A moment or a rotation.
    turns: bool,
    on_cable: bool,
    direction_w: Vec3,
}

impl Side<'_> {
    fn direction(&self, robot: &Robot, point: Option<Vec3>) -> Result<Direction> {
        let Self { option, name, turns, on_cable, direction_w } = *self;
        if on_cable && point.is_some() {
            bail!("{option}-point-m is a point of the platform: {option} {name} is on a cable; remove it");
        }
        if turns && point.is_some() {
            bail!("{option}-point-m has no effect: {option} {name} is the same at every point; remove it");
        }
        check_point_mass(robot, turns, option, name, point)?;
        Ok(if turns {
            Direction::About { axis_w: direction_w }
        } else {
            Direction::Along { direction_w, point_p: point.unwrap_or_default() }
        })
    }
}

/// A point mass neither turns nor extends.
fn check_point_mass(robot: &Robot, turns: bool, option: &str, name: &str, point: Option<Vec3>) -> Result<()> {
    if robot.platform.freedoms == Freedoms::Rigid {
        return Ok(());
    }
    if turns {
        bail!(
            "a point mass does not turn: {option} {name} is not possible; use a force (fx) and a translation (x, vx, ax)"
        );
    }
    if point.is_some_and(|point| point.norm() > 0.0) {
        bail!("a point mass has no points but its origin: remove {option}-point-m");
    }
    Ok(())
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
