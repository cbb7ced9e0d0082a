//! `observability`: text.

use super::estimate::capital;
use crate::output::Printed;
use crate::table::{NONE, Table, significant};
use funicular_study::analyses::observability::{Observed, ObservedCase, ObservedNumber};
use std::fmt::Write as _;

impl Printed for Observed {
    fn text(&self) -> String {
        let poses = if self.poses == 1 { "one pose".to_owned() } else { format!("{} poses", self.poses) };
        let sensors = if self.sensors.is_empty() { String::new() } else { format!(" and {}", self.sensors.join(", ")) };
        let mut text = format!(
            "{}: what lengths{sensors} determine at {poses} at rest\n\n{}\n{}",
            self.robot,
            numbers(&self.numbers),
            Table::of(&ObservedCase::columns(), &self.cases),
        );
        match &self.best_addition {
            Some(best) => {
                let _ = writeln!(text, "\nMost would be added by: {}.", best.trim_start_matches("and "));
            }
            None => text.push_str("\nNo sensor or pose that was tried adds anything.\n"),
        }
        for sentence in &self.not_determined {
            let _ = writeln!(text, "{}.", capital(sentence));
        }
        text
    }
}

/// Table of the numbers.
fn numbers(rows: &[ObservedNumber]) -> String {
    let header = ["number", "±", "", "encoders alone ±", "known by", "best addition", "±"];
    let mut table = Table::new(&header).text_columns(&[0, 2, 4, 5]);
    for row in rows {
        table.row(vec![
            row.number.clone(),
            significant(row.std, 3),
            row.unit.to_owned(),
            significant(row.std_of_lengths, 3),
            row.determined.to_owned(),
            row.best_addition.clone().unwrap_or_else(|| NONE.to_owned()),
            row.std_with_addition.map_or_else(|| NONE.to_owned(), |std| significant(std, 3)),
        ]);
    }
    table.to_string()
}
