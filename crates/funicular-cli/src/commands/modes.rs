//! `modes`: every natural frequency below a limit.

use crate::args::ModesArgs;
use crate::commands::cable::Axes;
use crate::commands::frf;
use crate::output::Results;
use crate::state::{self, AtRest, Models};
use crate::table::{self, Table, counted, decimals, significant};
use anyhow::Result;
use funicular::cable_motion::CableStations;
use funicular::dynamics::Dynamics;
use funicular::modes;
use funicular::response::Quantity;
use funicular::robot::Robot;
use serde::Serialize;
use std::f64::consts::TAU;

#[derive(Serialize)]
#[expect(clippy::struct_field_names, reason = "`modes` is a key of the JSON")]
pub(crate) struct Modes {
    #[serde(skip)]
    robot: String,
    below_hz: f64,
    #[serde(flatten)]
    models: Models,
    count_below: usize,
    certified: bool,
    unstable_directions: usize,
    /// Whether every mode has its damped partner, counted; absent where damping ratios are of first order.
    #[serde(skip_serializing_if = "Option::is_none")]
    damped_certified: Option<bool>,
    cable_names: Vec<String>,
    #[serde(flatten)]
    participation: Option<Participation>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    stations: Vec<StationsRow>,
    modes: Vec<ModeRow>,
    #[serde(skip)]
    warnings: Vec<String>,
}

/// The pair whose response the modes take part in.
#[derive(Serialize)]
struct Participation {
    input: String,
    output: String,
    /// Of `peak`.
    peak_unit: String,
}

/// Where the displacements of `cable_shapes` are.
#[derive(Serialize)]
struct StationsRow {
    cable: String,
    arc_length_m: Vec<f64>,
    position_m: Vec<[f64; 3]>,
    axes: Axes,
}

#[derive(Serialize)]
pub(crate) struct ModeRow {
    pub(crate) frequency_hz: f64,
    pub(crate) multiplicity: usize,
    pub(crate) damping_ratio: f64,
    /// λ = −ζω + iω√(1 − ζ²), real and imaginary part.
    #[serde(skip_serializing_if = "Option::is_none")]
    eigenvalue_per_s: Option<[f64; 2]>,
    pub(crate) kind: &'static str,
    pub(crate) platform_energy_fraction: f64,
    pub(crate) cable_energy_fractions: Vec<f64>,
    pub(crate) shape: [f64; 6],
    modal_mass_kg: f64,
    pub(crate) residual: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    residue_per_kg: Option<f64>,
    /// Height of the mode's own peak.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak: Option<f64>,
    /// For each cable, displacement (e, n, b) of each station, in the scale of `shape`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    cable_shapes: Vec<Vec<[f64; 3]>>,
}

impl From<modes::Mode> for ModeRow {
    fn from(mode: modes::Mode) -> Self {
        Self {
            frequency_hz: mode.frequency_hz,
            multiplicity: mode.multiplicity,
            damping_ratio: mode.damping_ratio,
            eigenvalue_per_s: None,
            kind: mode.kind.name(),
            platform_energy_fraction: mode.platform_energy_fraction,
            cable_energy_fractions: mode.cable_energy_fractions,
            // `+ 0.0` makes a negative zero positive.
            shape: mode.shape.map(|x| x + 0.0),
            modal_mass_kg: mode.modal_mass,
            residual: mode.residual,
            residue_per_kg: None,
            peak: None,
            cable_shapes: Vec::new(),
        }
    }
}

