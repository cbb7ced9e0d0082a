//! Rows of a sweep for the figures of a page: all rows are counted and binned, and as many are kept as the page may
//! hold.

use anyhow::{Context as _, Result, bail};
use funicular_study::sweep::{CODES, MAX_POINTS, Steps};
use funicular_study::table::{Chunk, Column, ColumnKind, Record, SweepRows, Values, axes_of};
use funicular_study::units;
use serde_json::Value;

/// Maximum number of packed values of a grid on a page: about two megabytes.
const MAX_NUMBERS: usize = 450_000;
/// Maximum number of values of curves on a page, where values are text.
const MAX_NUMBERS_OF_CURVES: usize = 80_000;
/// Number of bars of a histogram.
pub(super) const BINS: usize = 40;
/// Code of a row that is missing in the file.
pub(super) const NOT_COMPUTED: u8 = u8::MAX;

/// Axis of a grid with the values that are shown.
pub(super) struct PlotAxis {
    pub(super) name: String,
    pub(super) unit: String,
    /// All values in the order of the file.
    pub(super) steps: Steps,
    /// Positions of the values in ascending order; empty if the values ascend.
    rank: Vec<usize>,
    /// Step between kept values: 2 keeps every second one.
    pub(super) every: usize,
}

impl PlotAxis {
    /// Number of kept values.
    pub(super) fn kept(&self) -> usize {
        self.steps.count().div_ceil(self.every)
    }

    /// Kept values, ascending.
    pub(super) fn values(&self) -> Vec<f64> {
        let mut all: Vec<f64> = (0..self.steps.count()).map(|i| self.steps.at(i)).collect();
        all.sort_by(f64::total_cmp);
        all.into_iter().step_by(self.every).collect()
    }

    fn new(name: String, unit: String, steps: Steps) -> Self {
        let mut rank = Vec::new();
        if let Steps::List(values) = &steps
            && !values.is_sorted()
        {
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
            rank = vec![0; values.len()];
            order.into_iter().enumerate().for_each(|(place, i)| rank[i] = place);
        }
        Self { name, unit, steps, rank, every: 1 }
    }
}

/// Column of numbers after the coordinates.
pub(super) struct Series {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) about: String,
    /// Number of rows with a value.
    pub(super) count: usize,
    /// Minimum and maximum, with their rows.
    pub(super) min: (f64, usize),
    pub(super) max: (f64, usize),
    /// Histogram of all rows, in equal steps from minimum to maximum.
    pub(super) bins: [usize; BINS],
    /// Kept values; NaN for a missing value.
    pub(super) values: Vec<f64>,
}

/// Number of rows with a status.
pub(super) struct StatusCount {
    /// Position in [`CODES`].
    pub(super) code: u8,
    pub(super) rows: usize,
    pub(super) first_reason: String,
}

/// Rows of a file, reduced to the data of a page.
pub(super) struct Rows {
    /// Axes of a grid that vary, the fastest first; empty for a list.
    pub(super) axes: Vec<PlotAxis>,
    /// Name, unit and value of the axes that do not vary.
    pub(super) fixed: Vec<Fixed>,
    pub(super) is_list: bool,
    /// Coordinates of kept rows of a list: name, unit, values.
    pub(super) coordinates: Vec<(String, String, Vec<f64>)>,
    /// Index of each kept row, for a list or for one axis.
    pub(super) places: Vec<usize>,
    /// Step between kept rows of a list.
    pub(super) every: usize,
    pub(super) feasible: usize,
    pub(super) counts: Vec<StatusCount>,
    /// Position in [`CODES`] for each kept row, or [`NOT_COMPUTED`].
    pub(super) status: Vec<u8>,
    pub(super) series: Vec<Series>,
    /// Columns of words, which have no figure.
    pub(super) words: Vec<String>,
    /// Requested quantities among them; the others accompany numbers, as the limits of a payload.
    pub(super) requested_words: Vec<String>,
    /// Number of rows of the complete plan, and of the rows in the file.
    pub(super) planned: usize,
    #[expect(clippy::struct_field_names, reason = "the number of rows in the file")]
    pub(super) rows: usize,
    first_row: usize,
}

