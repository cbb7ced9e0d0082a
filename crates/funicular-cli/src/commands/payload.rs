//! `payload`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, short, significant, vector};
use funicular_study::analyses::payload::{LoadedRow, Payload};

impl Printed for Payload {
    fn text(&self) -> String {
        let maximum = match &self.maximum {
            Some(maximum) => {
                let above = maximum.excluded_from_kg.map_or_else(
                    || "; a larger one was not found, but is not excluded by a proof".to_owned(),
                    |mass| format!("; {} kg is proved to be too much", significant(mass, 7)),
                );
                format!("{} kg{above}", significant(maximum.payload_kg, 6))
            }
            None => "unlimited: no maximum tension limits it; give --max-tension-n".to_owned(),
        };
        let minimum = match self.minimum.payload_kg {
            0.0 => "0: the tensions without payload are within their limits".to_owned(),
            mass => format!("{} kg; with less a cable is below its minimum tension", significant(mass, 6)),
        };

        let tables = [("maximum", self.maximum.as_ref()), ("minimum", Some(&self.minimum))];
        let tables: Vec<String> = tables
            .into_iter()
            .filter_map(|(name, bound)| Some((name, bound.filter(|bound| !bound.cables.is_empty())?)))
            .map(|(name, bound)| {
                format!("\nTensions with the {name} payload\n{}\n", Table::of(&LoadedRow::columns(), &bound.cables))
            })
            .collect();

        format!(
            "{}: payload of a platform of {} kg with {} cables\n\n  position           ({}) m\n  \
             roll, pitch, yaw   ({})°\n  centre of payload  ({}) m of the platform\n  maximum payload    {maximum}\n  \
             minimum payload    {minimum}\n{}",
            self.robot,
            short(self.mass_kg, 6),
            self.static_model,
            vector(&self.pose.position_m, 6),
            vector(&self.pose.roll_pitch_yaw_deg, 4),
            vector(&self.payload_center_m, 4),
            tables.concat()
        )
    }
}
