//! `simulate`: text. A run that is killed leaves the rows so far beside its file.

mod partial;

use crate::output::Printed;
use crate::table::{Table, counted, significant};
use funicular_study::analyses::simulate::{ColumnError, Peak, Simulated, SimulatedRow, StretchLossRow};
pub(super) use partial::PartialRows;
use std::fmt::Write as _;

/// Rows that the table shows.
const SHOWN: usize = 21;

impl Printed for Simulated {
    fn text(&self) -> String {
        let columns = SimulatedRow::columns(&self.names());
        let step = self.rows.len().div_ceil(SHOWN).max(1);
        let shown = self.rows.iter().step_by(step);
        let table = Table::of(&columns, shown.clone());
        let mut text = format!(
            "{}: simulation of {} s{}\n{} of degree {} in each rope, tolerance {} m, {}\n",
            self.robot,
            significant(self.duration_s, 5),
            self.origin.phrase(),
            counted(self.elements, "element"),
            self.degree,
            significant(self.tolerance_m, 3),
            counted(self.steps.accepted, "step"),
        );
        if let Some(time) = self.stopped_at_s {
            let _ = writeln!(text, "STOPPED at {} s", significant(time, 5));
        }
        for cut in &self.cuts {
            let _ = writeln!(text, "cable \"{}\" fails at {} s", cut.cable, significant(cut.t_s, 5));
        }
        for slack in &self.slack {
            let (first, share) = (significant(slack.first_s, 4), significant(100.0 * slack.share, 3));
            let _ = writeln!(text, "cable \"{}\" is slack from {first} s on, for {share} % of the time", slack.cable);
        }
        if let Some(nearest) = &self.nearest {
            let _ = writeln!(text, "{}", nearest.in_words());
        }
        for below in &self.below {
            let _ = writeln!(text, "{}", below.in_words());
        }
        let _ = write!(text, "\n{table}\n{} of {} shown.\n", shown.len(), counted(self.rows.len(), "row"));
        if !self.stretch_losses.is_empty() {
            let losses = Table::of(&StretchLossRow::columns(), &self.stretch_losses);
            let _ =
                write!(text, "\nDamping ratios by the loss of the stretch, by the robot file and in time\n{losses}");
        }
        let _ = write!(text, "\nLargest tensions\n{}", Table::of(&Peak::columns(), &self.peaks));
        if self.errors.is_empty() {
            let _ = writeln!(text, "\nThe error is not known: no finer run came to its end.");
        } else {
            let _ = write!(
                text,
                "\nErrors, at most, by a run with a finer mesh and tolerance\n{}",
                Table::of(&ColumnError::columns(), &self.errors)
            );
        }
        let _ = writeln!(text, "Energy is off by at most {} J.", significant(self.energy_defect_j, 2));
        text
    }
}
