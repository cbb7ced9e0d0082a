//! `winches`: text.

use crate::output::Printed;
use crate::table::{NONE, Table, significant, vector};
use funicular_study::analyses::winches::{AskedRow, OfferRow, WinchRow, Winches};
use funicular_study::text::with_unit;
use std::fmt::Write as _;

impl Printed for Winches {
    fn text(&self) -> String {
        let mut text = format!(
            "{}: winches for {} of {} poses, {} cables\n\n{}\n\n{}\n{}",
            self.robot,
            self.held,
            self.poses,
            self.static_model,
            self.sentence(),
            asked(&self.asked),
            Table::of(&WinchRow::columns(), &self.winches),
        );
        if let Some(offers) = &self.offers {
            let _ = write!(text, "\nWinches on offer\n{}", Table::of(&OfferRow::columns(), offers));
        }
        text
    }
}

/// Table of what asks for each number.
fn asked(rows: &[AskedRow]) -> String {
    let header = ["largest", "", "cable", "at [m]", "load [N]", "[N m]", "velocity [m/s]", "[rad/s]"];
    let mut table = Table::new(&header).text_columns(&[0, 1, 2, 3, 4, 5, 6, 7]);
    for row in rows {
        let moving = |of: &Option<[f64; 3]>| of.as_ref().map_or_else(|| NONE.to_owned(), |of| vector(of, 2));
        table.row(vec![
            row.quantity.to_owned(),
            with_unit(&significant(row.value, 4), row.unit),
            row.cable.clone(),
            vector(&row.pose.position_m, 2),
            vector(&row.force_n, 1),
            vector(&row.moment_n_m, 1),
            moving(&row.velocity_m_s),
            moving(&row.angular_velocity_rad_s),
        ]);
    }
    table.to_string()
}