pub(crate) fn run(robot: Robot, args: &ModesArgs) -> Result<Modes> {
    let pair = args.input.as_ref().zip(args.output.as_ref());
    let directions = pair.map(|(input, output)| state::directions(&robot, input, output, &args.points)).transpose()?;
    let at_rest = state::equilibrium(robot, &args.state)?;
    let linearisation = state::linearisation(&args.model, at_rest.equilibrium.model);
    let (dynamics, mut warnings) = at_rest.dynamics(linearisation, args.below_hz)?;
    modes::check_count(&dynamics, args.below_hz, modes::MOST)?;
    let found = modes::below(&dynamics, args.below_hz);
    warnings.extend(found.doubt());
    let AtRest { robot, equilibrium, .. } = &at_rest;

    let mut rows: Vec<ModeRow> = found.modes.iter().cloned().map(ModeRow::from).collect();
    let (damped, doubt) = modes::damped_partners(&dynamics, &found);
    warnings.extend(doubt);
    if let Some(damped) = &damped {
        for (row, mode) in rows.iter_mut().zip(&damped.modes) {
            let eigenvalue = mode.eigenvalue();
            row.damping_ratio = mode.damping_ratio();
            row.eigenvalue_per_s = Some([eigenvalue.re, eigenvalue.im]);
        }
    }
    let mut participation = None;
    if let (Some((input, output)), Some((from, to))) = (pair, directions) {
        let places = at_rest.places(&dynamics, input.on_cable.as_ref(), output.on_cable.as_ref())?;
        let pose = &equilibrium.pose;
        let from = places.port(places.input, from.vector(pose), input.direction_w);
        let to = places.port(places.output, to.vector(pose), output.direction_w);
        for (row, mode) in rows.iter_mut().zip(&found.modes) {
            let residue = from.in_mode(&dynamics, mode) * to.in_mode(&dynamics, mode) / mode.modal_mass;
            let omega = mode.frequency_hz * TAU;
            let by_time = match output.quantity {
                Quantity::Displacement => 1.0,
                Quantity::Velocity => omega,
                Quantity::Acceleration => omega * omega,
            };
            row.residue_per_kg = Some(residue + 0.0);
            let damping = 2.0 * row.damping_ratio * omega * omega;
            row.peak = (damping > 0.0).then(|| residue.abs() * by_time / damping);
        }
        let peak_unit = frf::unit(input, output);
        participation = Some(Participation { input: input.name.clone(), output: output.name.clone(), peak_unit });
    }
    let stations = args.stations.map_or(Ok(Vec::new()), |count| stations(&at_rest, &dynamics, count))?;
    for (row, mode) in rows.iter_mut().zip(&found.modes) {
        row.cable_shapes = stations.iter().map(|of| of.in_mode(&dynamics, mode)).collect();
    }
    Ok(Modes {
        robot: robot.name.clone(),
        below_hz: args.below_hz,
        models: Models::of(equilibrium, linearisation),
        count_below: found.count_below,
        certified: found.certified,
        unstable_directions: found.unstable_directions,
        damped_certified: damped.map(|damped| damped.certified),
        cable_names: robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        participation,
        stations: stations.iter().map(|of| StationsRow::of(robot, of)).collect(),
        modes: rows,
        warnings,
    })
}

/// Equal steps along every cable.
fn stations(at_rest: &AtRest, dynamics: &Dynamics, count: usize) -> Result<Vec<CableStations>> {
    let AtRest { robot, equilibrium, .. } = at_rest;
    let fractions: Vec<f64> = (0..count).map(|i| i as f64 / (count - 1) as f64).collect();
    let of = |i: usize| Ok(CableStations::new(robot, equilibrium, dynamics, i, &fractions, false)?);
    (0..robot.cables.len()).map(of).collect()
}

impl StationsRow {
    fn of(robot: &Robot, stations: &CableStations) -> Self {
        Self {
            cable: robot.cables[stations.cable].name.clone(),
            arc_length_m: stations.arc_lengths.clone(),
            position_m: stations.points_w.iter().map(|point| (*point).into()).collect(),
            axes: Axes::of(&stations.axes),
        }
    }
}

