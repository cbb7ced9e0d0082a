//! `validate`: every comparison of docs/validation.md, made now.

use crate::errors::NoSolution;
use crate::output::Results;
use crate::table::counted;
use crate::validation::{self, Section};
use anyhow::Result;
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Validated {
    comparisons: usize,
    passed: usize,
    sections: Vec<Section>,
}

pub(crate) fn run() -> Result<Validated> {
    let sections = validation::sections()?;
    let rows = || sections.iter().flat_map(|section| &section.rows);
    Ok(Validated { comparisons: rows().count(), passed: rows().filter(|row| row.pass).count(), sections })
}

impl Validated {
    /// # Errors
    /// A comparison that does not pass; the first is named.
    pub(crate) fn verdict(&self) -> Result<()> {
        let Some(first) = self.sections.iter().flat_map(|section| &section.rows).find(|row| !row.pass) else {
            return Ok(());
        };
        let failed = counted(self.comparisons - self.passed, "comparison");
        let text = format!(
            "{failed} of {} not within tolerance, first: {}, {}: difference {:.1e}, tolerance {:.1e}",
            self.comparisons, first.case, first.quantity, first.difference, first.tolerance
        );
        Err(NoSolution(text).into())
    }
}

impl Results for Validated {
    const COMMAND: &'static str = "validate";

    /// Many.
    fn robot(&self) -> &'static str {
        ""
    }

    fn warnings(&self) -> &[String] {
        &[]
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_that_fails_is_named_and_is_no_success() {
        let mut found = run().unwrap();
        assert!(found.verdict().is_ok());
        let row = &mut found.sections[1].rows[0];
        (row.pass, row.difference) = (false, 0.5);
        found.passed -= 1;
        let error = found.verdict().unwrap_err();
        let text = error.to_string();
        assert!(error.is::<NoSolution>(), "exit code 1");
        assert!(
            text.starts_with("1 comparison of ") && text.contains(", first: yuan2014-4mm, 10.55 kg, position [m]"),
            "{text}"
        );
    }
}
