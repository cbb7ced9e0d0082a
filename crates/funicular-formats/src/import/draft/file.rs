//! Text of the robot file of a draft.

use super::{Draft, DraftCable, DraftMotion, DraftPulley, DraftRope, DraftState, DraftWinch};
use anyhow::{Result, anyhow};
use funicular::math::{Mat3, Vec3, rotation};
use funicular::robot::Robot;
use funicular_study::text::clean;
use std::fmt::Write;

/// Width of comments.
pub(crate) const WIDTH: usize = 118;

impl Draft {
    /// Writes the robot file and checks that it can be read.
    ///
    /// # Errors
    ///
    /// The reason why a robot file cannot hold the robot.
    pub(crate) fn to_toml(&self) -> Result<String> {
        let mut out = String::new();
        self.head(&mut out);
        self.tables(&mut out);
        Robot::from_toml(&out).map_err(|error| {
            let issues: Vec<String> = error.issues().iter().map(|issue| issue.message.clone()).collect();
            let of_inertia = issues.iter().any(|issue| issue.contains("inertia_kg_m2"));
            let hint =
                if of_inertia { "; give ⟪inertia_kg_m2⟫ XX,YY,ZZ, or fix the source" } else { "; fix the source" };
            anyhow!("{}: a robot file cannot hold it: {}{hint}", self.platform.place, issues.join("; "))
        })?;
        Ok(out)
    }

    fn head(&self, out: &mut String) {
        comment(out, "", &format!("Written by funicular {}, import.", env!("CARGO_PKG_VERSION")));
        for (title, lines) in [
            ("How it was read:", &self.notes),
            ("Assumed, because the source does not state it:", &self.assumed),
            ("In the source, but not in this file:", &self.lost),
        ] {
            if !lines.is_empty() {
                out.push_str("#\n");
                comment(out, "", title);
                for line in lines {
                    comment(out, "- ", line);
                }
            }
        }
    }

    /// Writes the tables of the file, without the comments at its head.
    pub(super) fn tables(&self, out: &mut String) {
        let mut line = |text: String| out.push_str(&(text + "\n"));
        line(format!("\nname = {}", quoted(&self.name)));
        line(format!("source = {}", quoted(&self.source)));
        line(format!("gravity_m_s2 = {}", vector(&self.gravity_w)));
        self.write_platform(&mut line);

        if let Some(payload) = self.payload {
            line(format!("\n[required]\npayload_max_kg = {}", float(payload)));
        }

        let (ropes, pulleys, winches) = (self.ropes(), self.pulleys(), self.winches());
        write_ropes(&ropes, &mut line);
        for (name, pulley) in &pulleys {
            line(format!("\n[pulleys.{name}]\nradius_m = {}", float(pulley.radius)));
            line(format!("entry_direction = {}", vector(&pulley.entry_direction_w)));
        }
        for (name, winch) in &winches {
            line(format!("\n[winches.{}]", quoted(name)));
            for (key, value) in &winch.values {
                line(format!("{key} = {}", float(*value)));
            }
        }
        for cable in &self.cables {
            let material = ropes.iter().find(|(_, rope)| same(rope, &cable.rope)).map_or("", |(name, _)| name);
            let pulley = cable.pulley.and_then(|own| pulleys.iter().find(|(_, pulley)| *pulley == own));
            let winch = cable.winch.as_ref().and_then(|own| winches.iter().find(|(_, winch)| *winch == own));
            line(self.cable(cable, material, [pulley.map(|(name, _)| &**name), winch.map(|(name, _)| &**name)]));
        }

        if let DraftState::Pose(pose) = &self.state {
            line("\n[state]".to_owned());
            line(format!("position_m = {}", vector(&pose.position_w)));
            let angles = Vec3::from(rotation::to_roll_pitch_yaw_deg(&pose.rot_wp));
            if angles != Vec3::zeros() {
                line(format!("roll_pitch_yaw_deg = {}", vector(&angles)));
            }
        }
    }

