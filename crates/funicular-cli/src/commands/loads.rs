//! `loads`: text and CSV.

use crate::output::Printed;
use crate::table::{NONE, Table, significant, vector};
use funicular_study::analyses::loads::{Loads, RequiredHeld};
use funicular_study::analyses::payload::LoadedRow;

impl Printed for Loads {
    fn text(&self) -> String {
        let closure = if self.closure { "yes" } else { "no" };
        let dead_load = match &self.dead_load_reason {
            None => "held".to_owned(),
            Some(reason) => format!("not held: {reason}"),
        };
        let with_unit = |value: Option<f64>, unit: &str| {
            value.map_or_else(|| NONE.to_owned(), |value| format!("{} {unit}", significant(value, 6)))
        };
        let required = self.required.as_ref().map_or_else(String::new, required_text);
        let verdict = match &self.required {
            Some(held) if held.held => "held",
            Some(_) => "not held",
            None if self.dead_load_held => "none; give --required-force-n or another one, or [required] in the file",
            None => NONE,
        };

        format!(
            "{}: loads at a pose with {} cables\n\n  position            ({}) m\n  roll, pitch, yaw    ({})°\n  \
             wrench closure      {closure}; {} of {} wrenches, tension factor {}\n  dead load           {dead_load}\n  \
             required loads      {verdict}\n  capacity margin     {}\n  \
             acceleration        {} in every direction\n  (moments over, angular accelerations times {} m)\n{required}",
            self.robot,
            self.static_model,
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            self.rank,
            self.dof,
            significant(self.tension_factor, 4),
            with_unit(self.capacity_margin_n, "N"),
            with_unit(self.acceleration_max_m_s2, "m/s²"),
            significant(self.platform_length_m, 4),
        )
    }
}

/// Load factor with its bounds, and the tensions at the load that binds.
fn required_text(held: &RequiredHeld) -> String {
    let Some(factor) = held.load_factor else {
        if held.force_n.iter().chain(&held.moment_n_m).all(|part| *part == 0.0) {
            return "\nLoad factor: unlimited, the required loads act along motions that the platform does not have\n"
                .to_owned();
        }
        return "\nLoad factor: unlimited, no maximum tension limits it; give --max-tension-n\n".to_owned();
    };
    let bounds = [
        held.load_factor_upper_bound.map(|bound| format!("; {} is proved to be too much", significant(bound, 7))),
        held.load_factor_lower_bound
            .filter(|bound| significant(*bound, 6) != significant(factor, 6))
            .map(|bound| format!("; loads inside the set are surely held up to {}", significant(bound, 6))),
    ];
    let bounds: String = bounds.into_iter().flatten().collect();
    let by = |name: &str, by: Option<[f64; 3]>, unit: &str| {
        by.map_or_else(String::new, |by| format!("  {name}({}) {unit}\n", vector(&by, 5)))
    };
    let by_position = by("by position   ", held.load_factor_by_position_per_m, "1/m");
    let by_rotation = by("by rotation   ", held.load_factor_by_rotation_per_rad, "1/rad");
    let wind = by("binding wind  ", held.wind_m_s, "m/s");
    format!(
        "\nLoad factor {}{bounds}\n{by_position}{by_rotation}{wind}  binding load  force ({}) N, moment ({}) N m\n\n\
         Tensions with this multiple of the binding load\n{}\n",
        significant(factor, 6),
        vector(&held.force_n, 2),
        vector(&held.moment_n_m, 2),
        Table::of(&LoadedRow::columns(), &held.cables)
    )
}
