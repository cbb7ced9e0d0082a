//! `estimate`: text.

use crate::output::Printed;
use crate::table::{Table, decimals, significant};
use funicular_study::analyses::estimate::{CableErrors, EstimateAlarm, EstimateRow, Estimated, SensorFit};
use std::fmt::Write as _;

impl Printed for Estimated {
    fn text(&self) -> String {
        let mut text = format!("{}: estimate from a log of {} rows\n{}\n", self.robot, self.log_rows, self.summary());
        if let Some(row) = self.rows.last() {
            let _ = write!(text, "\n{}", at_the_end(row));
        }
        if !self.alarms.is_empty() {
            let _ = write!(text, "\n{}", Table::of(&EstimateAlarm::columns(), &self.alarms));
        }
        if !self.sensors.is_empty() {
            let _ = write!(text, "\n{}", Table::of(&SensorFit::columns(), &self.sensors));
        }
        let _ = write!(text, "\n{}", Table::of(&CableErrors::columns(), &self.cable_errors));
        for sentence in &self.not_determined {
            let _ = writeln!(text, "{}.", capital(sentence));
        }
        text
    }
}

/// State at the end of the log.
fn at_the_end(row: &EstimateRow) -> String {
    let with = |value: String, std: Option<String>| match std {
        Some(std) => format!("{value} ± {std}"),
        None => value,
    };
    let three = |values: [f64; 3], stds: Option<[f64; 3]>, factor: f64, count: usize| {
        let part =
            |k: usize| with(decimals(factor * values[k], count), stds.map(|stds| significant(factor * stds[k], 2)));
        (0..3).map(part).collect::<Vec<_>>().join(", ")
    };
    let payload = with(decimals(row.payload_kg, 2), row.payload_std_kg.map(|std| significant(std, 2)));
    let slack = ["slack", "unknown"].map(|state| row.slack.iter().filter(|of| **of == state).count());
    format!(
        "At {} s:\nposition  {} mm\nturn      {} deg (roll, pitch, yaw)\nvelocity  {} mm/s\npayload   {payload} kg\n\
         tensions  {} to {} N; slack: {}, not known: {}\n",
        decimals(row.t_s, 3),
        three(row.pose.position_m, row.position_std_m, 1e3, 2),
        three(row.pose.roll_pitch_yaw_deg, row.rotation_std_deg, 1.0, 3),
        three(row.velocity_m_s, row.velocity_std_m_s, 1e3, 2),
        significant(row.tensions_n.iter().copied().fold(f64::INFINITY, f64::min), 4),
        significant(row.tensions_n.iter().copied().fold(f64::NEG_INFINITY, f64::max), 4),
        slack[0],
        slack[1],
    )
}

/// Sentence with a capital letter.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
