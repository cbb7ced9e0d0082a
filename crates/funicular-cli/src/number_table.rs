//! Reading of a table of numbers that a request holds.

use anyhow::{Context, Result, anyhow};
use funicular_formats::number_columns;
use funicular_study::TableFault;
use funicular_study::request::NumberColumns;
use std::fs;
use std::path::Path;

/// Reads the columns of a CSV file, `what` in messages, and checks them.
///
/// # Errors
/// A file that cannot be read, or a fault of its table; the message names the line.
pub(crate) fn read(
    path: &Path,
    what: &str,
    check: impl FnOnce(&NumberColumns) -> Result<(), TableFault>,
) -> Result<NumberColumns> {
    let shown = path.display();
    let bytes = fs::read(path).with_context(|| format!("cannot read {what} {shown}"))?;
    let table = number_columns::read(&shown.to_string(), &bytes)?;
    check(&table.columns).map_err(|fault| {
        let line =
            fault.row.and_then(|row| table.lines.get(row)).map_or(String::new(), |line| format!(", line {line}"));
        anyhow!("{shown}{line}: {}", fault.text)
    })?;
    Ok(table.columns)
}
