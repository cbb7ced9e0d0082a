//! `statics`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, decimals, decimals_or_none, short, significant, vector};
use funicular_study::analyses::shared::LimitNumbers;
use funicular_study::analyses::statics::{
    DriveRow, EquilibriumRow, FrictionCableRow, FrictionRow, OtherStable, Statics, SupportRow,
};

impl Printed for Statics {
    fn text(&self) -> String {
        let (cables, drives) = (cables_table(self), drives_table(self) + &supports_table(self));
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
            "{}: equilibrium with {} cables, {} kg{load}{wind}{rule}\n\n  position         ({}) m\n  roll, pitch, yaw ({})°\n{nearest}{held}{balanced}\n\
             {cables}\n{drives}{stability}. {balance} after {}.\n{others}{friction}",
            self.robot,
            self.static_model,
            short(self.mass_kg, 6),
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            table::counted(self.iterations, "iteration"),
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        if let Some(equilibria) = &self.equilibria {
            return equilibria_csv(equilibria, out);
        }
        let mut header = vec![
            "name",
            "unstrained_length_m",
            "tension_platform_n",
            "tension_anchor_n",
            "chord_m",
            "sag_ratio",
            "lambda2",
            "string_frequency_hz",
            "force_on_platform_x_n",
            "force_on_platform_y_n",
            "force_on_platform_z_n",
            "minimum_tension_n",
            "maximum_tension_n",
            "tension_margin_n",
            "limit_reached",
        ];
        let drives = self.cables.iter().any(|cable| cable.drive.is_some());
        header.extend(DRIVE_COLUMNS.iter().filter(|_| drives));
        let friction = self.friction_interval.as_ref();
        header.extend(FRICTION_COLUMNS.iter().filter(|_| friction.is_some()));
        out.write_record(header)?;

        for (i, c) in self.cables.iter().enumerate() {
            let limits = c.limits.as_ref();
            out.serialize((
                &c.name,
                c.unstrained_length_m,
                c.tension_platform_n,
                c.tension_anchor_n,
                c.chord_m,
                c.sag.sag_ratio,
                c.sag.lambda2,
                c.sag.string_frequency_hz,
                c.force_on_platform_n,
                limits.map(|l| l.minimum_tension_n),
                limits.and_then(|l| l.maximum_tension_n),
                limits.map(|l| l.tension_margin_n),
                limits.and_then(|l| l.limit_reached),
                if drives { drive_values(c.drive.as_ref()).to_vec() } else { Vec::new() },
                friction.map_or_else(Vec::new, |found| friction_values(&found.cables[i]).to_vec()),
            ))?;
        }
        Ok(())
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

/// Lengths, tensions and sag of the cables, with limits and margin if the robot has limits.
fn cables_table(found: &Statics) -> Table {
    let limited = found.cables.iter().any(|cable| cable.limits.is_some());
    let header = [
        "cable",
        "unstrained [m]",
        "chord [m]",
        "T platform [N]",
        "T anchor [N]",
        "sag/chord",
        "λ²",
        "string [Hz]",
        "limits [N]",
        "margin [N]",
    ];
    let mut cables = Table::new(&header[..if limited { 10 } else { 8 }]);
    let or_none = |value: Option<f64>| value.map_or_else(|| table::NONE.to_owned(), |v| significant(v, 4));
    for cable in &found.cables {
        let mut row = vec![
            cable.name.clone(),
            decimals(cable.unstrained_length_m, 4),
            decimals(cable.chord_m, 4),
            decimals(cable.tension_platform_n, 3),
            decimals(cable.tension_anchor_n, 3),
            decimals_or_none(cable.sag.sag_ratio, 5),
            or_none(cable.sag.lambda2),
            decimals_or_none(cable.sag.string_frequency_hz, 3),
        ];
        row.extend(cable.limits.iter().flat_map(limit_cells));
        cables.row(row);
    }

    cables
}

/// Pulleys and winches; empty if all cables end at fixed points.
fn drives_table(found: &Statics) -> String {
    if found.cables.iter().all(|cable| cable.drive.is_none()) {
        return String::new();
    }
    let header =
        ["cable", "exit point [m]", "wrap [°]", "T drum [N]", "free [m]", "on wheel [m]", "to drum [m]", "yield [mm]"];
    let mut rows = Table::new(&header);
    for cable in &found.cables {
        let Some(drive) = &cable.drive else { continue };
        rows.row(vec![
            cable.name.clone(),
            vector(&drive.exit_m, 4),
            decimals_or_none(drive.wrap_deg, 2),
            decimals(drive.tension_drum_n, 3),
            decimals(drive.free_length_m, 4),
            decimals(drive.arc_length_m, 4),
            decimals(drive.drum_side_length_m, 4),
            decimals(1e3 * drive.winch_yield_m, 3),
        ]);
    }
    format!("{rows}\n")
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

/// Columns of pulleys and winches in CSV.
const DRIVE_COLUMNS: [&str; 9] = [
    "exit_x_m",
    "exit_y_m",
    "exit_z_m",
    "wrap_deg",
    "tension_drum_n",
    "free_length_m",
    "arc_length_m",
    "drum_side_length_m",
    "winch_yield_m",
];

/// Values of [`DRIVE_COLUMNS`]; empty for a cable that ends at a fixed point.
fn drive_values(drive: Option<&DriveRow>) -> [Option<f64>; DRIVE_COLUMNS.len()] {
    let Some(drive) = drive else { return [None; DRIVE_COLUMNS.len()] };
    let [x, y, z] = drive.exit_m.map(Some);
    let lengths = [drive.free_length_m, drive.arc_length_m, drive.drum_side_length_m, drive.winch_yield_m];
    let [free, arc, drum_side, yielded] = lengths.map(Some);
    [x, y, z, drive.wrap_deg, Some(drive.tension_drum_n), free, arc, drum_side, yielded]
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

    // With the pose held the tensions of the free span do not vary.
    let header = ["cable", "exponent", "beyond exit [mm]", "T drum [N]", "T platform [N]", "T anchor [N]"];
    let columns = if found.motion.is_some() { 6 } else { 4 };
    let mut rows = Table::new(&header[..columns]);
    for cable in &found.cables {
        let mut row = vec![
            cable.name.clone(),
            decimals(cable.friction_exponent, 4),
            pair(cable.excess_length_m.map(|metres| 1e3 * metres), 3),
            pair(cable.tension_drum_n, 3),
            pair(cable.tension_platform_n, 3),
            pair(cable.tension_anchor_n, 3),
        ];
        row.truncate(columns);
        rows.row(row);
    }
    format!("\n{held}\n{rows}")
}

/// Columns of the friction interval in CSV.
const FRICTION_COLUMNS: [&str; 9] = [
    "friction_exponent",
    "excess_length_min_m",
    "excess_length_max_m",
    "tension_platform_min_n",
    "tension_platform_max_n",
    "tension_anchor_min_n",
    "tension_anchor_max_n",
    "tension_drum_min_n",
    "tension_drum_max_n",
];

/// Values of [`FRICTION_COLUMNS`].
fn friction_values(cable: &FrictionCableRow) -> [f64; FRICTION_COLUMNS.len()] {
    let [excess, platform, anchor, drum] =
        [cable.excess_length_m, cable.tension_platform_n, cable.tension_anchor_n, cable.tension_drum_n];
    let pairs = [excess, platform, anchor, drum];
    let mut values = [cable.friction_exponent; FRICTION_COLUMNS.len()];
    values[1..].copy_from_slice(pairs.as_flattened());
    values
}

fn equilibria_csv(equilibria: &[EquilibriumRow], out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
    let mut header: Vec<String> = [
        "stable",
        "falling_directions",
        "indifferent_directions",
        "energy_j",
        "distance_m",
        "x_m",
        "y_m",
        "z_m",
        "roll_deg",
        "pitch_deg",
        "yaw_deg",
    ]
    .map(str::to_owned)
    .to_vec();
    let cables = equilibria.first().map_or(0, |row| row.tensions_platform_n.len());
    header.extend((1..=cables).map(|i| format!("tension_platform_{i}_n")));
    out.write_record(&header)?;

    for row in equilibria {
        let state = (row.stable, row.falling_directions, row.indifferent_directions, row.energy_j, row.distance_m);
        out.serialize((state, row.pose.position_m, row.pose.roll_pitch_yaw_deg, &row.tensions_platform_n))?;
    }

    Ok(())
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

/// Limits and margin of a tension as two cells of a table.
fn limit_cells(limits: &LimitNumbers) -> [String; 2] {
    let maximum = limits.maximum_tension_n.map_or_else(|| "∞".to_owned(), |maximum| short(maximum, 4));
    let margin = match limits.limit_reached {
        Some(limit) if limits.tension_margin_n.abs() <= 1e-6 * limits.minimum_tension_n.max(1.0) => limit.to_owned(),
        _ => decimals(limits.tension_margin_n, 1),
    };
    [format!("{} to {maximum}", short(limits.minimum_tension_n, 4)), margin]
}
