//! `design`: text and CSV.

use super::result_files::{OtherFile, ResultFiles};
use crate::args::{Cli, DesignArgs};
use crate::output::Printed;
use crate::pose_csv;
use crate::progress::TerminalProgress;
use crate::table::{Table, counted, significant};
use anyhow::Result;
use funicular_files::Guard;
use funicular_study::analyses::design::{self, ChosenValue, DemandRow, Designed};
use funicular_study::request::{DesignRequest, Request};
use funicular_study::wording::{Words, worded};
use serde_json::{Map, Value};
use std::fmt::Write as _;

/// Request of a design. Errors of its poses name the line in the file of poses.
pub(super) fn request(cli: &Cli, further: Map<String, Value>) -> Result<Request> {
    let mut request = cli.request(further)?;
    if let Request::Design(of) = &mut request {
        of.poses = pose_csv::read_if_given(cli.files::<DesignArgs>()?.poses.as_deref(), &of.robot)?;
    }
    Ok(request)
}

/// Runs `design`: prints the result, writes the robot file and the page.
pub(super) fn run(of: &DesignRequest, args: &DesignArgs, guard: &mut Guard) -> Result<()> {
    if let Some(poses) = &args.poses {
        guard.reads("the poses", poses);
    }
    let designed = OtherFile::robot("designed", args.designed.as_deref());
    let files = ResultFiles::open(&args.sink, designed, args.page.as_deref(), guard)?;

    let mut watch = TerminalProgress::new();
    let found = design::run(of, &mut watch)?;
    drop(watch);
    files.write(
        &found,
        || Ok(found.robot_file.clone().into_bytes()),
        || {
            let page = funicular_pages::pages::design::page(&found, super::page::command_line()?)?;
            Ok(worded(&page, Words::Program))
        },
    )
}

impl Printed for Designed {
    fn text(&self) -> String {
        let per_cent = 100.0 * (self.after / self.before - 1.0);
        let mut text = format!(
            "{}: {} {} → {} {} ({per_cent:+.2} %)\n{}\n{}, {}: {}.\n",
            self.robot,
            self.goal_means,
            significant(self.before, 5),
            significant(self.after, 5),
            self.unit,
            self.models.line(),
            counted(self.values.len(), "value"),
            counted(self.iterations, "iteration"),
            self.ending,
        );
        for limit in &self.limits {
            let _ = writeln!(text, "{limit}.");
        }

        let _ = write!(text, "\n{}", poses(self));
        if !self.demands.is_empty() {
            let _ = write!(text, "\n{}", Table::of(&DemandRow::columns(), &self.demands));
        }
        let _ = write!(text, "\n{}", Table::of(&ChosenValue::columns(), &self.values));
        text
    }
}

/// Number of a pose, without zeros at the end.
fn short(value: f64) -> String {
    funicular_study::text::short(value, 6)
}

/// Table of the poses with the goal before and after.
fn poses(found: &Designed) -> Table {
    let unit = found.unit;
    let (before, after) = (format!("before [{unit}]"), format!("after [{unit}]"));
    let mut table =
        Table::new(&["pose", "x [m]", "y [m]", "z [m]", "roll [°]", "pitch [°]", "yaw [°]", &before, &after, "share"]);

    for (number, row) in (1..).zip(&found.poses) {
        let mut cells = vec![number.to_string()];
        cells.extend(row.position_m.iter().chain(&row.roll_pitch_yaw_deg).map(|value| short(*value)));
        cells.extend([significant(row.before, 5), significant(row.after, 5), format!("{:.3}", row.share)]);
        table.row(cells);
    }
    table
}
