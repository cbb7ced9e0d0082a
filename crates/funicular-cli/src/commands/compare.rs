//! `compare`: every cable model side by side.

use crate::args::CompareArgs;
use crate::commands::modes::ModeRow;
use crate::output::Results;
use crate::state;
use crate::table::{self, Table, decimals};
use anyhow::Result;
use funicular::cable::CableModel;
use funicular::compare::{self, Comparison, ModelResult, TOLERANCE};
use funicular::dynamics::Linearisation;
use funicular::modes;
use funicular::robot::Robot;
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Compared {
    #[serde(skip)]
    robot: String,
    below_hz: f64,
    static_model: &'static str,
    assembly: &'static str,
    in_plane_only: bool,
    reference: &'static str,
    tolerance: f64,
    models: Vec<ModelRow>,
    advice: AdviceRow,
    #[serde(skip)]
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct ModelRow {
    cable_model: &'static str,
    /// Why the model has no modes here.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    modes: Vec<ModeRow>,
    count_below: usize,
    certified: bool,
    matches: Vec<MatchRow>,
    missed: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    first_wrong_hz: Option<f64>,
}

#[derive(Serialize)]
struct MatchRow {
    frequency_hz: f64,
    reference_hz: f64,
    reference_index: usize,
    relative_difference: f64,
    correlation: f64,
}

#[derive(Serialize)]
struct AdviceRow {
    cable_model: &'static str,
    text: String,
}

pub(crate) fn run(robot: Robot, args: &CompareArgs) -> Result<Compared> {
    let at_rest = state::equilibrium(robot, &args.state)?;
    let linearisation = Linearisation {
        // For the number of modes, before any work; the models follow.
        cable_model: CableModel::ClosedForm,
        assembly: args.terms.assembly.into(),
        in_plane_only: args.terms.in_plane_only,
    };
    let (reference, mut warnings) = at_rest.dynamics(linearisation, args.below_hz)?;
    modes::check_count(&reference, args.below_hz, modes::MOST)?;
    let found = compare::compare(&at_rest.robot, &at_rest.equilibrium, args.below_hz, linearisation)?;
    let Comparison { below_hz, reference, models, advice } = found;
    for model in &models {
        if let Some(warning) = model.modes.as_ref().ok().and_then(modes::Modes::doubt) {
            warnings.push(format!("{}: {warning}", model.model));
        }
    }
    Ok(Compared {
        robot: at_rest.robot.name.clone(),
        below_hz,
        static_model: at_rest.equilibrium.model.name(),
        assembly: linearisation.assembly.name(),
        in_plane_only: linearisation.in_plane_only,
        reference: reference.name(),
        tolerance: TOLERANCE,
        models: models.into_iter().map(ModelRow::from).collect(),
        advice: AdviceRow { cable_model: advice.model.name(), text: advice.text },
        warnings,
    })
}

impl From<ModelResult> for ModelRow {
    fn from(result: ModelResult) -> Self {
        let (modes, count_below, certified, error) = match result.modes {
            Ok(found) => {
                (found.modes.into_iter().map(ModeRow::from).collect(), found.count_below, found.certified, None)
            }
            Err(error) => (Vec::new(), 0, false, Some(error.to_string())),
        };
        let matches = result
            .matches
            .into_iter()
            .map(|m| MatchRow {
                frequency_hz: m.frequency_hz,
                reference_hz: m.reference_hz,
                reference_index: m.reference_index,
                relative_difference: m.relative_difference,
                correlation: m.correlation,
            })
            .collect();
        let (missed, first_wrong_hz) = (result.missed, result.first_wrong_hz);
        Self { cable_model: result.model.name(), error, modes, count_below, certified, matches, missed, first_wrong_hz }
    }
}

impl Compared {
    fn reference(&self) -> Option<&ModelRow> {
        self.models.iter().find(|model| model.cable_model == self.reference)
    }
}

impl Results for Compared {
    const COMMAND: &'static str = "compare";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn text(&self) -> String {
        let others: Vec<&ModelRow> = self.models.iter().filter(|model| model.cable_model != self.reference).collect();
        let heads: Vec<String> = std::iter::once(format!("{} [Hz]", self.reference))
            .chain(["kind".to_owned()])
            .chain(others.iter().flat_map(|model| [format!("{} [Hz]", model.cable_model), "differs".to_owned()]))
            .collect();
        let mut table = Table::new(&heads.iter().map(String::as_str).collect::<Vec<_>>()).text_columns(&[1]);
        let reference: &[ModeRow] = self.reference().map_or(&[], |model| &model.modes);
        for (i, mode) in reference.iter().enumerate() {
            let mut row = vec![decimals(mode.frequency_hz, 4), mode.kind.to_owned()];
            for model in &others {
                match model.matches.iter().find(|m| m.reference_index == i) {
                    Some(m) => row.extend([
                        decimals(m.frequency_hz, 4),
                        format!("{}%", decimals(100.0 * m.relative_difference, 2)),
                    ]),
                    None => row.extend([table::NONE.to_owned(), String::new()]),
                }
            }
            table.row(row);
        }
        let head = format!(
            "{}: cable models below {} Hz, each against {}\n{} statics, {} assembly{}\n\n",
            self.robot,
            self.below_hz,
            self.reference,
            self.static_model,
            self.assembly,
            if self.in_plane_only { ", in plane only" } else { "" }
        );
        let mut lines = Vec::new();
        for model in others {
            let line = match (&model.error, model.first_wrong_hz) {
                (Some(error), _) => error.clone(),
                (None, None) if reference.is_empty() => "no modes, as the reference".to_owned(),
                (None, None) => format!("all {} modes within {} %", reference.len(), 100.0 * self.tolerance),
                (None, Some(first)) => format!(
                    "{} of {} modes, misses {}, first wrong at {} Hz",
                    model.modes.len(),
                    reference.len(),
                    model.missed,
                    decimals(first, 4)
                ),
            };
            lines.push(format!("  {:<17} {line}", model.cable_model));
        }
        let table = if reference.is_empty() { String::new() } else { format!("{table}\n") };
        format!("{head}{table}{}\n\n{}\n", lines.join("\n"), self.advice.text)
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "cable_model",
            "frequency_hz",
            "kind",
            "platform_energy_fraction",
            "reference_hz",
            "relative_difference",
            "correlation",
        ])?;
        for model in &self.models {
            // Matches are in the order of the modes; a mode of a platform at rest has none.
            let mut matches = model.matches.iter().peekable();
            for mode in &model.modes {
                let found = matches.next_if(|m| m.frequency_hz.to_bits() == mode.frequency_hz.to_bits());
                out.serialize((
                    model.cable_model,
                    mode.frequency_hz,
                    mode.kind,
                    mode.platform_energy_fraction,
                    found.map(|m| m.reference_hz),
                    found.map(|m| m.relative_difference),
                    found.map(|m| m.correlation),
                ))?;
            }
        }
        Ok(())
    }
}
