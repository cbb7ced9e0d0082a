//! `parameters`: text and CSV.

use crate::output::Printed;
use crate::table::Table;
use funicular_study::analyses::parameters::{ParameterList, ParameterRow};

/// Magnitude from which a value is printed with an exponent.
const LONG: f64 = 1e7;

impl Printed for ParameterList {
    fn text(&self) -> String {
        let mut table = Table::new(&["path", "value", "unit", "range", "meaning"]).text_columns(&[2, 3, 4]);
        for row in &self.parameters {
            let ParameterRow { path, value, unit, range, meaning, given, .. } = row;
            let value = if value.abs() < LONG { format!("{value}") } else { format!("{value:e}") };
            let meaning = if *given { (*meaning).to_owned() } else { format!("{meaning} (default)") };
            table.row(vec![path.clone(), value, (*unit).to_owned(), range.clone(), meaning]);
        }
        format!("{}: {} numbers\n\n{table}", self.robot, self.parameters.len())
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record(["path", "value", "unit", "range", "minimum", "maximum", "meaning", "given"])?;
        for row in &self.parameters {
            out.serialize((
                &row.path,
                row.value,
                row.unit,
                &row.range,
                row.minimum,
                row.maximum,
                row.meaning,
                row.given,
            ))?;
        }
        Ok(())
    }
}
