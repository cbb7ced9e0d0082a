//! `validate`: text and CSV.

use crate::output::Printed;
use funicular_study::validation;
use funicular_study::validation::Validated;

impl Printed for Validated {
    fn text(&self) -> String {
        validation::markdown(&self.sections)
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record([
            "section",
            "case",
            "quantity",
            "difference",
            "kind",
            "tolerance",
            "bounded_by",
            "pass",
            "source",
        ])?;

        for section in &self.sections {
            for row in &section.rows {
                out.serialize((
                    section.title,
                    &row.case,
                    &row.quantity,
                    row.difference,
                    row.kind,
                    row.tolerance,
                    row.bounded_by,
                    row.pass,
                    &row.source,
                ))?;
            }
        }
        Ok(())
    }
}
