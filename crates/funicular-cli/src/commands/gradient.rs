//! `gradient`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, significant};
use funicular_study::analyses::gradient::{GradientParameter, GradientResult, GradientTable};
use std::fmt::Write as _;

/// Number of derivatives that the text shows for each result.
const SHOWN: usize = 10;

impl Printed for GradientTable {
    fn text(&self) -> String {
        let step = match self.per {
            "percent" => "percent of each number",
            "tolerance" => "tolerance of each number",
            _ => "unit of each number",
        };
        let mut out =
            format!("{}: derivatives per {step}\n{}\nHeld: {}.\n", self.robot, self.models.line(), self.held_means);

        for result in &self.results {
            let _ = write!(out, "\n{} = {} {}\n", result.name, significant(result.value, 8), result.unit);
            out += &largest(self, result).to_string();
        }
        if self.results.iter().any(|result| result.derivatives.len() > SHOWN) {
            let _ = write!(
                out,
                "\nThe {SHOWN} largest of {} numbers are shown, by their effect over the tolerance of each number; \
                 JSON and CSV have all.\n",
                self.parameters.len()
            );
        }
        if self.results.iter().any(|result| result.block_entry.is_some()) {
            out += "\nModes that share a frequency have a block of derivatives: along a change, the derivatives of \
                    their frequencies are the eigenvalues of the block.\n";
        }

        for refused in &self.refused {
            let _ = write!(out, "\n{}: {}\n", refused.name, refused.reason);
        }
        out
    }
}

/// Table of the derivatives with the largest effect over the tolerances of the numbers.
fn largest(of: &GradientTable, result: &GradientResult) -> Table {
    // Effect over the tolerance, the only step that all kinds of numbers have.
    let effect = |parameter: &GradientParameter, derivative: f64| match of.per {
        "percent" if parameter.value == 0.0 => 0.0,
        "percent" => derivative / (0.01 * parameter.value.abs()) * parameter.tolerance,
        "tolerance" => derivative,
        _ => derivative * parameter.tolerance,
    };
    let mut order: Vec<(f64, usize)> = (of.parameters.iter().zip(&result.derivatives).enumerate())
        .map(|(k, (parameter, derivative))| (effect(parameter, *derivative), k))
        .collect();
    order.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));

    let per_step = |parameter: &GradientParameter| match of.per {
        "percent" => format!("{} per %", result.unit),
        "tolerance" => result.unit.clone(),
        _ => format!("{} per {}", result.unit, parameter.unit),
    };
    let mut table = Table::new(&["number", "value", "unit", "derivative", "unit of it", "tolerance", "effect of it"])
        .text_columns(&[2, 4]);
    for (effect, k) in order.into_iter().take(SHOWN) {
        let (parameter, derivative) = (&of.parameters[k], result.derivatives[k]);
        table.row(vec![
            parameter.path.clone(),
            significant(parameter.value, 6),
            parameter.unit.to_owned(),
            significant(derivative, 5),
            per_step(parameter),
            significant(parameter.tolerance, 3),
            significant(effect, 3),
        ]);
    }
    table
}
