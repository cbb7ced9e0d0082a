//! Summary of a map or sweep in a few numbers.

use super::{Job, sink};
use crate::args::Format;
use crate::output::Printed;
use crate::table::{Table, counted, short, significant};
use anyhow::Result;
use funicular_study::analyses::Found;
use funicular_study::columns::{Columns, ResultTable, Tabled, column};
use funicular_study::sweep::CODES;
use funicular_study::table::{Chunk, Column, ColumnKind, Values};
use serde::Serialize;

/// Counts and ranges of the rows seen so far.
#[derive(Serialize)]
pub(crate) struct Summary {
    #[serde(skip)]
    robot: String,
    #[serde(skip)]
    command: &'static str,
    pub(crate) rows: usize,
    feasible: usize,
    /// Names of the coordinates in `min_at` and `max_at`.
    coordinates: Vec<String>,
    /// Number of rows of each status that occurs, in the order of the codes.
    status: Vec<StatusCount>,
    ranges: Vec<Range>,
    #[serde(skip)]
    warnings: Vec<String>,
    #[serde(skip)]
    columns: Vec<Column>,
    /// Coordinates of the first row, and which of them vary over the rows.
    #[serde(skip)]
    first: Vec<f64>,
    #[serde(skip)]
    varies: Vec<bool>,
}

#[derive(Serialize)]
struct StatusCount {
    code: &'static str,
    rows: usize,
    /// Reason of the first row with this status.
    #[serde(skip_serializing_if = "String::is_empty")]
    first_reason: String,
}

/// Minimum and maximum of a column, and their coordinates.
#[derive(Serialize)]
struct Range {
    column: String,
    min: f64,
    min_at: Vec<f64>,
    max: f64,
    max_at: Vec<f64>,
}

impl Range {
    fn columns() -> Columns<Self> {
        Columns::new([
            column("column", "", "column of the rows", |range: &Self| range.column.clone()),
            column("min", "", "smallest value of the feasible rows", |range: &Self| range.min),
            column("max", "", "largest value of the feasible rows", |range: &Self| range.max),
        ])
    }
}

impl Summary {
    pub(super) fn new(job: &Job, columns: &[Column]) -> Self {
        let in_front = columns.iter().take_while(|column| column.kind == ColumnKind::Real);
        let coordinates: Vec<String> = in_front.map(|column| column.name.clone()).collect();
        Self {
            robot: job.sweep.robot().name.clone(),
            command: job.sweep.request().command(),
            rows: 0,
            feasible: 0,
            status: Vec::new(),
            ranges: Vec::new(),
            warnings: job.sweep.warnings(),
            columns: columns.to_vec(),
            first: Vec::new(),
            varies: vec![false; coordinates.len()],
            coordinates,
        }
    }

    /// Adds the rows of a chunk to the summary.
    pub(super) fn add(&mut self, chunk: &Chunk) {
        self.rows += chunk.rows();
        let head = self.coordinates.len();
        let at = |row: usize| -> Vec<f64> {
            chunk.columns[..head]
                .iter()
                .filter_map(|column| if let Values::Real(values) = column { values[row] } else { None })
                .collect()
        };

        if self.first.is_empty() {
            self.first = at(0);
        }
        for row in 0..chunk.rows() {
            for ((varies, first), value) in self.varies.iter_mut().zip(&self.first).zip(at(row)) {
                *varies |= first.to_bits() != value.to_bits();
            }
        }

        let [Values::Flag(feasible), Values::Text(status), Values::Text(reasons)] = &chunk.columns[head..head + 3]
        else {
            unreachable!("feasible, status and reason follow the coordinates")
        };
        self.feasible += feasible.iter().filter(|feasible| **feasible).count();

        for (row, code) in status.iter().enumerate() {
            let Some((code, _)) = CODES.iter().find(|known| Some(known.0) == code.as_deref()) else { continue };
            if let Some(count) = self.status.iter_mut().find(|count| count.code == *code) {
                count.rows += 1;
            } else {
                let first_reason = reasons[row].as_deref().unwrap_or_default().to_owned();
                self.status.push(StatusCount { code, rows: 1, first_reason });
            }
        }

        for (column, values) in self.columns.iter().zip(&chunk.columns).skip(head + 3) {
            let Values::Real(values) = values else { continue };
            for (row, value) in values.iter().enumerate() {
                let Some(value) = *value else { continue };
                match self.ranges.iter_mut().find(|range| range.column == column.name) {
                    None => self.ranges.push(Range {
                        column: column.name.clone(),
                        min: value,
                        min_at: at(row),
                        max: value,
                        max_at: at(row),
                    }),
                    Some(range) if value < range.min => (range.min, range.min_at) = (value, at(row)),
                    Some(range) if value > range.max => (range.max, range.max_at) = (value, at(row)),
                    Some(_) => {}
                }
            }
        }
    }

    /// Coordinates that vary, in order.
    fn chosen(&self, coordinates: impl Iterator<Item = String>) -> String {
        let chosen: Vec<String> =
            coordinates.zip(&self.varies).filter_map(|(text, varies)| varies.then_some(text)).collect();
        if chosen.len() == 1 { chosen.concat() } else { format!("({})", chosen.join(", ")) }
    }

    /// Prints the summary to standard output.
    pub(super) fn print(mut self, format: Option<Format>) -> Result<()> {
        let place = |code: &str| CODES.iter().position(|known| known.0 == code);
        self.status.sort_by_key(|count| place(count.code));
        sink(format)?.write(&self)
    }
}

impl Found for Summary {
    const COMMAND: &'static str = "map";

    fn robot(&self) -> &str {
        &self.robot
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

impl Tabled for Summary {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", Range::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(Range::columns(), &self.ranges)
    }
}

impl Printed for Summary {
    fn command(&self) -> &'static str {
        self.command
    }

    fn text(&self) -> String {
        let share = 100.0 * self.feasible as f64 / self.rows.max(1) as f64;
        let rows = counted(self.rows, "row");
        let mut text = format!("{}: {rows}, {} feasible ({} %)\n", self.robot, self.feasible, short(share, 4));

        if !self.ranges.is_empty() && !self.varies.contains(&true) {
            let mut table = Table::new(&["", "value"]);
            self.ranges.iter().for_each(|range| table.row(vec![range.column.clone(), significant(range.min, 5)]));
            text += "\n";
            text += &table.to_string();
        } else if !self.ranges.is_empty() {
            let place = format!("at {}", self.chosen(self.coordinates.iter().cloned()));
            let mut table = Table::new(&["", "min", &place, "max", &place]);
            for range in &self.ranges {
                let at = |place: &[f64]| self.chosen(place.iter().map(|value| short(*value, 5)));
                table.row(vec![
                    range.column.clone(),
                    significant(range.min, 5),
                    at(&range.min_at),
                    significant(range.max, 5),
                    at(&range.max_at),
                ]);
            }
            text += "\n";
            text += &table.to_string();
        }

        let others: Vec<&StatusCount> = self.status.iter().filter(|count| count.code != "ok").collect();
        if !others.is_empty() {
            let mut table = Table::new(&["status", "rows", "first reason"]).text_columns(&[2]);
            for count in others {
                table.row(vec![count.code.to_owned(), count.rows.to_string(), count.first_reason.clone()]);
            }
            text += "\n";
            text += &table.to_string();
        }

        text
    }
}
