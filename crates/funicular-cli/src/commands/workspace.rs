//! `workspace`: text.

use crate::output::Printed;
use crate::table::{Table, counted, short, significant, vector};
use funicular_study::analyses::workspace::{ComparedSets, PartOfWorkspace, RaysOfWorkspace, VolumeRow, Workspace};
use std::fmt::Write as _;

/// Largest number of parts or holes that the text lists.
const SHOWN: usize = 6;

impl Printed for Workspace {
    fn text(&self) -> String {
        let mut text = format!("{}: workspace with {} cables\n\n", self.robot, self.static_model);
        let mut line = |name: &str, value: &str| {
            let _ = writeln!(text, "  {name:<17} {value}");
        };
        let conditions: Vec<String> = self.conditions.iter().map(ToString::to_string).collect();
        line("conditions", &conditions.join(", "));
        line("orientations", &orientation_text(self));
        let volume = self.volume();
        if let Some(plane) = &self.plane {
            line("plane", &format!("{} = {} m", plane.axis, short(plane.at_m, 6)));
            line("area", &format!("{} m²{}", significant(plane.area_m2, 6), error_text(self)));
        } else {
            line("volume", &format!("{} m³{}", significant(volume.volume_m3, 6), error_text(self)));
            line("area", &format!("{} m²", significant(volume.area_m2.unwrap_or(0.0), 6)));
        }
        if let Some(centroid) = volume.centroid_m {
            line("centroid", &format!("({}) m", vector(&centroid, 4)));
        }
        let [low, high] = self.bounds_m;
        line("reaches from", &format!("({}) m to ({}) m", vector(&low, 4), vector(&high, 4)));
        if let Some(plane) = &self.plane {
            line("parts", &plane.parts.to_string());
            line("holes", &if plane.holes == 0 { "none".to_owned() } else { plane.holes.to_string() });
        } else {
            line("parts", &pieces_text(&self.parts));
            line("holes", &pieces_text(&self.holes));
        }
        line("box of the grid", &box_text(self));
        let steps: Vec<String> = self.grid.step_m.iter().map(|step| short(*step, 4)).collect();
        let first = short(self.grid.first_step_m, 4);
        line("steps", &format!("{} m; parts and holes between steps of {first} m can be missed", steps.join(", ")));
        if let Some(inner) = self.inner_box.as_ref().filter(|_| self.plane.is_none()) {
            let (low, high) = (vector(&inner.lower_m, 3), vector(&inner.upper_m, 3));
            line(
                "box inside",
                &format!("({low}) m to ({high}) m, {} m³, by the nodes", significant(inner.volume_m3, 4)),
            );
        }
        line("evaluations", &self.evaluations.to_string());

        if self.plane.is_some() {
            return text + &self.compared.as_ref().map_or_else(String::new, |of| compared_text(of, "m²"));
        }
        let _ = write!(text, "\n{}", Table::of(&VolumeRow::columns(), &self.volumes));
        if !self.sections.is_empty() {
            let _ = write!(text, "\n{}", sections(self));
        }
        if let Some(rays) = &self.rays {
            text += &rays_text(rays);
        }
        if let Some(compared) = &self.compared {
            text += &compared_text(compared, "m³");
        }
        if let Some(proof) = &self.proof {
            let _ = write!(text, "\nProof in the box of the grid\n\n{}", proof.text());
        }
        text
    }
}

fn orientation_text(of: &Workspace) -> String {
    match of.roll_pitch_yaw_deg[..] {
        [one] => format!("roll, pitch, yaw ({})°", vector(&one, 4)),
        ref all => format!("{} of {}", of.orientations, all.len()),
    }
}

/// Largest expected error of the volume.
fn error_text(of: &Workspace) -> String {
    of.relative_error().map_or_else(String::new, |error| format!(" ± {} %", significant(100.0 * error, 2)))
}

fn pieces_text(pieces: &[PartOfWorkspace]) -> String {
    let piece = |of: &PartOfWorkspace| {
        let handles = if of.handles == 0 { String::new() } else { format!(" with {}", counted(of.handles, "handle")) };
        format!("{} m³{handles}", significant(of.volume_m3, 5))
    };
    let shown: Vec<String> = pieces.iter().take(SHOWN).map(piece).collect();
    let more = if pieces.len() > SHOWN { ", …" } else { "" };
    match pieces.len() {
        0 => "none".to_owned(),
        1 if pieces[0].handles == 0 => "1".to_owned(),
        count => format!("{count}: {}{more}", shown.join(", ")),
    }
}

fn box_text(of: &Workspace) -> String {
    let (low, high) = (vector(&of.grid.lower_m, 3), vector(&of.grid.upper_m, 3));
    let touches = match of.touches[..] {
        [] => "not reached".to_owned(),
        ref faces if of.plane.is_some() => {
            format!("reached at {}, where {} m are cut", faces.join(", "), significant(of.cut_area_m2, 4))
        }
        ref faces => format!("reached at {}, where {} m² are cut", faces.join(", "), significant(of.cut_area_m2, 4)),
    };
    format!("({low}) m to ({high}) m, {touches}")
}

fn sections(of: &Workspace) -> Table {
    let mut table = Table::new(&["section", "at [m]", "area [m²]", "polygons"]);
    for section in &of.sections {
        let polygons = section.polygons_m.len().to_string();
        table.row(vec![section.axis.to_owned(), short(section.at_m, 6), significant(section.area_m2, 6), polygons]);
    }
    table
}

fn rays_text(rays: &RaysOfWorkspace) -> String {
    format!(
        "\n{} rays from ({}) m: {} with several intervals, {} up to the box.\n",
        rays.count,
        vector(&rays.center_m, 4),
        rays.with_several_intervals,
        rays.cut
    )
}

fn compared_text(of: &ComparedSets, unit: &str) -> String {
    format!(
        "\nCompared with {}, on the same grid: {} {unit}; common to both {} {unit}, only here {} {unit}, only there {} \
         {unit}.\n",
        of.other,
        significant(of.other_volume_m3, 6),
        significant(of.common_volume_m3, 6),
        significant(of.only_own_m3, 4),
        significant(of.only_other_m3, 4)
    )
}
