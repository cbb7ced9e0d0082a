//! `payload`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, decimals, short, significant, vector};
use funicular_study::analyses::payload::{BoundRow, Payload};

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
            .map(|(name, bound)| format!("\nTensions with the {name} payload\n{}\n", tensions(bound)))
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

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "bound",
            "payload_kg",
            "excluded_from_kg",
            "name",
            "tension_platform_n",
            "tension_anchor_n",
            "minimum_tension_n",
            "maximum_tension_n",
            "tension_margin_n",
            "limit_reached",
            "limit_place",
        ])?;

        for (name, bound) in [("minimum", Some(&self.minimum)), ("maximum", self.maximum.as_ref())] {
            for cable in bound.iter().flat_map(|bound| &bound.cables) {
                let bound = bound.map(|bound| (bound.payload_kg, bound.excluded_from_kg));
                let limits = &cable.limits;
                out.serialize((
                    name,
                    bound.map(|of| of.0),
                    bound.and_then(|of| of.1),
                    &cable.name,
                    (cable.tension_platform_n, cable.tension_anchor_n),
                    (limits.minimum_tension_n, limits.maximum_tension_n, limits.tension_margin_n),
                    (limits.limit_reached, cable.limit_place),
                ))?;
            }
        }
        Ok(())
    }
}

/// Table of the tensions with a payload.
fn tensions(bound: &BoundRow) -> Table {
    let mut table =
        Table::new(&["cable", "T platform [N]", "T anchor [N]", "limits [N]", "at its limit"]).text_columns(&[4]);
    for cable in &bound.cables {
        let limits = &cable.limits;
        let maximum = limits.maximum_tension_n.map_or_else(|| "∞".to_owned(), |maximum| short(maximum, 4));
        let reached = limits.limit_reached.zip(cable.limit_place);
        table.row(vec![
            cable.name.clone(),
            decimals(cable.tension_platform_n, 3),
            decimals(cable.tension_anchor_n, 3),
            format!("{} to {maximum}", short(limits.minimum_tension_n, 4)),
            reached.map_or_else(|| table::NONE.to_owned(), |(limit, place)| format!("{limit}, {place}")),
        ]);
    }
    table
}
