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
