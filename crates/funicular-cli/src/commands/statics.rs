//! `statics`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, decimals, short, significant, vector};
use funicular_study::analyses::statics::{
    CableRow, EquilibriumRow, FrictionCableRow, FrictionRow, OtherStable, Statics, SupportRow,
};

impl Printed for Statics {
    fn text(&self) -> String {
        let cables = Table::of(&CableRow::columns(&self.cables), &self.cables);
        let drives = drives_table(self) + &supports_table(self);
        let friction = self.friction_interval.as_ref().map_or_else(String::new, friction_text);
        let stability = match (self.stable, self.stiffness_min_n_per_m) {
            (Some(true), Some(min)) => format!("Stable, min stiffness {} N/m", significant(min, 4)),
            (Some(false), Some(0.0)) => indifferent(self),
            (Some(false), Some(min)) => format!("NOT STABLE, min stiffness {} N/m", significant(min, 4)),
            _ => "Rigid cables: no stiffness".to_owned(),
        };
        let rule = self.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        let balanced = motions(self, Some(true)) + &motions(self, None);
        let load = self.load.as_ref().map_or_else(String::new, |load| format!(", {}", load.text()));
        let wind = self.wind.as_ref().map_or_else(String::new, |wind| format!(", wind {}", wind.text()));
        let held = self.held.as_ref().map_or_else(String::new, |held| {
            format!(
                "  displacement     ({}) m, {} mm in all, {}°, at the lengths that hold ({}) m\n",
                vector(&held.motion.translation_m, 6),
                decimals(1e3 * held.motion.distance_m, 3),
                decimals(held.motion.angle_deg, 4),
                vector(&held.pose.position_m, 6)
            )
        });
        let nearest = self.nearest_pose_distance_m.map_or_else(String::new, |distance| {
            format!("  nearest pose that the cables can hold, {} m from the requested pose\n", short(distance, 4))
        });

        let centre = self.centre.as_ref().map_or_else(String::new, |proof| format!("Tensions: {}.\n", proof.text()));
        let others = match (&self.another_stable_equilibrium, equilibria_table(self)) {
            (_, Some(table)) => format!("\n{table}"),
            (Some(other), None) => other_text(other),
            (None, None) => String::new(),
        };
        let balance = if self.is_unloaded {
            "No load and no tension: no residual,".to_owned()
        } else {
            format!("Residual {:.1e}", self.residual)
        };

        format!(
            "{}: equilibrium with {} cables, {} kg{load}{wind}{rule}\n\n  position         ({}) m\n  roll, pitch, yaw \
             ({})°\n{nearest}{held}{balanced}\n\
             {cables}\n{drives}{stability}. {balance} after {}.\n{centre}{others}{friction}",
            self.robot,
            self.static_model,
            short(self.mass_kg, 6),
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            table::counted(self.iterations, "iteration"),
        )
    }
}

/// Motions that no cable opposes and that weight or the directions of the tensions hold, or of which nothing is known.
fn motions(found: &Statics, held: Option<bool>) -> String {
    let motions: Vec<&str> =
        found.free_motions.iter().filter(|free| free.held == held).map(|free| free.text.as_str()).collect();
    let by = if held.is_some() { ", only weight and the directions of the tensions" } else { "" };
    if motions.is_empty() { String::new() } else { format!("  no cable holds{by}: {}\n", motions.join("; ")) }
}

/// Sentence on an indifferent equilibrium with the motions that nothing holds.
fn indifferent(found: &Statics) -> String {
    let motions: Vec<&str> =
        found.free_motions.iter().filter(|free| free.held == Some(false)).map(|free| free.text.as_str()).collect();
    if motions.is_empty() {
        return "INDIFFERENT: the platform is free to move in some direction".to_owned();
    }
    format!("INDIFFERENT: the platform is free to {}", motions.join("; to "))
}

