//! Tables of time histories: `t_s`, `time_s` or `stamp_ns`, then a column per sensor with its unit at the end of its
//! name, as in `az_m_s2`, `gyroscope_x_rad_s`, `tension:3_n`.

use super::{MeasuredHistory, ResponseName};
use crate::csv_lines::CsvText;
use anyhow::{Result, anyhow, bail};
use funicular::response::Quantity;
use funicular_study::measurements::MeasuredChannel;
use funicular_study::signals::{Output, Place};
use funicular_study::text::{clean, counted};
use funicular_study::values::number;

/// Names of the column of times. `stamp_ns` is read in seconds, as all columns in nanoseconds.
const TIMES: [&str; 3] = ["t_s", "time_s", "stamp_s"];

/// Standard acceleration of gravity [m/s²], the unit g of accelerometers.
const STANDARD_GRAVITY: f64 = 9.806_65;

/// Units of sensors that no other table has, with what they become and their size.
const SENSOR_UNITS: [(&str, &str, f64); 4] = [
    ("_deg_s", "_rad_s", std::f64::consts::PI / 180.0),
    ("_deg", "_rad", std::f64::consts::PI / 180.0),
    ("_mg", "_m_s2", 1e-3 * STANDARD_GRAVITY),
    ("_g", "_m_s2", STANDARD_GRAVITY),
];

/// Names that programs give the signals of sensors, before the axis.
const SENSORS: [(&str, &str); 4] =
    [("accelerometer_", "a"), ("acceleration_", "a"), ("gyroscope_", "vr"), ("tracker_", "")];

/// True for the header of a time history.
pub(super) fn is_history(header: &[String]) -> bool {
    header.iter().any(|name| TIMES.contains(&name.as_str()))
}

/// Column of a sensor.
struct SensorColumn {
    at: usize,
    output: Option<String>,
    factor: f64,
}

/// Reads a time history. `names` gives the signals of columns whose names do not tell them. Rows without a reading of
/// every sensor are left out, which a note tells.
///
/// # Errors
/// A column whose unit contradicts its signal, a reading that is no number, or a table without sensors.
pub(super) fn read(
    path: &str,
    text: CsvText<'_>,
    names: &[ResponseName],
    output_point_m: Option<[f64; 3]>,
) -> Result<(MeasuredHistory, Vec<String>)> {
    let (header, written) = (text.header.clone(), text.written.clone());
    let time = header.iter().position(|name| TIMES.contains(&name.as_str())).unwrap_or_default();
    let mut columns = Vec::with_capacity(header.len());
    for (at, name) in header.iter().enumerate().filter(|(at, _)| *at != time) {
        let given = names.iter().find(|given| [name, &written[at]].contains(&&given.name));
        columns.push(sensor_column(path, at, name, given)?);
    }
    if columns.is_empty() {
        bail!("{path} has times and no sensor: give one column per sensor, as in az_m_s2");
    }

    let mut history = MeasuredHistory {
        name: clean(path.rsplit(['/', '\\']).next().unwrap_or(path)),
        time_s: Vec::new(),
        channels: columns
            .iter()
            .map(|column| MeasuredChannel {
                name: clean(&written[column.at]),
                output: column.output.clone(),
                output_point_m: output_point_m.filter(|_| column.output.as_deref().is_some_and(is_at_point)),
                ..MeasuredChannel::default()
            })
            .collect(),
    };
    let mut incomplete = 0;
    for record in text.records() {
        let (line, record) = record?;
        let mut row = Vec::with_capacity(header.len());
        for (cell, name) in record.iter().zip(&written) {
            let is_missing = cell.is_empty() || cell.eq_ignore_ascii_case("nan");
            let read = (!is_missing).then(|| number(cell)).transpose();
            row.push(read.map_err(|reason| anyhow!("{path}, line {line}, column `{name}`: {reason}"))?);
        }
        let Some(row) = row.into_iter().collect::<Option<Vec<f64>>>() else {
            incomplete += 1;
            continue;
        };
        history.time_s.push(row[time]);
        for (column, channel) in columns.iter().zip(&mut history.channels) {
            channel.values.push(column.factor * row[column.at]);
        }
    }
    let note = (incomplete > 0)
        .then(|| format!("{path}: {} left out, in which a sensor has no reading", counted(incomplete, "row")));
    Ok((history, note.into_iter().collect()))
}

/// True for a signal at a point of the platform.
fn is_at_point(output: &str) -> bool {
    Output::parse(output).is_ok_and(|output| matches!(output.place, Place::Platform { turns: false, .. }))
}

/// Signal and factor of a column.
fn sensor_column(path: &str, at: usize, name: &str, given: Option<&ResponseName>) -> Result<SensorColumn> {
    let found = SENSOR_UNITS
        .iter()
        .find_map(|(ending, becomes, size)| Some((format!("{}{becomes}", name.strip_suffix(ending)?), *size)));
    let (name, factor) = found.unwrap_or_else(|| (name.to_owned(), 1.0));
    if let Some(given) = given {
        let output = Output::parse(&given.output)
            .map_err(|error| anyhow!("⟪response⟫ {}: {}: {error}", given.name, given.output))?;
        return Ok(SensorColumn { at, output: Some(output.name), factor });
    }

    let endings = ["_m_s2", "_rad_s2", "_m_s", "_rad_s", "_m", "_rad", "_n"];
    let Some(ending) = endings.into_iter().find(|ending| name.ends_with(ending)) else {
        return Ok(SensorColumn { at, output: None, factor });
    };
    let stem = name.strip_suffix(ending).unwrap_or(&name);
    let aliased = SENSORS.iter().find_map(|(sensor, signal)| Some(format!("{signal}{}", stem.strip_prefix(sensor)?)));
    let signal = aliased.unwrap_or_else(|| stem.to_owned());
    let Ok(output) = Output::parse(&signal) else { return Ok(SensorColumn { at, output: None, factor }) };
    let wanted = unit_of(&output);
    if wanted != ending {
        bail!(
            "{path}: the column `{name}` has the unit {}, and the signal {signal} has {}: correct the name",
            &ending[1..],
            &wanted[1..]
        );
    }
    Ok(SensorColumn { at, output: Some(signal), factor })
}

/// End of the names of a signal's readings.
fn unit_of(output: &Output) -> &'static str {
    match (output.unit(), output.quantity) {
        ("N", _) => "_n",
        ("rad", Quantity::Displacement) => "_rad",
        ("rad", Quantity::Velocity) => "_rad_s",
        ("rad", Quantity::Acceleration) => "_rad_s2",
        (_, Quantity::Displacement) => "_m",
        (_, Quantity::Velocity) => "_m_s",
        (_, Quantity::Acceleration) => "_m_s2",
    }
}
