//! `settle`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant};
use funicular_study::analyses::settle::{Settled, SettlingMode};

/// Modes that the table shows.
const SHOWN: usize = 12;

impl Printed for Settled {
    fn text(&self) -> String {
        let table = Table::of(&SettlingMode::columns(), self.modes.iter().take(SHOWN));
        let [x, y, z] = self.held_m.map(|part| significant(1e3 * part, 4));
        let last = self.modes.iter().max_by(|a, b| a.settled_s.total_cmp(&b.settled_s));
        let last = last.filter(|mode| mode.settled_s > 0.0).map_or_else(String::new, |mode| {
            format!("; the mode at {} Hz lasts longest", decimals(mode.frequency_hz, 4))
        });
        format!(
            "{}: decay after a release, modes below {} Hz\n{}\n\nDisplacement before the release, linear: {x}, {y}, {z} \
             mm.\nWithin {} mm for good after {} s; by the sum of all amplitudes after {} s{last}.\nAll modes above the \
             limit together move the point by at most {} mm at the release.\n\n{table}\n{} of {} shown.{}\n",
            self.robot,
            self.below_hz,
            self.models.line(),
            significant(1e3 * self.tolerance_m, 4),
            significant(self.settled_s, 4),
            significant(self.surely_settled_s, 4),
            significant(1e3 * self.omitted_m, 3),
            self.modes.len().min(SHOWN),
            counted(self.modes.len(), "mode"),
            if self.damped_certified { "" } else { " NOT certified: no count proves the list of damped modes." },
        )
    }
}
