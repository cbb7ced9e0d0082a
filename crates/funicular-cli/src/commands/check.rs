//! `check`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, decimals_or_none, short, vector};
use funicular::robot::{Constraint, PlatformMotion};
use funicular_study::analyses::check::{
    Checked, CheckedBody, CheckedCable, CheckedPlatform, CheckedRope, CheckedWinch,
};
use funicular_study::text::counted;
use std::fmt::Write;

impl Printed for Checked {
    fn text(&self) -> String {
        let mut out = format!("{}\n", self.robot);
        let mut say = |line: String| out.push_str(&(line + "\n"));

        if !self.source.is_empty() {
            say(format!("  source      {}", self.source));
        }

        cable_lines(self).into_iter().for_each(&mut say);
        let platform = &self.platform;
        say(format!("  platform    {}, {} kg", platform_kind(platform), short(platform.mass_kg, 6)));
        if platform.motion != PlatformMotion::PointMass.name() {
            let rows = platform.inertia_kg_m2;
            let cell = |i: usize, j: usize| short(rows[i][j], 5);
            say(format!(
                "  inertia     xx {}, yy {}, zz {}, xy {}, xz {}, yz {} kg m² about the centre of mass",
                cell(0, 0),
                cell(1, 1),
                cell(2, 2),
                cell(0, 1),
                cell(0, 2),
                cell(1, 2)
            ));
            say(format!("  mass centre ({}) m in the platform frame", vector(&platform.center_of_mass_m, 4)));
        }

        // Loads.
        say(format!("  gravity     ({}) m/s²", vector(&self.gravity_m_s2, 4)));
        if let Some(load) = &self.load {
            say(format!("  load        {}", load.text()));
        }
        if let Some(wind) = &self.wind {
            say(format!("  wind        {}", wind.text()));
        }
        if let Some(area) = platform.drag_area_m2 {
            say(format!("  drag area   {} m² (drag coefficient times area), at the centre of mass", short(area, 4)));
        }

        let state = match &self.pose {
            Some(pose) => format!(
                "pose ({}) m, roll, pitch, yaw ({})°",
                vector(&pose.position_m, 4),
                vector(&pose.roll_pitch_yaw_deg, 3)
            ),
            None if self.state == "lengths" => "unstrained lengths".to_owned(),
            None => "none: analyses need --lengths-m or --pose".to_owned(),
        };
        say(format!("  state       {state}"));
        for line in labelled_requirements(self) {
            say(line);
        }
        out += &("\n".to_owned()
            + &Table::of(&CheckedRope::columns(&self.materials), &self.materials).to_string()
            + "\n"
            + &Table::of(&CheckedCable::columns(&self.cables), &self.cables).to_string()
            + &drive_table(self)
            + &support_table(self)
            + &body_table("obstacle", &self.obstacles)
            + &body_table("platform body", &self.platform_bodies));
        for note in &self.notes {
            let _ = write!(out, "\nNote: {note}.\n");
        }
        out
    }
}

/// Number of cables beside that of degrees of freedom; that of ropes if some run over sheaves.
fn redundancy(found: &Checked) -> String {
    let shared = found.cables.iter().filter(|cable| cable.shares_rope_with.is_some()).count();
    let ropes = found.cables.len() - shared;
    let compared = match Constraint::new(ropes, found.degrees_of_freedom) {
        Constraint::Under(missing) => format!("{missing} fewer than degrees of freedom"),
        Constraint::Fully => "as many as degrees of freedom".to_owned(),
        Constraint::Redundantly(redundant) => format!("{redundant} more than degrees of freedom"),
    };
    if shared == 0 { compared } else { format!("of {}: {compared}", counted(ropes, "rope")) }
}

/// Number of cables, and a line with the cables of each rope over sheaves.
fn cable_lines(found: &Checked) -> Vec<String> {
    let next = |name: &str| found.cables.iter().find(|cable| cable.shares_rope_with.as_deref() == Some(name));
    let is_first = |cable: &&CheckedCable| cable.shares_rope_with.is_none() && next(&cable.name).is_some();
    let line = |first: &CheckedCable| {
        let (mut names, mut name) = (format!("\"{}\"", first.name), first.name.clone());
        while let Some(cable) = next(&name) {
            let efficiency = cable.sheave_efficiency.filter(|efficiency| *efficiency < 1.0);
            let sheave = efficiency.map_or_else(String::new, |value| format!(" (sheave η = {})", short(value, 4)));
            let _ = write!(names, ", \"{}\"{sheave}", cable.name);
            name.clone_from(&cable.name);
        }
        format!("  one rope    cables {names} over sheaves")
    };
    let count = format!("  cables      {}, {}", found.cables.len(), redundancy(found));
    std::iter::once(count).chain(found.cables.iter().filter(is_first).map(line)).collect()
}

/// Kind of the platform in words, with the plane in which it moves.
fn platform_kind(platform: &CheckedPlatform) -> String {
    match (platform.plane_normal, platform.plane_offset_m) {
        (Some(normal), Some(offset)) => {
            format!(
                "{} platform, plane with normal ({}), {} m from the origin",
                platform.motion,
                vector(&normal, 4),
                short(offset, 4)
            )
        }
        _ if platform.motion == PlatformMotion::PointMass.name() => "point mass".to_owned(),
        _ => "rigid platform".to_owned(),
    }
}

