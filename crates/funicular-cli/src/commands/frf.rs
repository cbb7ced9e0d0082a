//! `frf`: one frequency response and its peaks.

use crate::args::values::{Input, Output};
use crate::args::{FrfArgs, PointArgs};
use crate::grid;
use crate::output::Results;
use crate::progress::Progress;
use crate::state::{self, Models};
use crate::table::{Table, counted, decimals, significant, vector};
use anyhow::{Result, bail};
use funicular::math::{Complex, Vec3};
use funicular::response::{self, Direction, Peak, Quantity};
use funicular::robot::{Freedoms, Robot};
use serde::Serialize;

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
    input_point_m: [f64; 3],
    output: String,
    output_point_m: [f64; 3],
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
    let linearisation = state::linearisation(&args.model);
    let (dynamics, warnings) = at_rest.dynamics(linearisation, args.range.to_hz)?;

    let pose = &at_rest.equilibrium.pose;
    let (input, output) = (input.vector(pose), output.vector(pose));
    let mut values: Vec<Complex> = Vec::with_capacity(frequencies.len());
    let mut progress = Progress::new(frequencies.len(), "frequencies");
    for chunk in frequencies.chunks(CHUNK) {
        values.extend(response::frf(&dynamics, chunk, &input, &output, args.output.quantity)?);
        progress.advance(chunk.len());
    }
    let peaks = response::peaks(&frequencies, &values, args.prominence_db);
    Ok(Frf {
        robot: at_rest.robot.name.clone(),
        models: Models::of(&at_rest.equilibrium, linearisation),
        input: args.input.name.clone(),
        input_point_m: args.points.input_point_m.unwrap_or_default().into(),
        output: args.output.name.clone(),
        output_point_m: args.points.output_point_m.unwrap_or_default().into(),
        unit: unit(&args.input, &args.output),
        prominence_db: args.prominence_db,
        peaks: peaks.into_iter().map(PeakRow::from).collect(),
        frequency_hz: frequencies,
        real: values.iter().map(|value| value.re).collect(),
        imag: values.iter().map(|value| value.im).collect(),
        warnings,
    })
}

/// Input and output of a response, checked against what the robot can do.
pub(crate) fn directions(
    robot: &Robot,
    input: &Input,
    output: &Output,
    points: &PointArgs,
) -> Result<(Direction, Direction)> {
    let from = Side { option: "--input", name: &input.name, turns: input.is_moment, direction_w: input.direction_w };
    let to =
        Side { option: "--output", name: &output.name, turns: output.is_rotation, direction_w: output.direction_w };
    Ok((from.direction(robot, points.input_point_m)?, to.direction(robot, points.output_point_m)?))
}

/// One end of a response.
struct Side<'a> {
    option: &'static str,
    name: &'a str,
    /// A moment or a rotation.
    turns: bool,
    direction_w: Vec3,
}

impl Side<'_> {
    fn direction(&self, robot: &Robot, point: Option<Vec3>) -> Result<Direction> {
        let Self { option, name, turns, direction_w } = *self;
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
            "{}: response of {} at ({}) m to {} at ({}) m\n{}\n\n\
             {points} frequencies from {} to {} Hz; largest magnitude {} {} at {} Hz\n\n{}\
             {} of at least {} dB. The whole curve: --format csv or --format json.\n",
            self.robot,
            self.output,
            vector(&self.output_point_m, 3),
            self.input,
            vector(&self.input_point_m, 3),
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
