//! `validate`: its run, text and CSV.

use crate::interrupt;
use crate::output::{Printed, Sink};
use anyhow::Result;
use funicular_validation::{Validated, markdown, run};

/// Makes all comparisons and prints them. One out of tolerance is an error.
pub(super) fn print(sink: &Sink) -> Result<()> {
    let computes = interrupt::stop_analysis();
    let found = run()?;
    drop(computes);
    sink.write(&found)?;
    Ok(found.verdict()?)
}

impl Printed for Validated {
    fn text(&self) -> String {
        markdown(&self.sections)
    }
}
