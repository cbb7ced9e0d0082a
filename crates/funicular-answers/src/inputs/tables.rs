//! Reading of a table of numbers that a request holds.

use anyhow::{Context, Result, anyhow};
use funicular_formats::number_columns;
use funicular_formats::number_table::NumberTable;
use funicular_study::TableFault;
use funicular_study::request::{GappedColumns, NumberColumns};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Reads the columns of a CSV file, `what` in messages, and checks them.
///
/// # Errors
/// A file that cannot be read, or a fault of its table; the message names the line.
pub(super) fn read(
    path: &Path,
    what: &str,
    notes: &mut Vec<String>,
    check: impl FnOnce(&NumberColumns) -> Result<(), TableFault>,
) -> Result<NumberColumns> {
    read_by(path, what, notes, number_columns::read, check)
}

/// Reads such columns in which cells may be empty.
///
/// # Errors
/// Those of [`read`].
pub(super) fn read_with_gaps(
    path: &Path,
    what: &str,
    check: impl FnOnce(&GappedColumns) -> Result<(), TableFault>,
) -> Result<GappedColumns> {
    read_by(path, what, &mut Vec::new(), number_columns::read_with_gaps, check)
}

/// Reads the rows of a CSV file as objects.
///
/// # Errors
/// A file that cannot be read, or a fault of its table.
pub(super) fn read_records(path: &Path, what: &str) -> Result<Vec<Map<String, Value>>> {
    let shown = path.display();
    let bytes = fs::read(path).with_context(|| format!("cannot read {what} {shown}"))?;
    number_columns::read_records(&shown.to_string(), &bytes)
}

fn read_by<V>(
    path: &Path,
    what: &str,
    notes: &mut Vec<String>,
    table_of: impl FnOnce(&str, &[u8]) -> Result<NumberTable<V>>,
    check: impl FnOnce(&BTreeMap<String, Vec<V>>) -> Result<(), TableFault>,
) -> Result<BTreeMap<String, Vec<V>>> {
    let shown = path.display();
    let bytes = fs::read(path).with_context(|| format!("cannot read {what} {shown}"))?;
    let table = table_of(&shown.to_string(), &bytes)?;
    check(&table.columns).map_err(|fault| {
        let line =
            fault.row.and_then(|row| table.lines.get(row)).map_or(String::new(), |line| format!(", line {line}"));
        anyhow!("{shown}{line}: {}", fault.text)
    })?;
    notes.extend(table.notes);
    Ok(table.columns)
}
