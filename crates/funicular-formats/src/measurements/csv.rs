//! Tables of measured responses and of natural frequencies as CSV.
//!
//! Responses: `frequency_hz`, then for each response `NAME_re` and `NAME_im`, or `NAME_abs` and `NAME_phase_deg`, and,
//! if known, `NAME_std`. Lists: `frequency_hz`, `damping_ratio`, `damping_std`, `std_hz`, `weight`, `label`. Time
//! histories begin with `t_s`. Lines that begin with # are comments.

use super::{MeasuredFrequency, MeasuredHistory, MeasuredResponse, ResponseName, check_size, history};
use crate::csv_lines::CsvText;
use anyhow::{Result, anyhow, bail};
use funicular_study::text::clean;
use funicular_study::values::number;

/// Content of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum CsvContent {
    /// Responses.
    Responses(Vec<MeasuredResponse>),
    /// Natural frequencies.
    Frequencies(Vec<MeasuredFrequency>),
    /// Time history, with notes on what was left out.
    History((MeasuredHistory, Vec<String>)),
}

/// Column of frequencies, in both kinds of tables.
const FREQUENCY: &str = "frequency_hz";

/// Other columns of a list.
const LIST: [&str; 5] = ["damping_ratio", "std_hz", "weight", "label", "damping_std"];

/// Maximum number of columns that a message names.
const MAX_NAMED: usize = 8;

/// Endings of the columns of a response: two numbers in Cartesian or polar form, and the deviation.
const ENDINGS: [&str; 5] = ["_re", "_im", "_abs", "_phase_deg", "_std"];

/// Reads a table. `names` gives the signals of responses and `points` the points of the platform [m] for all inputs and
/// all outputs.
///
/// # Errors
/// A table that is too large, has other columns, or a value that is no number; the message names line and column.
pub fn read_csv(
    path: &str,
    bytes: &[u8],
    names: &[ResponseName],
    [input_point_m, output_point_m]: [Option<[f64; 3]>; 2],
) -> Result<CsvContent> {
    check_size(path, bytes.len())?;
    let text = CsvText::open(path, bytes)?;
    let header = text.header.clone();
    if history::is_history(&header) {
        return Ok(CsvContent::History(history::read(path, text, names, output_point_m)?));
    }
    if header.is_empty() {
        bail!("{path} is empty: give a header and one line per frequency");
    }
    let frequency = frequency_column(path, &header)?;
    let CsvRows { values, labels, lines } = rows(path, text, &header, frequency)?;

    let is_response = |name: &String| ENDINGS[..4].iter().any(|ending| name.ends_with(ending));
    if header.iter().any(is_response) {
        let table = Table { path, header: &header, rows: &values, lines: &lines };
        return Ok(CsvContent::Responses(table.responses(frequency, names, input_point_m, output_point_m)?));
    }
    Ok(CsvContent::Frequencies(frequencies(path, &header, frequency, &values, labels)?))
}

/// Index of the column of frequencies.
fn frequency_column(path: &str, header: &[String]) -> Result<usize> {
    if let Some(place) = header.iter().position(|name| name == FREQUENCY) {
        return Ok(place);
    }
    bail!(
        "{path} has no column `{FREQUENCY}`, with which a table of measurements begins; its columns are {}",
        header.iter().take(MAX_NAMED).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
    )
}

/// Lines below the header.
struct CsvRows {
    /// Numbers by line and column; none in an empty cell and in the column of labels.
    values: Vec<Vec<Option<f64>>>,
    labels: Vec<Option<String>>,
    /// Numbers of the lines in the file, from 1.
    lines: Vec<usize>,
}

/// Reads the lines below the header.
fn rows(path: &str, text: CsvText, header: &[String], frequency: usize) -> Result<CsvRows> {
    let label = header.iter().position(|name| name == LIST[3]);
    let mut rows = CsvRows { values: Vec::new(), labels: Vec::new(), lines: Vec::new() };
    for record in text.records() {
        let (line, record) = record?;
        let mut row = Vec::with_capacity(header.len());
        for (place, (text, name)) in record.iter().zip(header).enumerate() {
            let read = if Some(place) == label || text.is_empty() {
                None
            } else {
                Some(number(text).map_err(|reason| anyhow!("{path}, line {line}, column `{name}`: {reason}"))?)
            };
            row.push(read);
        }
        if row[frequency].is_none() {
            bail!("{path}, line {line}: the frequency is missing");
        }

        rows.labels.push(label.and_then(|at| record.get(at)).filter(|text| !text.is_empty()).map(clean));
        rows.lines.push(line);
        rows.values.push(row);
    }

    if rows.values.is_empty() {
        bail!("{path} has a header and no values: give one line per frequency below it");
    }
    Ok(rows)
}