/// Pulleys and winches of the cables; empty if all cables end at fixed points.
fn drive_table(found: &Checked) -> String {
    if found.cables.iter().all(|cable| cable.pulley.is_none() && cable.winch.is_none()) {
        return String::new();
    }
    let friction = |cable: &CheckedCable| cable.pulley.as_ref().and_then(|pulley| pulley.friction.text());
    let has_friction = found.cables.iter().any(|cable| friction(cable).is_some());
    let drive = |cable: &CheckedCable| cable.winch.as_ref().and_then(CheckedWinch::drive_text);
    let moves = found.cables.iter().any(|cable| drive(cable).is_some());
    let limits = |cable: &CheckedCable| cable.winch.as_ref().and_then(|winch| winch.limits.text());
    let has_limits = found.cables.iter().any(|cable| limits(cable).is_some());
    let mut header =
        vec!["cable", "pulley", "radius [m]", "entry direction", "winch", "to drum [m]", "stiffness [N/m]"];
    let more = [(moves, "at the cable"), (has_limits, "limits"), (has_friction, "friction")];
    header.extend(more.into_iter().filter_map(|(is_shown, name)| is_shown.then_some(name)));
    let mut rows = Table::new(&header).text_columns(&[1, 4]);

    for cable in &found.cables {
        let (pulley, winch) = (cable.pulley.as_ref(), cable.winch.as_ref());
        let none = || table::NONE.to_owned();
        let stiffness = |winch: &CheckedWinch| winch.stiffness_n_per_m.map_or("rigid".to_owned(), |k| short(k, 6));
        let mut row = vec![
            cable.name.clone(),
            pulley.map_or_else(none, |pulley| pulley.name.clone()),
            pulley.map_or_else(none, |pulley| short(pulley.radius_m, 6)),
            pulley.map_or_else(none, |pulley| format!("({})", vector(&pulley.entry_direction, 3))),
            winch.map_or_else(none, |winch| winch.name.clone()),
            winch.map_or_else(none, |winch| short(winch.drum_side_length_m, 6)),
            winch.map_or_else(none, stiffness),
        ];
        if moves {
            row.push(drive(cable).unwrap_or_else(none));
        }
        if has_limits {
            row.push(limits(cable).unwrap_or_else(none));
        }
        if has_friction {
            row.push(friction(cable).unwrap_or_else(none));
        }
        rows.row(row);
    }

    format!("\n{rows}{}", length_table(found))
}

/// Flexible supports with the cables that they carry; empty on a rigid frame.
fn support_table(found: &Checked) -> String {
    if found.supports.is_empty() {
        return String::new();
    }
    let header = ["support", "cables", "kx, ky, kz [N/m]", "mass [kg]", "damping", "alone [Hz]", "drums"];
    let mut rows = Table::new(&header).text_columns(&[1, 6]);
    for support in &found.supports {
        let carried = found.cables.iter().filter(|cable| cable.support.as_deref() == Some(&support.name));
        let names: Vec<&str> = carried.map(|cable| cable.name.as_str()).collect();
        let diagonal: Vec<String> = (0..3).map(|k| short(support.stiffness_n_per_m[k][k], 4)).collect();
        rows.row(vec![
            support.name.clone(),
            names.join(", "),
            diagonal.join(", "),
            short(support.mass_kg, 4),
            short(support.damping_ratio, 4),
            decimals_or_none(support.first_frequency_hz, 2),
            support.drums.to_owned(),
        ]);
    }
    format!("\n{rows}")
}

/// Required loads and velocities, a line for each; empty if nothing is required.
fn requirements(found: &Checked) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(required) = &found.required {
        lines.push(format!("{}; shape: {}", required.parts().join("; "), required.shape));
    }
    lines.extend(found.required_loads.iter().map(|load| format!("or {}", load.text())));
    if found.required.is_none()
        && let Some(first) = lines.first_mut()
    {
        *first = first.trim_start_matches("or ").to_owned();
    }
    lines
}

/// Required loads, velocities and distances, as lines of the description.
fn labelled_requirements(found: &Checked) -> Vec<String> {
    let loads = requirements(found);
    let label = |k: usize| if k == 0 { "required" } else { "" };
    let loads = loads.iter().enumerate().map(|(k, line)| format!("  {:<12}{line}", label(k)));
    loads.chain(clearance(found).map(|line| format!("  clearance   {line}"))).collect()
}

/// Required distances; `None` for a robot that is not judged by distances.
fn clearance(found: &Checked) -> Option<String> {
    let has_bodies = !found.obstacles.is_empty() || !found.platform_bodies.is_empty();
    let without = || has_bodies.then(|| "no distances required: things must not touch".to_owned());
    found.clearance.as_ref().map_or_else(without, |clearance| Some(clearance.text()))
}

/// Obstacles or bodies of the platform; empty without any.
fn body_table(what: &str, bodies: &[CheckedBody]) -> String {
    if bodies.is_empty() {
        return String::new();
    }
    let mut rows = Table::new(&[what, "shape", "size", "place"]).text_columns(&[1, 2, 3]);
    for body in bodies {
        rows.row(vec![body.name.clone(), body.shape.to_owned(), body.size_text(), body.place_text()]);
    }
    format!("\n{rows}")
}

/// Lengths counted from the drum and to the anchor point; empty without known lengths.
fn length_table(found: &Checked) -> String {
    if found.cables.iter().all(|cable| cable.length_parts.is_none()) {
        return String::new();
    }
    let mut rows = Table::new(&["cable", "unstrained [m]", "to the anchor [m]", "beyond [m]"]);
    for cable in &found.cables {
        let parts = cable.length_parts.as_ref();
        rows.row(vec![
            cable.name.clone(),
            decimals_or_none(cable.unstrained_length_m, 4),
            decimals_or_none(parts.map(|parts| parts.to_anchor_m), 4),
            decimals_or_none(parts.map(|parts| parts.beyond_anchor_m), 4),
        ]);
    }
    format!(
        "\n{rows}\nUnstrained lengths count from the drum. A length that was measured from the anchor point to the \
         attachment needs the last column added.\n"
    )
}