    /// Writes the table `[platform]`.
    fn write_platform(&self, line: &mut impl FnMut(String)) {
        line("\n[platform]".to_owned());
        line(format!("mass_kg = {}", float(self.platform.mass.unwrap_or_default())));
        let motion = self.platform.motion;
        if motion == DraftMotion::PointMass {
            line("motion = \"point-mass\"".to_owned());
            return;
        }
        if let DraftMotion::Planar { plane } = motion {
            line(format!("motion = \"planar-{plane}\""));
            // The plane of a planar robot goes through its pose.
            if let (DraftState::Pose(pose), Some(normal)) = (&self.state, motion.normal_axis()) {
                line(format!("plane_offset_m = {}", float(pose.position_w[normal])));
            }
        }

        let inertia = self.platform.inertia_p.unwrap_or_default();
        // For planar robots the sources give only the moment about the normal. The other moments are zero, which no
        // body has, so the robot file gets this one moment.
        line(match motion.normal_axis() {
            Some(normal) => format!("inertia_kg_m2 = {}", float(inertia[(normal, normal)])),
            None => format!("inertia_kg_m2 = {}", tensor(&inertia)),
        });
        line(format!("center_of_mass_m = {}", vector(&self.platform.center_of_mass_p.unwrap_or_default())));
    }

    /// Distinct pulleys, each with a name.
    fn pulleys(&self) -> Vec<(String, DraftPulley)> {
        let mut pulleys: Vec<(String, DraftPulley)> = Vec::new();
        for pulley in self.cables.iter().filter_map(|cable| cable.pulley) {
            if pulleys.iter().all(|(_, known)| *known != pulley) {
                let number = pulleys.len() + 1;
                pulleys.push((if number == 1 { "wheel".to_owned() } else { format!("wheel-{number}") }, pulley));
            }
        }
        pulleys
    }

    /// Distinct winches, each with a name of its own.
    fn winches(&self) -> Vec<(String, &DraftWinch)> {
        let mut winches: Vec<(String, &DraftWinch)> = Vec::new();
        for winch in self.cables.iter().filter_map(|cable| cable.winch.as_ref()) {
            if winches.iter().all(|(_, known)| *known != winch) {
                let is_free = !winch.name.is_empty() && winches.iter().all(|(name, _)| *name != winch.name);
                let name = if is_free { winch.name.clone() } else { format!("winch-{}", winches.len() + 1) };
                winches.push((name, winch));
            }
        }
        winches
    }

    fn cable(&self, cable: &DraftCable, material: &str, [pulley, winch]: [Option<&str>; 2]) -> String {
        let mut text = format!(
            "\n[[cables]]\nname = {}\nmaterial = {}\nanchor_m = {}",
            quoted(&cable.name),
            quoted(material),
            vector(&cable.anchor_w)
        );

        let mut line = |key: &str, value: String| {
            let _ = write!(text, "\n{key} = {value}");
        };

        if let Some(pulley) = pulley {
            line("pulley", quoted(pulley));
        }
        if let Some(winch) = winch {
            line("winch", quoted(winch));
        }
        if self.platform.motion != DraftMotion::PointMass {
            line("attachment_m", vector(&cable.attachment_p));
        }
        if let Some(length) = cable.unstrained_length {
            line("unstrained_length_m", float(length));
        }
        for (key, limit) in ["minimum_tension_n", "maximum_tension_n"].into_iter().zip(cable.limits) {
            if let Some(limit) = limit {
                line(key, float(limit));
            }
        }

        text
    }

    /// Distinct ropes, each with a unique name.
    fn ropes(&self) -> Vec<(String, &DraftRope)> {
        let mut ropes: Vec<(String, &DraftRope)> = Vec::new();
        for rope in self.cables.iter().map(|cable| &cable.rope) {
            if ropes.iter().any(|(_, known)| same(known, rope)) {
                continue;
            }
            let base = if rope.name.is_empty() { "rope" } else { &rope.name };
            let mut name = base.to_owned();
            let mut count = 1;
            while ropes.iter().any(|(taken, _)| *taken == name) {
                count += 1;
                name = format!("{base} ({count})");
            }
            ropes.push((name, rope));
        }
        ropes
    }
}