/// Natural frequencies of a list.
fn frequencies(
    path: &str,
    header: &[String],
    frequency: usize,
    rows: &[Vec<Option<f64>>],
    labels: Vec<Option<String>>,
) -> Result<Vec<MeasuredFrequency>> {
    if let Some(unknown) = header.iter().find(|name| *name != FREQUENCY && !LIST.contains(&name.as_str())) {
        bail!(
            "{path} has a column `{unknown}`: a list of natural frequencies has {FREQUENCY}, {}; a table of responses \
             has columns that end in _re and _im, or _abs and _phase_deg",
            LIST.join(", ")
        );
    }

    let place = |name: &str| header.iter().position(|column| column == name);
    let [damping, std, weight, _, damping_std] = LIST.map(place);
    let get = |row: &[Option<f64>], at: Option<usize>| at.and_then(|at| row[at]);
    let frequencies = rows.iter().zip(labels).map(|(row, label)| MeasuredFrequency {
        frequency_hz: row[frequency].unwrap_or_default(),
        damping_ratio: get(row, damping),
        damping_std: get(row, damping_std),
        std_hz: get(row, std),
        weight: get(row, weight),
        label,
    });
    Ok(frequencies.collect())
}

/// Table of responses.
struct Table<'a> {
    path: &'a str,
    header: &'a [String],
    rows: &'a [Vec<Option<f64>>],
    /// Line of each row.
    lines: &'a [usize],
}

impl Table<'_> {
    /// Numbers of a column.
    fn column(&self, at: usize) -> Result<Vec<f64>> {
        let value = |(row, line): (&Vec<Option<f64>>, &usize)| {
            row[at].ok_or_else(|| anyhow!("{}, line {line}: `{}` is missing", self.path, self.header[at]))
        };
        self.rows.iter().zip(self.lines).map(value).collect()
    }

    /// Responses of the table, in the order of their first columns.
    fn responses(
        &self,
        frequency: usize,
        names: &[ResponseName],
        input_point_m: Option<[f64; 3]>,
        output_point_m: Option<[f64; 3]>,
    ) -> Result<Vec<MeasuredResponse>> {
        let path = self.path;
        let mut responses = Vec::new();
        for stem in self.stems(frequency)? {
            let Some(name) = names.iter().find(|name| name.name == stem) else {
                bail!(
                    "{path}: the signals of the response `{stem}` are unknown: give ⟪response⟫ {stem}=OUTPUT/INPUT, as \
                     in {stem}=az/fz"
                );
            };

            let (real, imag) = self.real_and_imaginary(stem)?;
            let [.., std] = self.places(stem);
            responses.push(MeasuredResponse {
                name: clean(stem),
                input: name.input.clone(),
                input_point_m,
                output: name.output.clone(),
                output_point_m,
                frequency_hz: self.column(frequency)?,
                real,
                imag,
                std: std.map(|at| self.column(at)).transpose()?,
            });
        }

        Ok(responses)
    }

    /// Names of the responses: the columns without their endings, each once.
    fn stems(&self, frequency: usize) -> Result<Vec<&str>> {
        let mut stems: Vec<&str> = Vec::new();
        for (place, column) in self.header.iter().enumerate() {
            if place == frequency {
                continue;
            }
            let Some(stem) = ENDINGS.iter().find_map(|ending| column.strip_suffix(ending)) else {
                bail!("{} has a column `{column}`: columns of responses end in {}", self.path, ENDINGS.join(", "));
            };
            if !stems.contains(&stem) {
                stems.push(stem);
            }
        }
        Ok(stems)
    }

    /// Real and imaginary parts of a response.
    fn real_and_imaginary(&self, stem: &str) -> Result<(Vec<f64>, Vec<f64>)> {
        let [re, im, abs, phase, _] = self.places(stem);
        match (re, im, abs, phase) {
            (Some(re), Some(im), None, None) => Ok((self.column(re)?, self.column(im)?)),
            (None, None, Some(abs), Some(phase)) => {
                let (abs, phase) = (self.column(abs)?, self.column(phase)?);
                let polar = abs.iter().zip(&phase).map(|(abs, phase)| {
                    let (sin, cos) = phase.to_radians().sin_cos();
                    (abs * cos, abs * sin)
                });
                Ok(polar.unzip())
            }
            _ => bail!(
                "{}: the response `{stem}` needs the columns `{stem}_re` and `{stem}_im`, or `{stem}_abs` and \
                 `{stem}_phase_deg`",
                self.path
            ),
        }
    }

    /// Columns of a response, in the order of [`ENDINGS`].
    fn places(&self, stem: &str) -> [Option<usize>; 5] {
        ENDINGS.map(|ending| self.header.iter().position(|column| *column == format!("{stem}{ending}")))
    }
}
