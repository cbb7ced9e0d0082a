//! Description of a file of rows: robot, plan, columns. Files belong to the same sweep if their descriptions are equal.

use super::columns::{Chunk, Column, ColumnKind, Values};
use crate::request::Axis;
use serde_json::{Map, Value, json};
use std::fmt;
use std::io;
use std::ops::Range;

/// Version of the files. It changes if the meaning of the files changes.
pub const SCHEMA: &str = "funicular-sweep/1";

/// Complete description of a sweep: equal records mean equal rows, bit for bit.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Text of the robot file, with its changes.
    pub robot_file: String,
    /// Points, quantities and options, as JSON.
    pub plan: Map<String, Value>,
    /// Columns of the rows.
    pub columns: Vec<Column>,
    /// Number of rows, of all parts.
    pub rows: usize,
    /// Number of rows per chunk.
    pub chunk_rows: usize,
    /// Part of the sweep that the file holds; `None` for the complete sweep.
    pub part: Option<Part>,
}

/// Axes in the plan of a file: axes of a grid of poses, or values of the robot file.
pub fn axes_of(plan: &Map<String, Value>) -> Option<Vec<Axis>> {
    let axes = plan.get("grid").or_else(|| plan.get("vary"))?;
    serde_json::from_value(axes.clone()).ok()
}

/// Part `k/n` of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Number of the part, from 1.
    pub number: usize,
    /// Number of all parts.
    pub of: usize,
}

impl Part {
    /// Chunks of the part, out of all `chunks`. The sizes of parts differ by at most one chunk.
    pub fn range(&self, chunks: usize) -> Range<usize> {
        let at = |k: usize| (chunks as u128 * k as u128 / self.of as u128) as usize;
        at(self.number - 1)..at(self.number)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl std::str::FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const MAX_PARTS: usize = 100_000;
        let form =
            || format!("`{text}` is not a part: write k/n, as in 3/8, with k from 1 to n and n up to {MAX_PARTS}");
        let (number, of) = text.split_once('/').ok_or_else(form)?;
        let (number, of): (usize, usize) =
            (number.trim().parse().map_err(|_| form())?, of.trim().parse().map_err(|_| form())?);
        if (1..=of).contains(&number) && of <= MAX_PARTS { Ok(Self { number, of }) } else { Err(form()) }
    }
}

/// First difference between two records.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordDifference {
    what: String,
    theirs: String,
    ours: String,
}

impl RecordDifference {
    /// Difference of two values; `None` if they are equal.
    pub fn of_values(what: &str, theirs: &Value, ours: &Value) -> Option<Self> {
        (theirs != ours).then(|| Self { what: what.to_owned(), theirs: shown(theirs), ours: shown(ours) })
    }
}

impl fmt::Display for RecordDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, theirs, ours } = self;
        write!(f, "its {what}: {theirs}, here: {ours}")
    }
}

impl Record {
    /// Number of chunks of all parts.
    pub fn chunks(&self) -> usize {
        self.rows.div_ceil(self.chunk_rows)
    }

    /// Chunks that the file holds.
    pub fn range(&self) -> Range<usize> {
        self.part.map_or(0..self.chunks(), |part| part.range(self.chunks()))
    }

    /// Number of rows of these chunks.
    pub fn rows_of(&self, chunks: Range<usize>) -> usize {
        (chunks.end * self.chunk_rows).min(self.rows).saturating_sub(chunks.start * self.chunk_rows)
    }

    /// Record without the robot file, as JSON.
    pub fn to_json(&self) -> Value {
        let columns: Vec<Value> = self
            .columns
            .iter()
            .map(|column| {
                json!({
                    "name": column.name, "unit": column.unit, "about": column.about, "kind": kind_name(column.kind),
                })
            })
            .collect();
        json!({
            "schema": SCHEMA,
            "program": env!("CARGO_PKG_VERSION"),
            "plan": self.plan,
            "rows": self.rows,
            "chunk_rows": self.chunk_rows,
            "columns": columns,
        })
    }

    /// Checks that the columns of a chunk are the columns of the plan: another program may have rewritten the file.
    ///
    /// # Errors
    /// A message about the file.
    pub fn check(&self, chunk: &Chunk) -> io::Result<()> {
        let kinds = chunk.columns.iter().map(|values| match values {
            Values::Real(_) => ColumnKind::Real,
            Values::Flag(_) => ColumnKind::Flag,
            Values::Text(_) => ColumnKind::Text,
        });
        if kinds.eq(self.columns.iter().map(|column| column.kind)) {
            return Ok(());
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "its columns differ from the columns of its plan"))
    }

    /// First difference between the record in a file and this record. Parts are not compared.
    pub fn difference(&self, json: &Value, robot_file: &str) -> Option<RecordDifference> {
        let ours = self.to_json();
        for key in ["schema", "program"] {
            if ours[key] != json[key] {
                return Some(RecordDifference {
                    what: key.to_owned(),
                    theirs: shown(&json[key]),
                    ours: shown(&ours[key]),
                });
            }
        }
        if robot_file != self.robot_file {
            return Some(line_difference(robot_file, &self.robot_file));
        }
        deep_difference("plan", &json["plan"], &ours["plan"])
            .or_else(|| deep_difference("number of rows", &json["rows"], &ours["rows"]))
            .or_else(|| deep_difference("list of columns", &json["columns"], &ours["columns"]))
            .or_else(|| deep_difference("size of a chunk", &json["chunk_rows"], &ours["chunk_rows"]))
    }
}

/// Name of a column kind in the files.
pub(crate) fn kind_name(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Real => "real",
        ColumnKind::Flag => "flag",
        ColumnKind::Text => "text",
    }
}

/// Value on one line, shortened if it is long.
fn shown(value: &Value) -> String {
    const MAX_CHARS: usize = 60;
    let text = match value {
        Value::Null => return "missing".to_owned(),
        Value::String(text) => format!("\"{text}\""),
        other => other.to_string(),
    };
    if text.chars().count() <= MAX_CHARS { text } else { text.chars().take(MAX_CHARS - 1).collect::<String>() + "…" }
}

/// First place where two values differ.
fn deep_difference(what: &str, theirs: &Value, ours: &Value) -> Option<RecordDifference> {
    if theirs == ours {
        return None;
    }
    if let (Value::Object(a), Value::Object(b)) = (theirs, ours) {
        let mut keys = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key)));
        return keys.find_map(|key| {
            let inner = if what == "plan" { key.clone() } else { format!("{what}, {key}") };
            deep_difference(&inner, a.get(key).unwrap_or(&Value::Null), b.get(key).unwrap_or(&Value::Null))
        });
    }
    if let (Value::Array(a), Value::Array(b)) = (theirs, ours)
        && a.len() == b.len()
    {
        let mut items = a.iter().zip(b).enumerate();
        return items.find_map(|(i, (a, b))| deep_difference(&format!("{what}, item {}", i + 1), a, b));
    }
    Some(RecordDifference { what: what.to_owned(), theirs: shown(theirs), ours: shown(ours) })
}

/// First line in which two robot files differ.
fn line_difference(theirs: &str, ours: &str) -> RecordDifference {
    let (mut a, mut b) = (theirs.lines(), ours.lines());
    let mut number = 0;
    loop {
        number += 1;
        let (left, right) = (a.next(), b.next());
        if left != right || left.is_none() {
            let line = |line: Option<&str>| line.map_or("missing".to_owned(), |line| format!("`{}`", line.trim()));
            return RecordDifference {
                what: format!("robot file, line {number}"),
                theirs: line(left),
                ours: line(right),
            };
        }
    }
}
