//! `compare`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, counted, decimals, short};
use funicular_study::analyses::compare::{Compared, ModelRow};
use funicular_study::analyses::shared::ModeRow;

impl Printed for Compared {
    fn text(&self) -> String {
        let others: Vec<&ModelRow> = self.models.iter().filter(|model| model.cable_model != self.reference).collect();
        let heads: Vec<String> = std::iter::once(format!("{} [Hz]", self.reference))
            .chain(["kind".to_owned()])
            .chain(others.iter().flat_map(|model| [format!("{} [Hz]", model.cable_model), "differs".to_owned()]))
            .collect();
        let mut table = Table::new(&heads.iter().map(String::as_str).collect::<Vec<_>>()).text_columns(&[1]);
        let reference: &[ModeRow] = reference(self).map_or(&[], |model| &model.modes);

        for (i, mode) in reference.iter().enumerate().filter(|(i, _)| self.compared.contains(i)) {
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
            "{}: cable models below {} Hz, each against {}{}\n{} statics, {} assembly{}{}\n\n",
            self.robot,
            self.below_hz,
            self.reference,
            self.platform_share.map_or_else(String::new, |share| {
                format!(", modes with at least {} % of their kinetic energy in the platform", short(100.0 * share, 4))
            }),
            self.static_model,
            self.assembly,
            if self.in_plane_only { ", in plane only" } else { "" },
            self.origin.phrase()
        );
        let mut lines = Vec::new();

        for model in others {
            let line = match (&model.error, model.first_wrong_hz) {
                (Some(error), _) => error.clone(),
                (None, None) if reference.is_empty() => "no modes, as the reference".to_owned(),
                (None, _) if self.platform_share.is_some() => platform_line(self, model),
                (None, None) => format!("all {} modes within {} %", reference.len(), short(100.0 * self.tolerance, 6)),
                (None, Some(first)) => format!(
                    "{} of {} modes within {} %, misses {}, first wrong at {} Hz",
                    model.within,
                    reference.len(),
                    short(100.0 * self.tolerance, 6),
                    model.missed,
                    decimals(first, 4)
                ),
            };
            lines.push(format!("  {:<17} {line}", model.cable_model));
        }

        let frozen = self.frozen_sag.as_ref().map_or_else(String::new, |frozen| format!("\n{}\n", frozen.text));
        let table = if self.compared.is_empty() { String::new() } else { format!("{table}\n") };
        format!("{head}{table}{}\n\n{}\n{frozen}", lines.join("\n"), self.advice.text)
    }
}

/// Agreement of one model on the modes of the platform.
fn platform_line(found: &Compared, model: &ModelRow) -> String {
    let total = found.compared.len();
    let wrong = model.first_wrong_hz.map_or_else(String::new, |hz| format!(", first wrong at {} Hz", decimals(hz, 4)));
    let largest = model
        .largest_difference
        .map_or_else(String::new, |difference| format!(", largest difference {}%", decimals(100.0 * difference, 2)));
    format!(
        "{} of {} found, {} within {} %{largest}{wrong}",
        total - model.missed,
        counted(total, "platform mode"),
        model.within,
        short(100.0 * found.tolerance, 6)
    )
}

fn reference(found: &Compared) -> Option<&ModelRow> {
    found.models.iter().find(|model| model.cable_model == found.reference)
}
