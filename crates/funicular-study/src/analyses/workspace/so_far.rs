//! Positions of a workspace that were asked so far, for the progress and for a search that is stopped.

use super::study::SearchedSet;
use crate::text::{counted, short, significant};
use funicular::math::Vec3;

/// Positions that were asked, and those among them that meet the conditions.
#[derive(Debug, Clone, Default)]
pub struct FoundSoFar {
    asked: usize,
    inside: usize,
    /// Corners of the smallest box around those that meet the conditions.
    bounds: Option<[Vec3; 2]>,
}

impl FoundSoFar {
    /// Adds positions of a set with their values. Only those of the robot's own set count.
    pub fn add(&mut self, set: SearchedSet, positions: &[Vec3], values: &[Option<f64>]) {
        if set != SearchedSet::Own {
            return;
        }
        self.asked += positions.len();
        for (position, _) in positions.iter().zip(values).filter(|(_, value)| value.is_some_and(|value| value >= 0.0)) {
            self.inside += 1;
            let [lower, upper] = self.bounds.unwrap_or([*position; 2]);
            self.bounds = Some([lower.inf(position), upper.sup(position)]);
        }
    }

    /// Part of a line of progress; empty before anything was asked.
    pub fn note(&self) -> String {
        if self.asked == 0 {
            return String::new();
        }
        format!("{} of {} asked so far meet the conditions", self.inside, self.asked)
    }

    /// Sentence about a search that was stopped before it had a surface to show.
    pub fn stopped(&self) -> String {
        let asked = counted(self.asked, "position");
        let found = match self.bounds {
            None if self.asked == 0 => "nothing was asked so far".to_owned(),
            None => format!("of {asked} asked so far, none meets the conditions"),
            Some([lower, upper]) => {
                let corner = |at: Vec3| [at.x, at.y, at.z].map(|x| short(x, 4)).join(", ");
                format!(
                    "of {asked} asked so far, which are spread over the box, {} meet the conditions, {} %; they reach \
                     from ({}) m to ({}) m",
                    self.inside,
                    significant(100.0 * self.inside as f64 / self.asked as f64, 2),
                    corner(lower),
                    corner(upper)
                )
            }
        };
        format!("stopped: {found}; they are too few for a surface: wait longer, or give a ⟪grid⟫ with fewer values")
    }
}
