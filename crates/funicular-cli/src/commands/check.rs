//! `check`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, components, decimals_or_none, short, vector};
use funicular::robot::{Constraint, PlatformMotion};
use funicular_study::analyses::check::{
    Checked, CheckedCable, CheckedLimits, CheckedPlatform, CheckedRope, CheckedWinch,
};
use std::fmt::Write;

impl Printed for Checked {
    fn text(&self) -> String {
        let mut out = format!("{}\n", self.robot);
        let mut say = |line: String| out.push_str(&(line + "\n"));

        if !self.source.is_empty() {
            say(format!("  source      {}", self.source));
        }

        say(format!("  cables      {}, {}", self.cables.len(), redundancy(self)));
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
        out += &("\n".to_owned()
            + &rope_table(self)
            + "\n"
            + &cable_table(self)
            + &drive_table(self)
            + &support_table(self));
        for note in &self.notes {
            let _ = write!(out, "\nNote: {note}.\n");
        }
        out
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "name",
            "material",
            "anchor_x_m",
            "anchor_y_m",
            "anchor_z_m",
            "attachment_x_m",
            "attachment_y_m",
            "attachment_z_m",
            "unstrained_length_m",
            "minimum_tension_n",
            "maximum_tension_n",
            "load_x_n_per_m",
            "load_y_n_per_m",
            "load_z_n_per_m",
        ])?;

        for c in &self.cables {
            let CheckedLimits { minimum_tension_n, maximum_tension_n } = c.limits;
            let limits = (minimum_tension_n, maximum_tension_n);
            let load = c.load_n_per_m.unwrap_or_default();
            out.serialize((&c.name, &c.material, c.anchor_m, c.attachment_m, c.unstrained_length_m, limits, load))?;
        }
        Ok(())
    }
}

/// Number of cables beside that of degrees of freedom.
fn redundancy(found: &Checked) -> String {
    match Constraint::new(found.cables.len(), found.degrees_of_freedom) {
        Constraint::Under(missing) => format!("{missing} fewer than degrees of freedom"),
        Constraint::Fully => "as many as degrees of freedom".to_owned(),
        Constraint::Redundantly(redundant) => format!("{redundant} more than degrees of freedom"),
    }
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
    let mut header =
        vec!["cable", "pulley", "radius [m]", "entry direction", "winch", "to drum [m]", "stiffness [N/m]"];
    header.extend(moves.then_some("at the cable").into_iter().chain(has_friction.then_some("friction")));
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

fn rope_table(found: &Checked) -> String {
    let limited = |rope: &CheckedRope| limit_cells(&rope.limits).iter().any(|cell| cell != table::NONE);
    let limited = found.materials.iter().any(|rope| limited(rope) || rope.breaking_load_n.is_some());
    let header = [
        "rope",
        "EA [N]",
        "mass [kg/m]",
        "damping ratio",
        "viscous damping [N s/m²]",
        "min T [N]",
        "max T [N]",
        "breaks at [N]",
        "drag width [m]",
    ];
    let dragged = found.materials.iter().any(|rope| rope.drag_width_m.is_some());
    let is_lossy = |rope: &CheckedRope| rope.axial_loss_factor.is_some() || rope.axial_damping_time_s.is_some();
    let lossy = found.materials.iter().any(is_lossy);
    let mut columns = header[..5].to_vec();
    columns.extend(if lossy { &["loss factor", "damping time [s]"][..] } else { &[] });
    columns.extend(if limited { &header[5..8] } else { &[] });
    columns.extend(dragged.then_some(header[8]));

    let mut ropes = Table::new(&columns);
    for rope in &found.materials {
        let mut row = vec![
            rope.name.clone(),
            short(rope.axial_stiffness_n, 6),
            short(rope.mass_kg_per_m, 5),
            or_none(rope.damping_ratio),
            or_none(rope.viscous_damping_n_s_m2),
        ];
        if lossy {
            row.extend([or_none(rope.axial_loss_factor), or_none(rope.axial_damping_time_s)]);
        }
        if limited {
            row.extend(limit_cells(&rope.limits));
            row.push(or_none(rope.breaking_load_n));
        }
        if dragged {
            row.push(or_none(rope.drag_width_m));
        }
        ropes.row(row);
    }

    ropes.to_string()
}

fn cable_table(found: &Checked) -> String {
    let limited = found.cables.iter().any(|cable| limit_cells(&cable.limits).iter().any(|cell| cell != table::NONE));
    let header = ["cable", "rope", "anchor [m]", "attachment [m]", "unstrained [m]", "min T [N]", "max T [N]"];
    let loaded = found.cables.iter().any(|cable| cable.load_n_per_m.is_some());
    let mut columns = header[..if limited { 7 } else { 5 }].to_vec();
    columns.extend(loaded.then_some("load [N/m]"));

    let mut cables = Table::new(&columns).text_columns(&[1]);
    for cable in &found.cables {
        let point = |values: &[f64; 3]| components(values, 4);
        let mut row = vec![
            cable.name.clone(),
            cable.material.clone(),
            point(&cable.anchor_m),
            point(&cable.attachment_m),
            decimals_or_none(cable.unstrained_length_m, 4),
        ];
        if limited {
            row.extend(limit_cells(&cable.limits));
        }
        if loaded {
            row.push(cable.load_n_per_m.as_ref().map_or_else(|| table::NONE.to_owned(), point));
        }
        cables.row(row);
    }

    cables.to_string()
}

/// Minimum and maximum tension as two cells of a table.
fn limit_cells(limits: &CheckedLimits) -> [String; 2] {
    [or_none(limits.minimum_tension_n), or_none(limits.maximum_tension_n)]
}

fn or_none(value: Option<f64>) -> String {
    value.map_or_else(|| table::NONE.to_owned(), |value| short(value, 4))
}