/// Writes a table `[materials.NAME]` for each rope.
fn write_ropes(ropes: &[(String, &DraftRope)], line: &mut impl FnMut(String)) {
    for (name, rope) in ropes {
        line(format!("\n[materials.{}]", key(name)));
        if let Some(stiffness) = rope.axial_stiffness {
            line(format!("axial_stiffness_n = {}", float(stiffness)));
        } else {
            line(format!("youngs_modulus_pa = {}", float(rope.youngs_modulus.unwrap_or_default())));
            line(format!("diameter_m = {}", float(rope.diameter.unwrap_or_default())));
        }
        line(format!("mass_kg_per_m = {}", float(rope.mass_per_length.unwrap_or_default())));
        if let Some(load) = rope.breaking_load {
            line(format!("breaking_load_n = {}", float(load)));
        }
    }
}

/// True if two ropes can share one material. The file gives E and diameter only if there is no EA.
fn same(a: &DraftRope, b: &DraftRope) -> bool {
    let key = |rope: &DraftRope| match rope.axial_stiffness {
        Some(_) => (rope.axial_stiffness, None, None),
        None => (None, rope.youngs_modulus, rope.diameter),
    };
    let same = a.name == b.name && a.mass_per_length == b.mass_per_length && key(a) == key(b);
    same && a.breaking_load == b.breaking_load
}

/// Writes comment lines beginning with `# `, wrapped between words.
pub(crate) fn comment(out: &mut String, bullet: &str, text: &str) {
    let mut line = format!("# {bullet}");
    let indent = " ".repeat(bullet.len());
    let mut empty = true;
    // Each word is cleaned: a TOML comment ends with its line and must not hold control characters.
    for word in text.split_whitespace().map(clean) {
        if !empty && line.chars().count() + word.chars().count() + 1 > WIDTH {
            out.push_str(&line);
            out.push('\n');
            line = format!("# {indent}");
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(&word);
        empty = false;
    }
    out.push_str(&line);
    out.push('\n');
}

/// TOML string in quotes.
pub(crate) fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// TOML key, without quotes if possible.
fn key(text: &str) -> String {
    let bare = !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'));
    if bare { text.to_owned() } else { quoted(text) }
}

/// Shortest digits that are read back as the same number.
pub(crate) fn float(value: f64) -> String {
    // Adding zero turns −0 into 0: its sign has no meaning here.
    let value = value + 0.0;
    let plain = value == 0.0 || (1e-4..1e6).contains(&value.abs());
    if plain { format!("{value:?}") } else { format!("{value:e}") }
}

pub(crate) fn vector(v: &Vec3) -> String {
    format!("[{}, {}, {}]", float(v.x), float(v.y), float(v.z))
}

pub(crate) fn tensor(tensor: &Mat3) -> String {
    if *tensor == Mat3::from_diagonal(&tensor.diagonal()) {
        return vector(&tensor.diagonal());
    }
    let row = |i: usize| format!("    {},\n", vector(&tensor.row(i).transpose()));
    format!("[\n{}{}{}]", row(0), row(1), row(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_wrapped_and_hold_no_control_characters() {
        let mut out = String::new();
        comment(&mut out, "- ", &format!("{} end\u{1b}[31m\nname = 3", "word ".repeat(60)));
        assert!(out.lines().all(|line| line.starts_with("# ") && line.chars().count() <= WIDTH), "{out}");
        assert!(out.ends_with("end[31m name = 3\n") && !out.contains('\u{1b}'));
    }

    #[test]
    fn numbers_are_read_back_as_they_were() {
        for value in [0.1, -13.332e-3, 1e12, 2.5e-300, 1.0 / 3.0, 7.0] {
            let text = format!("x = {}", float(value));
            let table: toml_edit::DocumentMut = text.parse().unwrap();
            assert_eq!(table["x"].as_float(), Some(value), "{text}");
        }
        assert_eq!(float(-0.0), "0.0");
    }
}
