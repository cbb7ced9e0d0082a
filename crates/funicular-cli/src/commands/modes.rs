//! `modes`: every natural frequency below a limit.

use crate::args::ModesArgs;
use crate::output::Results;
use crate::state::{self, Models};
use crate::table::{self, Table, counted, decimals, significant};
use anyhow::{Result, bail};
use funicular::dynamics::Dynamics;
use funicular::modes;
use funicular::robot::Robot;
use serde::Serialize;
use std::f64::consts::TAU;

/// Most modes of one list; a thousand take some 40 ms.
pub(crate) const MOST_MODES: usize = 20_000;

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
    cable_names: Vec<String>,
    modes: Vec<ModeRow>,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
pub(crate) struct ModeRow {
    pub(crate) frequency_hz: f64,
    pub(crate) multiplicity: usize,
    pub(crate) damping_ratio: f64,
    pub(crate) kind: &'static str,
    pub(crate) platform_energy_fraction: f64,
    pub(crate) cable_energy_fractions: Vec<f64>,
    pub(crate) shape: [f64; 6],
    pub(crate) residual: f64,
}

impl From<modes::Mode> for ModeRow {
    fn from(mode: modes::Mode) -> Self {
        Self {
            frequency_hz: mode.frequency_hz,
            multiplicity: mode.multiplicity,
            damping_ratio: mode.damping_ratio,
            kind: mode.kind.name(),
            platform_energy_fraction: mode.platform_energy_fraction,
            cable_energy_fractions: mode.cable_energy_fractions,
            // `+ 0.0` makes a negative zero positive.
            shape: mode.shape.map(|x| x + 0.0),
            residual: mode.residual,
        }
    }
}

/// Refuses a limit below which there are more modes than anyone reads.
pub(crate) fn check_count(dynamics: &Dynamics, below_hz: f64, most: usize) -> Result<()> {
    let count = dynamics.modes_below(below_hz * TAU);
    if count > most {
        bail!(
            "{count} natural frequencies lie below {below_hz} Hz, at most {most} are listed: lower --below-hz, or \
             use --cable-model spring, which has none of the cables' own"
        );
    }
    Ok(())
}

/// What to say of a list that is not certified.
pub(crate) fn uncertified(found: &modes::Modes) -> Option<String> {
    if found.certified {
        return None;
    }
    let modes::Modes { modes, count_below, unstable_directions, below_hz, .. } = found;
    let listed = counted(modes.len(), "mode");
    let inexact = modes.iter().max_by(|a, b| a.residual.total_cmp(&b.residual));
    Some(match inexact {
        Some(mode) if modes.len() + unstable_directions == *count_below && mode.residual <= modes::RESIDUAL_LIMIT => {
            format!(
                "the list of {listed} is not certified, though the count confirms its number: the exact cables are not \
             resolved up to {below_hz} Hz; lower the limit"
            )
        }
        Some(mode) if modes.len() + unstable_directions == *count_below => format!(
            "the list of {listed} is not certified, though the count confirms its number: the largest residual is \
             {:.1e}, of the mode at {:.4} Hz",
            mode.residual, mode.frequency_hz
        ),
        _ => format!(
            "the list of {listed} is not certified: the count says {count_below} below {below_hz} Hz \
             ({unstable_directions} of them unstable directions); modes may be missing or listed twice"
        ),
    })
}

pub(crate) fn run(robot: Robot, args: &ModesArgs) -> Result<Modes> {
    let at_rest = state::equilibrium(robot, &args.state)?;
    let linearisation = state::linearisation(&args.model, at_rest.equilibrium.model);
    let (dynamics, mut warnings) = at_rest.dynamics(linearisation, args.below_hz)?;
    check_count(&dynamics, args.below_hz, MOST_MODES)?;
    let found = modes::below(&dynamics, args.below_hz);
    warnings.extend(uncertified(&found));
    Ok(Modes {
        robot: at_rest.robot.name.clone(),
        below_hz: args.below_hz,
        models: Models::of(&at_rest.equilibrium, linearisation),
        count_below: found.count_below,
        certified: found.certified,
        unstable_directions: found.unstable_directions,
        cable_names: at_rest.robot.cables.iter().map(|cable| cable.name.clone()).collect(),
        modes: found.modes.into_iter().map(ModeRow::from).collect(),
        warnings,
    })
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
        let mut table = Table::new(&[
            "f [Hz]",
            "damping [%]",
            "platform [%]",
            "x",
            "y",
            "z",
            "rx [1/m]",
            "ry [1/m]",
            "rz [1/m]",
            "kind",
            "cables",
        ])
        .text_columns(&[9, 10]);
        for mode in &self.modes {
            let mut row = vec![
                decimals(mode.frequency_hz, 4),
                significant(100.0 * mode.damping_ratio, 3),
                decimals(100.0 * mode.platform_energy_fraction, 1),
            ];
            row.extend(mode.shape.iter().map(|x| decimals(*x, 2)));
            row.extend([mode.kind.to_owned(), self.strongest(mode)]);
            table.row(row);
        }
        format!(
            "{}: natural frequencies below {} Hz\n{}\n\n{}{}\n",
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
        ];
        let cables = self.cable_names.iter().map(|name| format!("energy_fraction_cable_{name}"));
        out.write_record(fixed.into_iter().map(str::to_owned).chain(cables))?;
        for mode in &self.modes {
            out.serialize((
                mode.frequency_hz,
                mode.multiplicity,
                mode.damping_ratio,
                mode.kind,
                mode.platform_energy_fraction,
                mode.shape,
                mode.residual,
                &mode.cable_energy_fractions,
            ))?;
        }
        Ok(())
    }
}
