//! `trajectory`: text.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant};
use funicular_study::analyses::trajectory::{self, Stations, TrajectoryResult, TrajectoryRow};
use std::fmt::Write as _;

/// Rows that the table shows.
const SHOWN: usize = 21;

/// Changes of limits that the text lists.
const CHANGES: usize = 6;

impl Printed for TrajectoryResult {
    fn text(&self) -> String {
        let has_winches = self.sums.is_some();
        let columns = TrajectoryRow::columns(&self.cables, has_winches, self.nearest.is_some());
        let step = self.rows.len().div_ceil(SHOWN).max(1);
        let shown = self.rows.iter().step_by(step);
        let table = Table::of(&columns, shown.clone());

        let mut text = format!(
            "{}: motion along a path, {} s{}\n{}\n",
            self.robot,
            significant(self.duration_s, 5),
            self.origin.phrase(),
            self.verdict(),
        );
        for of in &self.used {
            let _ = writeln!(text, "{}", self.told_use(of));
        }
        if let Some(factor) = self.inertia_factor {
            let _ =
                writeln!(text, "other tensions within the limits hold the inertia times {}", significant(factor, 4));
        }
        for of in &self.extremes {
            let place = of.value.map(|value| {
                let (value, time) = (significant(value, 4), significant(of.t_s, 4));
                format!("{value} {}, cable \"{}\", at {time} s", of.unit, of.cable)
            });
            let _ = match (&of.no_bound, place) {
                (Some(because), Some(place)) => {
                    writeln!(text, "{}: no bound, {because}; beside the jumps {place}", of.what)
                }
                (Some(because), None) => writeln!(text, "{}: no bound, {because}", of.what),
                (None, place) => writeln!(text, "{}: {}", of.what, place.unwrap_or_default()),
            };
        }
        if let Some(sums) = &self.sums {
            let _ = writeln!(
                text,
                "all motors: drive with {} W at {} s, brake with {} W at {} s",
                significant(sums.driving_power_w, 4),
                significant(sums.driving_t_s, 4),
                significant(sums.braking_power_w, 4),
                significant(sums.braking_t_s, 4)
            );
        }
        if let Some(of) = &self.nearest {
            let _ = writeln!(
                text,
                "nearest: {}, {} m (required {} m), at {} s",
                of.pair,
                decimals(of.distance_m, 4),
                decimals(of.required_m, 4),
                significant(of.t_s, 4)
            );
        }
        if !self.misses_m.is_empty() && self.misses_m.iter().any(|miss| *miss > 0.0) {
            let misses: Vec<String> = self.misses_m.iter().map(|miss| decimals(*miss, 3)).collect();
            let _ = writeln!(text, "the path passes its poses at {} m", misses.join(", "));
        }
        self.stations.iter().for_each(|of| text.push_str(&of_stations(of)));
        for command in &self.length_commands {
            let _ = writeln!(text, "{}", command.told);
        }
        text.push_str(&of_changes(self));
        for note in &self.notes {
            let _ = writeln!(text, "{note}");
        }
        let _ = write!(text, "\n{table}\n{} of {} shown.\n", shown.len(), counted(self.rows.len(), "row"));
        text
    }
}

/// Error of a controller with straight lines.
fn of_stations(of: &Stations) -> String {
    let mut text = format!(
        "straight lines of the lengths every {} s: up to {} mm off (cable \"{}\", at {} s)",
        significant(of.interval_s, 3),
        significant(1e3 * of.error_m, 3),
        of.cable,
        significant(of.t_s, 4)
    );
    if let (Some(moved), Some(tension)) = (of.displacement_m, of.lowest_tension_n) {
        let _ = write!(
            text,
            ", which moves the platform by {} mm and leaves {} N in the cable with the lowest tension",
            significant(1e3 * moved, 3),
            significant(tension, 3)
        );
    }
    let _ = writeln!(text, "; {} stations keep {} mm", of.needed, significant(1e3 * of.tolerance_m, 3));
    text
}

/// Times at which tensions reach limits or leave them.
fn of_changes(of: &TrajectoryResult) -> String {
    let change = |change: &trajectory::LimitChange| {
        let verb = if change.reached { "reaches" } else { "leaves" };
        format!("{} s: cable \"{}\" {verb} its {} tension", significant(change.t_s, 4), change.cable, change.limit)
    };
    let listed: Vec<String> = of.limit_changes.iter().take(CHANGES).map(change).collect();
    let more = of.limit_changes.len().saturating_sub(CHANGES);
    match (listed.is_empty(), more) {
        (true, _) => String::new(),
        (false, 0) => format!("rates of the lengths jump at {}\n", listed.join(", ")),
        (false, more) => format!("rates of the lengths jump at {} and {more} more\n", listed.join(", ")),
    }
}
