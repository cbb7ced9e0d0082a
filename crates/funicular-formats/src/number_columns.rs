//! Columns of numbers from a CSV text, with the line of every row for messages.

use crate::csv_lines::CsvText;
use crate::measurements::check_size;
use crate::number_table::NumberTable;
use crate::{belt_lengths, gcode, ros_poses};
use anyhow::{Result, anyhow};
use funicular_study::values::{NumberError, number};
use serde_json::{Map, Value};

/// Reads a table whose first line names the columns. Columns in units such as `_in` and `_ft` get those of the program
/// and their names (`_m`). A file with an ending of G-code is a job, whose moves are the rows; poses
/// of ROS get the names of a path. Lines that begin with # are comments.
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
    if gcode::is_gcode(path) {
        return gcode::read(path, bytes);
    }
    check_size(path, bytes.len())?;
    let text = CsvText::open(path, bytes)?;
    if ros_poses::is_of_ros(&text.header) {
        return ros_poses::read(path, text);
    }
    read_by(path, bytes, number)
}

/// Reads such a table in which cells may be empty, or lengths of belts in a log or in JSON.
///
/// # Errors
/// Those of [`read`].
///
/// # Example
/// ```
/// let found = funicular_formats::number_columns::read_with_gaps("read.csv", b"a,b\n0,\n0.5,2\n")?;
/// assert_eq!(found.columns["b"], [None, Some(2.0)]);
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read_with_gaps(path: &str, bytes: &[u8]) -> Result<NumberTable<Option<f64>>> {
    if belt_lengths::has_lengths(path, bytes) {
        return belt_lengths::read(path, bytes);
    }
    read_by(path, bytes, |text| if text.is_empty() { Ok(None) } else { number(text).map(Some) })
}

/// Reads such a table of texts and numbers as objects, one per row. Empty cells are left out; a `name` is a text.
///
/// # Errors
/// A table that is too large, or a column that is there twice.
///
/// # Example
/// ```
/// let found = funicular_formats::number_columns::read_records("winches.csv", b"name,speed_m_s\nA,1.5\nB,\n")?;
/// assert_eq!((found[0]["name"].as_str(), found[0]["speed_m_s"].as_f64()), (Some("A"), Some(1.5)));
/// assert!(!found[1].contains_key("speed_m_s"));
/// # Ok::<(), anyhow::Error>(())
/// ```
pub fn read_records(path: &str, bytes: &[u8]) -> Result<Vec<Map<String, Value>>> {
    let table = read_by(path, bytes, |text| Ok(text.to_owned()))?;
    let value = |name: &str, text: &str| match number(text) {
        Ok(number) if name != "name" => number.into(),
        _ => Value::from(text),
    };
    let row = |row: usize| {
        let cells = table.columns.iter().map(|(name, values)| (name, &values[row]));
        cells.filter(|(_, text)| !text.is_empty()).map(|(name, text)| (name.clone(), value(name, text))).collect()
    };
    Ok((0..table.lines.len()).map(row).collect())
}

fn read_by<V: Clone>(
    path: &str,
    bytes: &[u8],
    value: impl Fn(&str) -> Result<V, NumberError>,
) -> Result<NumberTable<V>> {
    check_size(path, bytes.len())?;
    let text = CsvText::open(path, bytes)?;
    let (names, written) = (text.header.clone(), text.written.clone());

    let (mut values, mut lines) = (vec![Vec::new(); names.len()], Vec::new());
    for record in text.records() {
        let (line, record) = record?;
        for ((text, name), values) in record.iter().zip(&written).zip(&mut values) {
            values.push(value(text).map_err(|reason| anyhow!("{path}, line {line}, column `{name}`: {reason}"))?);
        }
        lines.push(line);
    }
    Ok(NumberTable { columns: names.into_iter().zip(values).collect(), lines, notes: Vec::new() })
}