/// Message of a file whose plan and rows contradict each other.
const DAMAGED: &str = "the file's plan does not fit its rows: the file is damaged, or another program wrote it";

/// Number of columns before the columns of feasibility, status and reason, which every file has.
fn coordinate_count(record: &Record) -> Result<usize> {
    let coordinates = record.columns.iter().take_while(|column| column.kind == ColumnKind::Real).count();
    let head = record.columns.get(coordinates..coordinates + 3);
    let expected = [ColumnKind::Flag, ColumnKind::Text, ColumnKind::Text];
    let fits = head.is_some_and(|head| head.iter().map(|column| column.kind).eq(expected));
    if !fits || record.rows > MAX_POINTS {
        bail!(DAMAGED);
    }
    Ok(coordinates)
}

impl Rows {
    /// Reads a file twice, because the range of the values has to be known before they are binned.
    ///
    /// # Errors
    /// A damaged file, or a file without numbers.
    pub(super) fn read(file: &dyn SweepRows) -> Result<Self> {
        let mut rows = Self::empty(file)?;
        let of_series = series_columns(&file.record().columns);
        let mut at = file.first_row();
        file.each(&mut |chunk| {
            rows.count(chunk, at, &of_series, &file.record().columns);
            at += chunk.rows();
        })?;
        let texts = rows.words.join(", ");
        if rows.series.is_empty() {
            bail!("the file has no numbers to plot, only {texts}: request a numeric quantity such as first-frequency");
        }
        let mut at = file.first_row();
        file.each(&mut |chunk| {
            rows.keep(chunk, at, &of_series);
            at += chunk.rows();
        })?;
        rows.counts.sort_by_key(|count| count.code);
        Ok(rows)
    }

    /// Rows of a file before they are read: axes, columns, and the values that are kept.
    fn empty(file: &dyn SweepRows) -> Result<Self> {
        let record = file.record();
        let columns = &record.columns;
        let coordinates = coordinate_count(record)?;
        let numbers = columns.iter().skip(coordinates + 3);
        let (numbers, words): (Vec<&Column>, Vec<&Column>) =
            numbers.partition(|column| column.kind == ColumnKind::Real);

        let is_list = record.plan.contains_key("poses");
        let grid = if is_list { None } else { Some(grid_of(&record.plan).context(DAMAGED)?) };
        if grid.as_ref().is_some_and(|grid| points_of(grid) != record.rows) {
            bail!(DAMAGED);
        }
        let (mut axes, fixed) = grid.map_or_else(Default::default, |grid| split(grid, &columns[..coordinates]));

        let every = thin(&mut axes, numbers.len() + 1, file.rows());
        let kept = if axes.len() < 2 { 0 } else { axes.iter().map(PlotAxis::kept).product() };

        let series = numbers.into_iter().map(|column| Series {
            name: column.name.clone(),
            unit: column.unit.to_string(),
            about: column.about.clone(),
            count: 0,
            min: (f64::INFINITY, 0),
            max: (f64::NEG_INFINITY, 0),
            bins: [0; BINS],
            values: vec![f64::NAN; kept],
        });
        // The column of a quantity of words has its name.
        let quantities = record.plan.get("quantities").and_then(|list| list.as_array());
        let is_requested = |name: &String| {
            quantities.into_iter().flatten().any(|of| of.as_str().is_some_and(|of| of.replace('-', "_") == *name))
        };
        let words: Vec<String> = words.iter().map(|column| column.name.clone()).collect();
        let requested_words = words.iter().filter(|name| is_requested(name)).cloned().collect();

        let coordinate = |column: &Column| (column.name.clone(), column.unit.to_string(), Vec::new());
        Ok(Self {
            axes,
            fixed,
            is_list,
            coordinates: columns[..coordinates].iter().map(coordinate).collect(),
            places: Vec::new(),
            every,
            feasible: 0,
            counts: Vec::new(),
            status: vec![NOT_COMPUTED; kept],
            series: series.collect(),
            words,
            requested_words,
            planned: record.rows,
            rows: file.rows(),
            first_row: file.first_row(),
        })
    }

