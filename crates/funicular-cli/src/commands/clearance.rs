//! `clearance`: text.

use crate::output::Printed;
use crate::table::{Table, vector};
use funicular_study::analyses::clearance::{ClearanceRow, Clearances};

/// Number of pairs that the text shows.
const SHOWN: usize = 12;

impl Printed for Clearances {
    fn text(&self) -> String {
        let near = self.pairs.iter().filter(|pair| pair.margin_m < 0.0).count();
        let verdict = match near {
            0 if self.pairs.is_empty() => "nothing to compare".to_owned(),
            0 if self.move_to.is_some() => "free: every pair keeps its required distance on the way".to_owned(),
            0 => "free: every pair keeps its required distance".to_owned(),
            1 => "1 pair is too near".to_owned(),
            _ => format!("{near} pairs are too near"),
        };
        let end = self.move_to.as_ref().map_or_else(String::new, |end| {
            format!(
                "  moves to          ({}) m, ({})°\n",
                vector(&end.position_m, 6),
                vector(&end.roll_pitch_yaw_deg, 4)
            )
        });
        let shown = &self.pairs[..self.pairs.len().min(SHOWN)];
        let rest = match self.pairs.len() {
            all if all > SHOWN => format!("\n{SHOWN} of {all} pairs shown, the nearest first.\n"),
            _ => String::new(),
        };
        format!(
            "{}: distances with {} cables\n\n  position          ({}) m\n  roll, pitch, yaw  ({})°\n{end}  verdict           \
             {verdict}\n\n{}\n{rest}",
            self.robot,
            self.static_model,
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            Table::of(&ClearanceRow::columns(self.move_to.is_some()), shown),
        )
    }
}
