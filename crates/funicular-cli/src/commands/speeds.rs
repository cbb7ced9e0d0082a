//! `speeds`: text and CSV.

use crate::output::Printed;
use crate::table::{NONE, Table, decimals, significant, vector};
use funicular_study::analyses::speeds::{CableSpeeds, LargestSpeed, RequiredSpeeds, Speeds};

impl Printed for Speeds {
    fn text(&self) -> String {
        let required = self.required.as_ref().map_or_else(
            || {
                "  required velocities none; give --required-velocity-m-s, --required-angular-velocity-rad-s, or \
                 [required] in the file\n"
                    .to_owned()
            },
            required_text,
        );
        format!(
            "{}: speeds at a pose with {} cables{}\n\n  position            ({}) m\n  \
             roll, pitch, yaw    ({})°\n{required}  without turning     {}\n\n{}\n{}\n{}",
            self.robot,
            self.static_model,
            self.origin.phrase(),
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            largest(&self.every_direction, " m/s in every direction"),
            directions(self),
            rates(self),
            Table::of(&CableSpeeds::columns(self.required.is_some()), &self.cables),
        )
    }
}

/// Work of the winches for the required velocities.
fn required_text(required: &RequiredSpeeds) -> String {
    format!(
        "  required velocities ({}) m/s, ({}) rad/s{}: {}\n  speed factor        {}\n  powers              motors that \
         drive {} W, motors that brake {} W, all together\n",
        vector(&required.velocity_m_s, 3),
        vector(&required.angular_velocity_rad_s, 3),
        if required.velocity_shape == "box" { "" } else { ", half axes of ellipsoids" },
        if required.reached { "reached" } else { "not reached" },
        largest(&required.speed_factor, ""),
        significant(required.driving_power_w, 4),
        significant(required.braking_power_w, 4),
    )
}

/// Largest speed with its winch and limit.
fn largest(of: &LargestSpeed, unit: &str) -> String {
    match (of.value, &of.cable, of.limit) {
        (Some(value), Some(cable), Some(limit)) => {
            format!("{}{unit}, by the {limit} of the winch of cable {cable}", significant(value, 4))
        }
        _ => "no winch limits it".to_owned(),
    }
}

/// Largest speeds along and about the axes.
fn directions(found: &Speeds) -> String {
    let mut rows =
        Table::new(&["direction", "unit", "forward", "by cable", "backward", "by cable"]).text_columns(&[1, 3, 5]);
    for row in &found.directions {
        let mut cells = vec![row.coordinate.to_owned(), row.unit.to_owned()];
        for of in [&row.forward, &row.backward] {
            cells.push(of.value.map_or_else(|| NONE.to_owned(), |value| significant(value, 4)));
            let by = of.cable.as_ref().zip(of.limit).map(|(cable, limit)| format!("{cable} ({limit})"));
            cells.push(by.unwrap_or_else(|| NONE.to_owned()));
        }
        rows.row(cells);
    }
    format!("Largest speeds of the platform\n{rows}")
}

/// Speeds of the cables per unit of each velocity of the platform.
fn rates(found: &Speeds) -> String {
    let header = ["cable", "per vx [1]", "per vy [1]", "per vz [1]", "per ωx [m]", "per ωy [m]", "per ωz [m]"];
    let mut rows = Table::new(&header);
    for cable in &found.cables {
        let all = cable.rate_per_velocity.iter().chain(&cable.rate_per_angular_velocity_m_per_rad);
        rows.row([cable.name.clone()].into_iter().chain(all.map(|rate| decimals(*rate, 4))).collect());
    }
    format!("Speed of each cable at its drum, positive while it pays out\n{rows}")
}
