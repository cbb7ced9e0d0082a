//! `calibrate`: readings, text and CSV, and the robot file.

use super::profile_table::{Profiled, profiles};
use super::result_files::{OtherFile, ResultFiles};
use crate::args::{CalibrateArgs, Cli, DrawArgs, OutputArgs};
use crate::number_table;
use crate::output::{FigureSink, Printed};
use crate::pose_csv;
use crate::progress::TerminalProgress;
use crate::table::{Table, counted, significant};
use anyhow::Result;
use funicular_files::Guard;
use funicular_pages::figures;
use funicular_study::analyses::calibrate::{
    self, Calibrated, CalibratedValue, DistanceRow, LeftOut, ProposalRow, ReadingRow, check_readings,
};
use funicular_study::request::{CalibrateRequest, GappedColumns, Request};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::fmt::Write as _;

/// Request of a calibration. Errors of its readings name the line in the file.
pub(super) fn request(cli: &Cli, mut further: Map<String, Value>) -> Result<Request> {
    let files = cli.files::<CalibrateArgs>()?;
    further.insert("readings".to_owned(), Value::Object(Map::new()));
    let mut request = cli.request(further)?;
    if let Request::Calibrate(of) = &mut request {
        of.poses = pose_csv::read_if_given(files.poses.as_deref(), &of.robot)?;
        let robot = of.robot.read()?.robot;
        let check = |columns: &GappedColumns| check_readings(columns, &robot);
        of.readings = number_table::read_with_gaps(&files.readings, "the readings", check)?;
    }
    Ok(request)
}

/// Runs `calibrate`: prints the result and writes the robot file.
pub(super) fn run(of: &CalibrateRequest, args: &CalibrateArgs, guard: &mut Guard) -> Result<()> {
    guard.reads("the readings", &args.readings);
    if let Some(poses) = &args.poses {
        guard.reads("the poses", poses);
    }
    let DrawArgs { output, figure } = &args.drawn;
    let path = output.output_file.as_deref().filter(|_| output.format.is_none());
    let drawn = FigureSink::open(path, *figure, guard)?;
    let calibrated = OtherFile::robot("calibrated", args.calibrated.as_deref());
    // With a figure the result is printed.
    let output_file = output.output_file.clone().filter(|_| drawn.is_none());
    let printed = OutputArgs { format: output.format, output_file };
    let files = ResultFiles::open(&printed, calibrated, args.page.as_deref(), guard)?;

    let mut watch = TerminalProgress::new();
    let found = calibrate::run(of, &mut watch)?;
    drop(watch);
    if let Some(drawn) = drawn {
        drawn.write(&figures::of_calibration(&found))?;
    }
    files.write(
        &found,
        || Ok(found.robot_file.clone().into_bytes()),
        || {
            let page = funicular_pages::pages::calibrate::page(&found, super::page::command_line()?)?;
            Ok(worded(&page, Words::Program))
        },
    )
}

impl Printed for Calibrated {
    fn text(&self) -> String {
        let mut text = format!(
            "{}: {} from {} data of {}\n\n{}.\n{}.\n\nFrame: {}.\n{}\n",
            self.robot,
            counted(self.values.len(), "value"),
            self.data,
            counted(self.rows.len(), "row"),
            self.fit,
            self.determined,
            self.frame,
            Table::of(&CalibratedValue::columns(), &self.values),
        );
        if let (Some(total), Some(inner), Some(weakest)) = (self.total_m, self.inner_total_m, self.weakest_m) {
            let _ = writeln!(
                text,
                "All values together: ±{} mm in this frame (the weakest combination ±{} mm), ±{} mm with inner conditions.",
                significant(1e3 * total, 4),
                significant(1e3 * weakest, 4),
                significant(1e3 * inner, 4)
            );
        }

        text += &profiles(self.values.iter().filter_map(|row| {
            let profile = row.profile.as_ref()?;
            let (path, unit, value, digits) = (&row.path, row.unit, row.value, row.digits());
            Some(Profiled { path, unit, value, digits, profile, parabola: row.interval_95 })
        }));
        if !self.distances.is_empty() {
            let _ = write!(
                text,
                "\nDistances between anchors, which no frame changes\n{}",
                Table::of(&DistanceRow::columns(), &self.distances)
            );
        }
        text += &weak(self);
        let _ = write!(text, "\nRows\n{}\n", Table::of(&ReadingRow::columns(self.turns), &self.rows));
        let _ = writeln!(text, "{} of {} arrived at this minimum.", self.arrivals, counted(self.starts, "start"));
        for minimum in &self.minima {
            let _ = writeln!(
                text,
                "Another minimum: χ² {} (best {}), values up to {} m away, row {} moved most{}.",
                significant(minimum.chi2, 4),
                significant(self.chi2, 4),
                significant(minimum.farthest_m, 3),
                minimum.row,
                match minimum.mirrored.as_slice() {
                    [] => String::new(),
                    [one] => format!("; the anchor of cable {one} stands on the other side of the rows"),
                    several =>
                        format!("; the anchors of cables {} stand on the other side of the rows", several.join(", ")),
                }
            );
        }
        if !self.proposals.is_empty() {
            let has_rules = self.proposals.iter().any(|row| row.tension_rule.is_some());
            let _ = write!(
                text,
                "\nPoses to measure next, one after the other\n{}",
                Table::of(&ProposalRow::columns(self.turns, has_rules), &self.proposals)
            );
        }
        if let Some(LeftOut { candidates, by_tensions, by_clearance }) = self.left_out {
            let _ = writeln!(
                text,
                "Of {} {by_tensions} have no tensions within the limits, and {by_clearance} are too near to a body or cable.",
                counted(candidates, "candidate")
            );
        }
        if let Some(count) = self.poses_needed {
            let _ = writeln!(text, "{} reach the wanted deviation.", counted(count, "proposed pose"));
        }
        text
    }
}

/// Weak combinations with the walk along the weakest one.
fn weak(found: &Calibrated) -> String {
    let mut text = "\nWeakest combinations, with inner conditions\n".to_owned();
    for row in &found.weak_combinations {
        let _ = match row.deviation_m {
            Some(deviation) => writeln!(
                text,
                "  ±{} mm: {} ({} % of it)",
                significant(1e3 * deviation, 4),
                row.words,
                significant(100.0 * row.share, 4)
            ),
            None => writeln!(text, "  undetermined: {}", row.words),
        };
    }
    if let Some(walk) = &found.walk {
        let rises: Vec<String> = walk.chi2_rises.iter().map(|rise| significant(*rise, 3)).collect();
        let _ = writeln!(
            text,
            "  At −2, −1, 1, 2 deviations along the first, χ² rises by {} (4, 1, 1, 4 for a parabola).",
            rises.join(", ")
        );
    }
    text
}
