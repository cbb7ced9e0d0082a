//! `calibrate`: text.

use super::profile_table::{Profiled, profiles};
use crate::output::Printed;
use crate::table::{Table, counted, significant};
use funicular_study::analyses::calibrate::{
    Calibrated, CalibratedValue, DistanceRow, LeftOut, ProposalRow, ReadingRow, ToolRow,
};
use std::fmt::Write as _;

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
                "All values together: ±{} mm in this frame (the weakest combination ±{} mm), ±{} mm with inner \
                 conditions.",
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
        if let Some(accuracy) = &self.accuracy {
            let _ = writeln!(
                text,
                "\nAccuracy of the tool in this frame, with the readings of the calibrated values\n{}",
                Table::of(&ToolRow::columns(self.turns), &accuracy.poses)
            );
            for sentence in accuracy.sentences() {
                let _ = writeln!(text, "{sentence}.");
            }
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
                Table::of(&ProposalRow::columns(self.turns, has_rules, self.accuracy.is_some()), &self.proposals)
            );
        }
        if let Some(LeftOut { candidates, by_tensions, by_clearance }) = self.left_out {
            let _ = writeln!(
                text,
                "Of {} {by_tensions} have no tensions within the limits, and {by_clearance} are too near to a body or \
                 cable.",
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