    /// Counts the rows of a chunk whose first row has the index `first`.
    fn count(&mut self, chunk: &Chunk, first: usize, of_series: &[usize], columns: &[Column]) {
        let head = self.coordinates.len();
        if let [Values::Flag(feasible), Values::Text(status), Values::Text(reasons)] = &chunk.columns[head..head + 3] {
            assert_eq!(columns[head].kind, ColumnKind::Flag);
            self.feasible += feasible.iter().filter(|feasible| **feasible).count();
            for (status, reason) in status.iter().zip(reasons) {
                let code = code_of(status.as_deref());
                if let Some(count) = self.counts.iter_mut().find(|count| count.code == code) {
                    count.rows += 1;
                } else {
                    let first_reason = reason.as_deref().unwrap_or_default().to_owned();
                    self.counts.push(StatusCount { code, rows: 1, first_reason });
                }
            }
        }

        for (series, column) in self.series.iter_mut().zip(of_series) {
            let Values::Real(values) = &chunk.columns[*column] else { continue };
            for (i, value) in values.iter().enumerate() {
                let Some(value) = value.filter(|value| value.is_finite()) else { continue };
                series.count += 1;
                if value < series.min.0 {
                    series.min = (value, first + i);
                }
                if value > series.max.0 {
                    series.max = (value, first + i);
                }
            }
        }
    }

    /// Bins the rows of a chunk and keeps the selected ones.
    fn keep(&mut self, chunk: &Chunk, first: usize, of_series: &[usize]) {
        let head = self.coordinates.len();
        let real = |column: usize, row: usize| match &chunk.columns[column] {
            Values::Real(values) => values[row].unwrap_or(f64::NAN),
            _ => f64::NAN,
        };

        for row in 0..chunk.rows() {
            let kept = self.slot(first + row);
            let slot = match kept {
                Some(Slot::Cell(cell)) => Some(cell),
                Some(Slot::Next) => {
                    self.places.push(first + row);
                    self.status.push(NOT_COMPUTED);
                    for (i, coordinate) in self.coordinates.iter_mut().enumerate() {
                        coordinate.2.push(real(i, row));
                    }
                    self.series.iter_mut().for_each(|series| series.values.push(f64::NAN));
                    Some(self.places.len() - 1)
                }
                None => None,
            };

            if let (Some(slot), Values::Text(status)) = (slot, &chunk.columns[head + 1]) {
                self.status[slot] = code_of(status[row].as_deref());
            }

            for (series, column) in self.series.iter_mut().zip(of_series) {
                let value = real(*column, row);
                if value.is_finite() {
                    series.bins[bin(value, series.min.0, series.max.0)] += 1;
                }
                if let Some(slot) = slot {
                    series.values[slot] = value;
                }
            }
        }
    }

    /// Slot of a row if it is kept.
    fn slot(&self, place: usize) -> Option<Slot> {
        if self.axes.len() < 2 {
            // The first and the last row are always kept.
            let at = place - self.first_row;
            return (at.is_multiple_of(self.every) || at + 1 == self.rows).then_some(Slot::Next);
        }
        let (mut rest, mut cell, mut stride) = (place, 0, 1);
        for axis in &self.axes {
            let digit = rest % axis.steps.count();
            rest /= axis.steps.count();
            let digit = axis.rank.get(digit).copied().unwrap_or(digit);
            if digit % axis.every != 0 {
                return None;
            }
            cell += digit / axis.every * stride;
            stride *= axis.kept();
        }
        Some(Slot::Cell(cell))
    }

    /// Values of the varying axes for a row of a grid.
    pub(super) fn at(&self, place: usize) -> Vec<f64> {
        let mut rest = place;
        self.axes
            .iter()
            .map(|axis| {
                let digit = rest % axis.steps.count();
                rest /= axis.steps.count();
                axis.steps.at(digit)
            })
            .collect()
    }

