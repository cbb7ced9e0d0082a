//! `uncertainty`: text.

use crate::output::Printed;
use crate::table::{Table, counted, significant};
use funicular_study::analyses::uncertainty::{PoseUncertainty, ResultAtPose, Uncertainties};
use std::fmt::Write as _;

impl Printed for Uncertainties {
    fn text(&self) -> String {
        let groups: Vec<String> =
            self.groups.iter().map(|group| format!("{} ({})", group.name, counted(group.count, "number"))).collect();
        let numbers = if self.inputs.len() == 1 { "deviates" } else { "deviate" };
        let mut out = format!(
            "{}: deviations of results from {} that {numbers}\n{}\nHeld: {}.\nGroups: {}.\n",
            self.robot,
            counted(self.inputs.len(), "number"),
            self.models.line(),
            self.held_means,
            groups.join(", ")
        );
        if let Some(of) = &self.response {
            let _ = writeln!(out, "Response: {} to {}; magnitudes in dB of 1 {}.", of.output, of.input, of.unit);
        }
        for (i, pose) in self.poses.iter().enumerate() {
            out += &pose_text(self, i, pose);
        }
        if !self.notes.is_empty() {
            out.push('\n');
        }
        for note in &self.notes {
            let _ = writeln!(out, "{note}.");
        }
        out
    }
}

/// Text about the results at one pose: their table, and doubts.
fn pose_text(of: &Uncertainties, i: usize, pose: &PoseUncertainty) -> String {
    let mut out = String::new();
    if of.poses.len() > 1 {
        let place = pose.position_m.iter().chain(&pose.roll_pitch_yaw_deg).flatten();
        let place: Vec<String> = place.map(|value| significant(*value, 4)).collect();
        let _ = write!(out, "\nPose {}", i + 1);
        if !place.is_empty() {
            let _ = write!(out, ": {}", place.join(", "));
        }
        out.push('\n');
    }
    if let Some(reason) = &pose.reason {
        let _ = writeln!(out, "no results: {reason}");
        return out;
    }

    let columns = ResultAtPose::columns(&of.groups, pose.results.iter().any(|result| result.worst.is_some()));
    let _ = write!(out, "\n{}", Table::of(&columns, ResultAtPose::all(of, i, 1)));

    if let Some(position) = &pose.position {
        let _ = writeln!(out, "\nPosition: {}, the direction in which it deviates most.", position.told());
    }

    // Each reason once.
    let mut reasons: Vec<&str> = Vec::new();
    for reason in pose.results.iter().filter_map(|result| result.sampling_reason.as_deref()) {
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    if !reasons.is_empty() || pose.failed.is_some() {
        out.push('\n');
    }
    for reason in reasons {
        let _ = writeln!(out, "Not linear: {reason}.");
    }
    if let Some(failed) = &pose.failed {
        let _ =
            writeln!(out, "{} without results; the first: {}.", counted(failed.count, "sampled robot"), failed.reason);
    }
    out
}
