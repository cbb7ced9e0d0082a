//! Columns of numbers from a CSV text, with the line of every row for messages.

use crate::csv_lines::line_at;
use crate::measurements::check_size;
use anyhow::{Result, anyhow, bail};
use funicular_study::request::NumberColumns;
use funicular_study::values::number;

/// Columns of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NumberTable {
    /// Numbers of each column, by its name.
    pub columns: NumberColumns,
    /// Line of each row in the file, from 1.
    pub lines: Vec<usize>,
}

/// Reads a table whose first line names the columns. Lines that begin with # are comments.
///
/// # Errors
/// A table that is too large, a column that is there twice, or a value that is no number; the message names line and
/// column.
///
/// # Example
/// ```
/// let found = funicular_formats::number_columns::read("way.csv", b"t_s,x_m\n0,1\n\n0.5,2\n")?;
/// assert_eq!(found.columns["x_m"], [1.0, 2.0]);
/// assert_eq!(found.lines, [2, 4]);
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read(path: &str, bytes: &[u8]) -> Result<NumberTable> {
    check_size(path, bytes.len())?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes);
    let header = reader.headers().map_err(|error| anyhow!("cannot read {path}: {error}"))?;
    let names: Vec<String> = header.iter().map(|name| name.trim_start_matches('\u{feff}').to_owned()).collect();
    if let Some((_, twice)) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
        bail!("{path} has the column `{twice}` twice: keep one of them");
    }

    let (mut values, mut lines) = (vec![Vec::new(); names.len()], Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths { pos: Some(position), expected_len, len } => anyhow!(
                "{path}, line {}: {len} values, but {expected_len} in the header: give all lines the same columns",
                line_at(bytes, position)
            ),
            _ => anyhow!("cannot read {path}: {error}"),
        })?;
        let line = record.position().map_or(0, |position| line_at(bytes, position));
        for ((text, name), values) in record.iter().zip(&names).zip(&mut values) {
            values.push(number(text).map_err(|reason| anyhow!("{path}, line {line}, column `{name}`: {reason}"))?);
        }
        lines.push(line);
    }
    Ok(NumberTable { columns: names.into_iter().zip(values).collect(), lines })
}
