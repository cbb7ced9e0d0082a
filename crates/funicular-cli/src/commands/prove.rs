//! `prove`: text.

use crate::output::Printed;
use crate::table::{Table, significant, vector};
use funicular_study::analyses::prove::{BoxRow, Proved};
use std::fmt::Write as _;

impl Printed for Proved {
    fn text(&self) -> String {
        let mut text = format!("{}: proof with {} cables\n\n", self.robot, self.static_model);
        let mut line = |name: &str, value: &str| {
            let _ = writeln!(text, "  {name:<17} {value}");
        };
        let (position, within) = (vector(&self.pose.position_m, 6), vector(&self.within_m, 6));
        line("positions", &format!("({position}) m ± ({within}) m"));
        let turns = if self.within_deg.iter().any(|of| *of > 0.0) {
            format!(", every turn up to ({})°", vector(&self.within_deg, 4))
        } else {
            String::new()
        };
        line("orientation", &format!("roll, pitch, yaw ({})°{turns}", vector(&self.pose.roll_pitch_yaw_deg, 4)));
        line("loads", &self.loads.to_string());
        let verdict = match (self.verdict, self.margin_n, self.reason) {
            ("inside", Some(margin), _) => {
                format!("inside: every pose is held, at least {} N from every limit", significant(margin, 5))
            }
            ("outside", Some(margin), _) => {
                format!("outside: no position is held, at least {} N are missing", significant(margin, 5))
            }
            (_, _, Some(reason)) => {
                let boxes = if self.tried > 1 { "" } else { ", or give `--boxes`" };
                format!("undecided: {}{boxes}", reason_in_words(reason))
            }
            _ => "divided".to_owned(),
        };
        line("verdict", &verdict);
        if self.tried > 1 {
            let part = |size: f64| {
                let share = significant(100.0 * size / self.whole, 4);
                format!("{} {}, {share} %", significant(size, 6), self.volume_unit)
            };
            line("proved inside", &part(self.inside));
            line("proved outside", &part(self.outside));
            let share = significant(100.0 * self.undecided_share, 3);
            line("undecided", &format!("{}; {share} % of what may be inside", part(self.undecided)));
            line("boxes", &format!("{}; ended by: {}", self.tried, end_in_words(self.end)));
            if !self.worst.is_empty() {
                let _ = write!(text, "\nLargest undecided boxes:\n{}", Table::of(&BoxRow::columns(), &self.worst));
            }
        }
        text
    }
}

fn reason_in_words(reason: &str) -> &'static str {
    match reason {
        "anchor-in-box" => "an anchor may coincide with an attachment within the box",
        "near-singular" => "the cables come near to losing a degree of freedom within the box: take a smaller box",
        "sag-bound" => "the bound of the sag is larger than the margin: a smaller box would not help",
        _ => {
            "the distance from the limits changes its sign within the box, or is smaller than the bounds: take a \
              smaller box"
        }
    }
}

fn end_in_words(end: &str) -> &'static str {
    match end {
        "complete" => "every box is decided, or too small to divide",
        "boxes" => "the number of boxes",
        "time" => "the time",
        "undecided" => "the undecided share",
        _ => "a stop from outside",
    }
}
