//! `trajectory`: text and CSV, lengths for a controller, and a page.

use super::result_files::{OtherFile, ResultFiles};
use crate::args::{Cli, TrajectoryArgs};
use crate::number_table;
use crate::output::{Printed, as_csv};
use crate::pose_csv;
use crate::progress::TerminalProgress;
use crate::table::{Table, counted, decimals, significant};
use anyhow::Result;
use funicular_files::Guard;
use funicular_study::analyses::trajectory::{self, Stations, TrajectoryResult, TrajectoryRow};
use funicular_study::request::{NumberColumns, Request, TrajectoryRequest};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::fmt::Write as _;

/// Rows that the table shows.
const SHOWN: usize = 21;

/// Changes of limits that the text lists.
const CHANGES: usize = 6;

/// Request of a trajectory. Errors of its path name the line in the file.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    let files = cli.files::<TrajectoryArgs>()?;
    if let Request::Trajectory(of) = &mut request {
        of.via = pose_csv::read_if_given(files.via.as_deref(), &of.robot)?;
        if let Some(path) = &files.path {
            let robot = of.robot.read()?.robot;
            let check = |columns: &NumberColumns| trajectory::check_path(columns, &robot);
            of.path = Some(number_table::read(path, "the path", check)?);
        }
    }
    Ok(request)
}

/// Runs `trajectory`: prints the motion, and writes the lengths and the page.
pub(super) fn run(of: &TrajectoryRequest, args: &TrajectoryArgs, guard: &mut Guard) -> Result<()> {
    for (what, path) in [("the path", &args.path), ("the poses", &args.via)] {
        if let Some(path) = path {
            guard.reads(what, path);
        }
    }
    // Errors of the robot file are reported before errors of the destinations.
    let robot = of.robot.read()?.robot;
    let lengths = OtherFile::lengths(args.lengths.as_deref());
    let files = ResultFiles::open(&args.sink, lengths, args.page.as_deref(), guard)?;

    let mut watch = TerminalProgress::new();
    let found = trajectory::run(robot.clone(), of, &mut watch)?;
    drop(watch);
    files.write(
        &found,
        || as_csv(found.lengths_table()),
        || {
            let page = funicular_pages::pages::trajectory::page(&robot, &found, super::page::command_line()?)?;
            Ok(worded(&page, Words::Program))
        },
    )
}

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
