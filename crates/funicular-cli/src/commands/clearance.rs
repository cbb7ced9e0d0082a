//! `clearance`: text.

use crate::output::Printed;
use crate::table::{Table, vector};
use funicular_study::analyses::clearance::{Clearances, WayAround};
use funicular_study::analyses::shared::PoseRow;

/// Number of pairs that the text shows.
const SHOWN: usize = 12;

impl Printed for Clearances {
    fn text(&self) -> String {
        let near = self.pairs.iter().filter(|pair| !pair.is_kept()).count();
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
        let way = self.way.as_ref().map_or_else(String::new, way_text);
        let shown = &self.pairs[..self.pairs.len().min(SHOWN)];
        let rest = match self.pairs.len() {
            all if all > SHOWN => format!("\n{SHOWN} of {all} pairs shown, the nearest first.\n"),
            _ => String::new(),
        };
        format!(
            "{}: distances with {} cables\n\n  position          ({}) m\n  roll, pitch, yaw  ({})°\n{end}  \
             verdict           {verdict}\n{way}\n{}\n{rest}",
            self.robot,
            self.static_model,
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            Table::of(&self.columns(), shown),
        )
    }
}

/// Line about a way around.
fn way_text(of: &WayAround) -> String {
    let poses = |through: &[PoseRow]| {
        let pose =
            |of: &PoseRow| format!("({}) m, ({})°", vector(&of.position_m, 4), vector(&of.roll_pitch_yaw_deg, 2));
        through.iter().map(pose).collect::<Vec<_>>().join(", then ")
    };
    let found = match of.through.as_deref() {
        Some([]) => "the straight one".to_owned(),
        Some(through) => format!("through {}", poses(through)),
        None => format!("none found among {} straight moves; there may be one", of.moves_examined),
    };
    format!("  free way          {found}\n")
}