    /// Number of rows or cells shown in figures.
    pub(super) fn shown(&self) -> usize {
        self.status.len()
    }
}

/// Names and values of the axes of a grid.
type Grid = Vec<(String, Steps)>;

/// Grid of a plan; `None` if the plan has no axes, or an axis without values.
fn grid_of(plan: &serde_json::Map<String, Value>) -> Option<Grid> {
    axes_of(plan)?.iter().map(|axis| Some((axis.name().to_owned(), axis.steps().ok()?))).collect()
}

/// Number of points of a grid.
fn points_of(grid: &Grid) -> usize {
    grid.iter().fold(1, |product, axis| product.saturating_mul(axis.1.count()))
}

/// Name, unit and value of an axis that does not vary.
type Fixed = (String, String, f64);

/// Splits the axes of a grid into those that vary and those that do not.
fn split(grid: Grid, coordinates: &[Column]) -> (Vec<PlotAxis>, Vec<Fixed>) {
    let (mut axes, mut fixed) = (Vec::new(), Vec::new());
    for (name, steps) in grid {
        let column = coordinates.iter().find(|column| column.name == name || short_name(column) == name);
        let unit = column.map_or_else(String::new, |column| column.unit.to_string());
        match steps.count() {
            1 => fixed.push((name, unit, steps.at(0))),
            _ => axes.push(PlotAxis::new(name, unit, steps)),
        }
    }
    // The grid of a point mass may have axes that are not columns.
    fixed.retain(|(_, unit, _)| !unit.is_empty());
    (axes, fixed)
}

enum Slot {
    Cell(usize),
    Next,
}

/// Positions of the columns of numbers after the coordinates.
fn series_columns(columns: &[Column]) -> Vec<usize> {
    let begin = columns.iter().position(|column| column.kind != ColumnKind::Real).unwrap_or(columns.len());
    (begin..columns.len()).filter(|&i| columns[i].kind == ColumnKind::Real).collect()
}

/// Name of a coordinate without its unit, as in a grid.
fn short_name(column: &Column) -> &str {
    column.name.strip_suffix(&format!("_{}", column.unit)).unwrap_or(&column.name)
}

/// Position of a status among the codes; an unknown status, from another version, comes after the last one.
fn code_of(status: Option<&str>) -> u8 {
    let place = CODES.iter().position(|known| Some(known.0) == status);
    u8::try_from(place.unwrap_or(CODES.len())).unwrap_or(NOT_COMPUTED)
}

/// Index of the histogram bar of a value.
fn bin(value: f64, min: f64, max: f64) -> usize {
    let part = (value - min) / (max - min);
    if part.is_finite() { ((part * BINS as f64) as usize).min(BINS - 1) } else { 0 }
}

/// Name of a quantity in a figure: `tension_max_n` becomes "tension max".
pub(super) fn label(name: &str) -> String {
    units::without_unit(name).replace('_', " ")
}

/// Name with its unit in brackets; without brackets for a pure number.
pub(super) fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "" | "1" => name.to_owned(),
        "deg" => format!("{name} [°]"),
        unit => format!("{name} [{unit}]"),
    }
}

/// Name of the robot of a plan.
pub(super) fn robot_name(plan: &serde_json::Map<String, Value>) -> String {
    plan.get("robot").and_then(Value::as_str).unwrap_or("a robot").to_owned()
}

/// Number of rows per kept row, for curves of a file with `rows` rows of `numbers` numbers. In a grid with several
/// axes, values of the longest axes are left out instead.
fn thin(axes: &mut [PlotAxis], numbers: usize, rows: usize) -> usize {
    if axes.len() < 2 {
        return (rows.max(1) * numbers).div_ceil(MAX_NUMBERS_OF_CURVES).max(1);
    }
    while axes.iter().map(PlotAxis::kept).product::<usize>() * numbers > MAX_NUMBERS {
        let Some(longest) = axes.iter_mut().max_by_key(|axis| axis.kept()) else { break };
        longest.every += 1;
    }
    1
}