impl Modes {
    /// The sentence that says what the list is worth.
    fn certificate(&self) -> String {
        let listed = counted(self.modes.len(), "mode");
        let unstable = match self.unstable_directions {
            0 => String::new(),
            n => format!(" and {} without a frequency", counted(n, "unstable direction")),
        };
        let Self { count_below, below_hz, .. } = self;
        if self.certified {
            format!(
                "Certified: the Wittrick–Williams count below {below_hz} Hz is {count_below}, the list has {listed}\
                 {unstable}; none is missing."
            )
        } else {
            format!(
                "NOT certified: the Wittrick–Williams count below {below_hz} Hz is {count_below}, the list has {listed}\
                 {unstable}."
            )
        }
    }

    /// The cables that move most, with their shares of the energy.
    fn strongest(&self, mode: &ModeRow) -> String {
        let names = self.cable_names.iter().map(String::as_str);
        let shown: Vec<String> = strongest(names, &mode.cable_energy_fractions)
            .iter()
            .map(|(name, share)| format!("{name} {}%", decimals(100.0 * share, 0)))
            .collect();
        if shown.is_empty() { table::NONE.to_owned() } else { shown.join(", ") }
    }
}

/// Of cables by name and their shares of a mode's energy the first few that matter.
pub(crate) fn strongest<'a>(names: impl Iterator<Item = &'a str>, shares: &[f64]) -> Vec<(&'a str, f64)> {
    const SHOWN: usize = 3;
    // A share that rounds to less than this tells nothing.
    const LEAST: f64 = 0.05;
    let mut all: Vec<(&str, f64)> = names.zip(shares.iter().copied()).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.retain(|(_, share)| *share >= LEAST);
    all.truncate(SHOWN);
    all
}

impl Results for Modes {
    const COMMAND: &'static str = "modes";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let peak = self.participation.as_ref().map(|of| format!("peak [{}]", of.peak_unit));
        let mut heads = vec!["f [Hz]", "damping [%]"];
        heads.extend(peak.as_deref());
        heads.extend(["platform [%]", "x", "y", "z", "rx [1/m]", "ry [1/m]", "rz [1/m]", "kind", "cables"]);
        let mut table = Table::new(&heads).text_columns(&[heads.len() - 2, heads.len() - 1]);
        for mode in &self.modes {
            let mut row = vec![decimals(mode.frequency_hz, 4), significant(100.0 * mode.damping_ratio, 3)];
            if self.participation.is_some() {
                row.push(mode.peak.map_or(table::NONE.to_owned(), |peak| significant(peak, 3)));
            }
            row.push(decimals(100.0 * mode.platform_energy_fraction, 1));
            row.extend(mode.shape.iter().map(|x| decimals(*x, 2)));
            row.extend([mode.kind.to_owned(), self.strongest(mode)]);
            table.row(row);
        }
        let pair = match &self.participation {
            None => String::new(),
            Some(Participation { input, output, .. }) => {
                format!("peak: what each mode alone adds to the response of {output} to {input} at its frequency\n")
            }
        };
        format!(
            "{}: natural frequencies below {} Hz\n{}\n{pair}\n{}{}\n",
            self.robot,
            self.below_hz,
            self.models.line(),
            if self.modes.is_empty() { String::new() } else { format!("{table}\n") },
            self.certificate()
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        let fixed = [
            "frequency_hz",
            "multiplicity",
            "damping_ratio",
            "kind",
            "platform_energy_fraction",
            "shape_x",
            "shape_y",
            "shape_z",
            "shape_rx_per_m",
            "shape_ry_per_m",
            "shape_rz_per_m",
            "residual",
            "modal_mass_kg",
            "residue_per_kg",
            "peak",
        ];
        let cables = self.cable_names.iter().map(|name| format!("energy_fraction_cable_{name}"));
        out.write_record(fixed.into_iter().map(str::to_owned).chain(cables))?;
        for mode in &self.modes {
            out.serialize((
                (mode.frequency_hz, mode.multiplicity, mode.damping_ratio, mode.kind, mode.platform_energy_fraction),
                mode.shape,
                (mode.residual, mode.modal_mass_kg, mode.residue_per_kg, mode.peak),
                &mode.cable_energy_fractions,
            ))?;
        }
        Ok(())
    }
}