/// Pulleys and winches; empty if all cables end at fixed points.
fn drives_table(found: &Statics) -> String {
    let mut driven = found.cables.iter().filter(|cable| cable.drive.is_some()).peekable();
    if driven.peek().is_none() {
        return String::new();
    }
    format!("{}\n", Table::of(&CableRow::drive_columns(), driven))
}

/// Flexible supports; empty on a rigid frame.
fn supports_table(found: &Statics) -> String {
    if found.supports.is_empty() {
        return String::new();
    }
    let mut rows = Table::new(&["support", "displacement [mm]", "force of its cables [N]"]);
    for SupportRow { name, displacement_m, force_n } in &found.supports {
        rows.row(vec![name.clone(), vector(&displacement_m.map(|metres| 1e3 * metres), 3), vector(force_n, 2)]);
    }
    format!("{rows}\n")
}

/// Interval of friction: motion of the platform and tensions.
fn friction_text(found: &FrictionRow) -> String {
    let pair = |[min, max]: [f64; 2], digits: usize| format!("{} to {}", decimals(min, digits), decimals(max, digits));
    let held = match &found.motion {
        Some(motion) => {
            let mm = motion.translation_m.map(|range| pair(range.map(|metres| 1e3 * metres), 3)).join(", ");
            let degrees = motion.rotation_deg.map(|range| pair(range, 4)).join(", ");
            format!(
                "Friction of pulleys with the lengths held, minimum to maximum about this equilibrium:\n\n  \
                 translation x, y, z    {mm} mm\n  rotation about x, y, z {degrees}°\n"
            )
        }
        None => "Friction of pulleys with the pose held, minimum to maximum:\n".to_owned(),
    };

    let rows = Table::of(&FrictionCableRow::columns(found.motion.is_some()), &found.cables);
    format!("\n{held}\n{rows}")
}

/// All equilibria found.
fn equilibria_table(found: &Statics) -> Option<String> {
    let (equilibria, search) = (found.equilibria.as_ref()?, found.search.as_ref()?);
    let header = ["", "equilibrium", "energy [J]", "distance [m]", "position [m]", "roll, pitch, yaw [°]"];
    let mut rows = Table::new(&header).text_columns(&[1]);

    for (i, row) in equilibria.iter().enumerate() {
        rows.row(vec![
            (i + 1).to_string(),
            stability(row),
            row.energy_j.map_or_else(|| table::NONE.to_owned(), |energy| short(energy, 5)),
            decimals(row.distance_m, 4),
            vector(&row.pose.position_m, 4),
            vector(&row.pose.roll_pitch_yaw_deg, 2),
        ]);
    }

    let stable = equilibria.iter().filter(|row| row.stable).count();
    let sum = match search.expected_index_sum {
        Some(expected) if expected == search.index_sum => {
            "; as theory requires, as many equilibria have an even as an odd number of unstable directions"
        }
        _ => "",
    };

    // A point mass has exactly one equilibrium, so the sum of (51) is not printed.
    let sum = if search.starts == 0 { "" } else { sum };
    let found = equilibria.len();
    let noun = if found == 1 { "equilibrium" } else { "equilibria" };
    let starts = table::counted(search.starts.max(1), "start");

    Some(format!("{rows}\n{found} {noun}, {stable} stable, from {starts}{sum}.\n"))
}

/// Stability of one equilibrium in a word.
fn stability(row: &EquilibriumRow) -> String {
    match (row.falling_directions, row.indifferent_directions) {
        (0, 0) => "stable".to_owned(),
        (0, _) => "indifferent".to_owned(),
        (falling, _) => format!("unstable ({})", table::counted(falling, "direction")),
    }
}

/// Sentence about another stable equilibrium.
fn other_text(other: &OtherStable) -> String {
    let energy = other.energy_above_j.map_or_else(String::new, |energy| {
        format!(", {} J {}", short(energy.abs(), 4), if energy < 0.0 { "lower" } else { "higher" })
    });
    format!(
        "These lengths have another stable equilibrium, {} m away{energy} (--all lists all equilibria).\n",
        short(other.distance_m, 4)
    )
}
