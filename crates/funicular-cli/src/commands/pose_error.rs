//! `pose-error`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, decimals, decimals_or_none, short, significant, vector};
use funicular_study::analyses::pose_error::{PoseErrors, ThresholdRow};

impl Printed for PoseErrors {
    fn text(&self) -> String {
        let mut table = Table::new(&[
            "mass [kg]",
            "spring-ideal [mm]",
            "[°]",
            "catenary-ideal [mm]",
            "[°]",
            "spring-catenary [mm]",
            "[°]",
        ]);
        for point in &self.points {
            let mut row = vec![short(point.mass_kg, 6)];
            for difference in [point.spring_from_ideal, point.catenary_from_ideal, point.spring_from_catenary] {
                row.push(decimals_or_none(difference.map(|d| 1e3 * d.distance_m), 3));
                row.push(difference.map_or_else(|| table::NONE.to_owned(), |d| decimals(d.angle_deg, 4)));
            }
            table.row(row);
        }

        format!(
            "{}: distance and angle between the poses of static models\n{}\n{table}\n{}\n",
            self.robot,
            held_line(self),
            threshold_line(self)
        )
    }
}

/// Line on the origin of the lengths; empty if they are given.
fn held_line(found: &PoseErrors) -> String {
    found.held.as_ref().map_or_else(String::new, |held| {
        let rule = held.tension_rule.map_or_else(String::new, |rule| format!(", tensions by the rule `{rule}`"));
        format!(
            "at the unstrained lengths with which {} kg rest at ({}) m{rule}\n",
            short(held.mass_kg, 6),
            vector(&held.pose.position_m, 6)
        )
    })
}

fn threshold_line(found: &PoseErrors) -> String {
    match &found.threshold {
        None => "Give --tolerance-mm for the minimum mass at which springs are good enough.".to_owned(),
        Some(ThresholdRow { tolerance_mm, from_mass_kg: Some(mass), .. }) => format!(
            "From {} kg on, the spring pose is within {tolerance_mm} mm of the catenary pose; below this mass, sag \
             matters.",
            significant(*mass, 5)
        ),
        Some(ThresholdRow { tolerance_mm, within: "everywhere", .. }) => {
            format!("The spring pose is within {tolerance_mm} mm of the catenary pose at every mass of the range.")
        }
        Some(ThresholdRow { tolerance_mm, .. }) => {
            format!("The spring pose is not within {tolerance_mm} mm of the catenary pose at the end of the range.")
        }
    }
}
