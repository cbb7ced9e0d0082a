//! Table of the points of cables in CSV.

use super::{LengthUnit, NewMotion};
use crate::csv_lines::{TableForm, line_at};
use anyhow::{Result, anyhow, bail};
use funicular::math::Vec3;
use funicular_study::names::{Named, suggestion};
use funicular_study::request::SourceFile;
use funicular_study::values::number;

/// Ends of a cable.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CablePoints {
    pub(super) name: String,
    /// Anchor, world frame [m].
    pub(super) anchor: Vec3,
    /// Attachment, platform frame [m].
    pub(super) attachment: Vec3,
}

/// Columns with numbers, in the order of a table without a header.
const COLUMNS: [&str; 6] = ["anchor_x", "anchor_y", "anchor_z", "attachment_x", "attachment_y", "attachment_z"];

/// Name of the column with the names of the cables.
const NAME: &str = "name";

/// Reads the points of all cables. The first line may name the columns; otherwise they are an optional name, the anchor
/// and the attachment. A point mass needs no attachments.
///
/// # Errors
/// The file, the line, the column and the value.
pub(super) fn read(csv: &SourceFile, unit: Option<LengthUnit>, motion: NewMotion) -> Result<Vec<CablePoints>> {
    let (shown, bytes) = (csv.name(), csv.text.as_bytes());
    let form = TableForm::of(bytes);
    let (mut reader, bytes) = form.reader(bytes, csv::ReaderBuilder::new().has_headers(false).flexible(true));

    let mut layout: Option<(Columns, usize)> = None;
    let mut cables: Vec<CablePoints> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| anyhow!("{shown}: {error}"))?;
        let line = record.position().map_or(1, |position| line_at(bytes, position)) + form.lines_before();
        let cells: Vec<_> = record.iter().map(|cell| form.cell(cell.trim_start_matches('\u{feff}').trim())).collect();
        let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
        if cells.iter().all(|cell| cell.is_empty() || cell.starts_with('#')) {
            continue;
        }

        // The first line decides about the columns.
        let (columns, count) = if let Some(layout) = &layout {
            layout
        } else {
            let (columns, is_header) = Columns::of_first_line(&cells, unit, motion)
                .map_err(|reason| anyhow!("{shown}, line {line}: {reason}"))?;
            let layout = layout.insert((columns, cells.len()));
            if is_header {
                continue;
            }
            layout
        };
        if cells.len() != *count {
            bail!(
                "{shown}, line {line}: {} values, but {count} in the first line; give all lines the same columns",
                cells.len()
            );
        }

        let points =
            columns.cable(&cells, cables.len() + 1).map_err(|reason| anyhow!("{shown}, line {line}{reason}"))?;
        if cables.iter().any(|cable| cable.name == points.name) {
            bail!("{shown}, line {line}: a second cable \"{}\"; give every cable its own name", points.name);
        }
        cables.push(points);
    }

    if cables.is_empty() {
        bail!(
            "{shown} has no cables: give one line per cable, with name (optional), anchor x, y, z and attachment x, y, \
             z, separated by commas"
        );
    }
    Ok(cables)
}

/// Number without the rounding of a change of unit: 4600 mm are 4.6 m.
fn shortest(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value) + 0.0
}

/// Places of the columns in a line.
struct Columns {
    name: Option<usize>,
    places: [Option<usize>; 6],
    unit: LengthUnit,
}

