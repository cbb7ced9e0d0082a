//! `design`: text.

use crate::output::Printed;
use crate::table::{Table, counted, significant};
use funicular_study::analyses::design::{ChangeGain, ChosenValue, DemandRow, Designed, RopeTried};
use funicular_study::text::{titled, with_unit};
use std::fmt::Write as _;

impl Printed for Designed {
    fn text(&self) -> String {
        let per_cent = 100.0 * (self.after / self.before - 1.0);
        let mut text = format!(
            "{}: {} {} → {} ({per_cent:+.2} %)\n{}\n{}, {}: {}.\n",
            self.robot,
            self.goal_means,
            significant(self.before, 5),
            with_unit(&significant(self.after, 5), self.unit),
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
        if self.gains.len() > 1 {
            let _ = write!(text, "\n{}", Table::of(&ChangeGain::columns(), &self.gains));
        }
        if !self.ropes.is_empty() {
            let _ = write!(text, "\n{}", Table::of(&RopeTried::columns(), &self.ropes));
        }
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
    let (before, after) = (titled("before", unit), titled("after", unit));
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