impl Columns {
    /// Cable of a line; `position`, counted from 1, is its name if the lines have none. If a column is wrong, the error
    /// begins with it.
    fn cable(&self, cells: &[&str], position: usize) -> Result<CablePoints, String> {
        let mut coordinates = [0.0; 6];
        for ((value, place), column) in coordinates.iter_mut().zip(self.places).zip(COLUMNS) {
            let Some(place) = place else { continue };
            let given = number(cells[place]).map_err(|reason| format!(", {}: {reason}", column.replace('_', " ")))?;
            *value = given * self.unit.metres();
        }

        let name = match self.name {
            Some(place) if cells[place].is_empty() => return Err(": the name of the cable is empty".to_owned()),
            Some(place) => cells[place].to_owned(),
            None => position.to_string(),
        };
        let [x, y, z, u, v, w] = coordinates.map(shortest);
        Ok(CablePoints { name, anchor: Vec3::new(x, y, z), attachment: Vec3::new(u, v, w) })
    }

    /// Columns from the first line, and true if this line is a header.
    fn of_first_line(cells: &[&str], unit: Option<LengthUnit>, motion: NewMotion) -> Result<(Self, bool), String> {
        let needed = if motion == NewMotion::PointMass { 3 } else { 6 };
        let is_name = |cell: &&str| cell.chars().any(|c| c.is_ascii_alphabetic()) && number(cell).is_err();
        // A name and numbers with units have letters too, but only a header has nothing else.
        if cells.len() > 1 && cells.iter().all(is_name) {
            return Self::of_header(cells, unit, needed).map(|columns| (columns, true));
        }

        let first = match cells.len() {
            count if count == needed || count == 6 => 0,
            count if count == needed + 1 || count == 7 => 1,
            count => {
                let (least, attachment) = if needed == 3 { ("3", "") } else { ("6", ", attachment x, y, z") };
                return Err(format!(
                    "{count} values, but at least {least} are needed: name (optional), anchor x, y, z{attachment}, \
                     separated by commas"
                ));
            }
        };
        let places = std::array::from_fn(|i| Some(first + i).filter(|place| *place < cells.len()));
        let unit = unit.unwrap_or(LengthUnit::Metre);
        Ok((Self { name: (first == 1).then_some(0), places, unit }, false))
    }

    /// Columns by their names, which may end in their unit.
    fn of_header(cells: &[&str], unit: Option<LengthUnit>, needed: usize) -> Result<Self, String> {
        let mut columns = Self { name: None, places: [None; 6], unit: LengthUnit::Metre };
        let mut units: Vec<Option<LengthUnit>> = Vec::new();
        for (i, cell) in cells.iter().enumerate() {
            let cell = cell.to_lowercase();
            if cell == NAME {
                columns.name = Some(i);
                continue;
            }
            let of_unit = |unit: LengthUnit| Some((cell.strip_suffix(&format!("_{}", unit.name()))?.to_owned(), unit));
            let (column, unit) = match LengthUnit::ALL.iter().find_map(|unit| of_unit(*unit)) {
                Some((column, unit)) => (column, Some(unit)),
                None => (cell.clone(), None),
            };
            let Some(place) = COLUMNS.iter().position(|known| *known == column) else {
                let known: Vec<String> = [NAME].iter().chain(&COLUMNS).map(|name| (*name).to_owned()).collect();
                return Err(format!("there is no column `{cell}` in a table of points{}", suggestion(&column, &known)));
            };
            if columns.places[place].replace(i).is_some() {
                return Err(format!("the column `{column}` is there twice"));
            }
            units.push(unit);
        }

        if let Some(missing) = (0..needed).find(|place| columns.places[*place].is_none()) {
            return Err(format!(
                "there is no column `{}`: a header names {NAME}, {}",
                COLUMNS[missing],
                COLUMNS.join(", ")
            ));
        }
        let of_columns = units[0];
        if units.iter().any(|unit| *unit != of_columns) {
            return Err("the columns have different units: give all columns one unit".to_owned());
        }
        columns.unit = match (unit, of_columns) {
            (Some(given), Some(named)) if given != named => {
                return Err(format!("⟪csv_unit⟫ is {}, but the columns are in {}", given.name(), named.name()));
            }
            (given, named) => given.or(named).unwrap_or(LengthUnit::Metre),
        };
        Ok(columns)
    }
}
