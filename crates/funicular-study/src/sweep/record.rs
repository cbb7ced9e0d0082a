//! What a file says of itself: robot, plan, columns. Two results belong together if these are the same.

use crate::sweep::{Chunk, Column, Kind, Values};
use serde_json::{Map, Value, json};
use std::fmt;
use std::io;
use std::ops::Range;

/// Version of the files; a change of their meaning is another.
pub const SCHEMA: &str = "funicular-sweep/1";

/// What a sweep is, in full: the same record means the same rows, bit for bit.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Text of the robot file, with its changes.
    pub robot_file: String,
    /// Points, quantities and options, as JSON.
    pub plan: Map<String, Value>,
    /// The columns of the rows.
    pub columns: Vec<Column>,
    /// Number of rows, of all parts.
    pub rows: usize,
    /// Rows of a chunk.
    pub chunk_rows: usize,
    /// Which part the file is to hold.
    pub part: Option<Part>,
}

/// One of several parts of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Which, from one.
    pub number: usize,
    /// Of how many.
    pub of: usize,
}

impl Part {
    /// Its chunks, of all. Parts differ by one chunk at most.
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
        const MOST: usize = 100_000;
        let form = || format!("`{text}` is no part: write k/n, as in 3/8, k from 1 to n, n up to {MOST}");
        let (number, of) = text.split_once('/').ok_or_else(form)?;
        let (number, of): (usize, usize) =
            (number.trim().parse().map_err(|_| form())?, of.trim().parse().map_err(|_| form())?);
        if (1..=of).contains(&number) && of <= MOST { Ok(Self { number, of }) } else { Err(form()) }
    }
}

/// In what two records differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    what: String,
    theirs: String,
    ours: String,
}

impl Difference {
    /// Of two values, if they differ.
    pub fn of_values(what: &str, theirs: &Value, ours: &Value) -> Option<Self> {
        (theirs != ours).then(|| Self { what: what.to_owned(), theirs: shown(theirs), ours: shown(ours) })
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, theirs, ours } = self;
        write!(f, "its {what}: {theirs}, here: {ours}")
    }
}

impl Record {
    /// Number of chunks, of all parts.
    pub fn chunks(&self) -> usize {
        self.rows.div_ceil(self.chunk_rows)
    }

    /// The chunks that the file is to hold.
    pub fn range(&self) -> Range<usize> {
        self.part.map_or(0..self.chunks(), |part| part.range(self.chunks()))
    }

    /// Number of rows of these chunks.
    pub fn rows_of(&self, chunks: Range<usize>) -> usize {
        (chunks.end * self.chunk_rows).min(self.rows).saturating_sub(chunks.start * self.chunk_rows)
    }

    /// All but the robot file, as JSON.
    pub fn to_json(&self) -> Value {
        let columns: Vec<Value> = self
            .columns
            .iter()
            .map(|column| {
                json!({ "name": column.name, "unit": column.unit, "about": column.about, "kind": kind_name(column.kind) })
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

    /// Whether the columns of a chunk are those of the plan: other programs may have rewritten its file.
    ///
    /// # Errors
    /// What is to be said of the file.
    pub fn check(&self, chunk: &Chunk) -> io::Result<()> {
        let kinds = chunk.columns.iter().map(|values| match values {
            Values::Real(_) => Kind::Real,
            Values::Flag(_) => Kind::Flag,
            Values::Text(_) => Kind::Text,
        });
        if kinds.eq(self.columns.iter().map(|column| column.kind)) {
            return Ok(());
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "its columns are not those of its plan"))
    }

    /// In what another record, as its file has it, differs from this; parts are not compared.
    pub fn difference(&self, json: &Value, robot_file: &str) -> Option<Difference> {
        let ours = self.to_json();
        for key in ["schema", "program"] {
            if ours[key] != json[key] {
                return Some(Difference { what: key.to_owned(), theirs: shown(&json[key]), ours: shown(&ours[key]) });
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

/// Name of a kind of column in the files.
pub fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real => "real",
        Kind::Flag => "flag",
        Kind::Text => "text",
    }
}

/// A value on one line, not too long.
fn shown(value: &Value) -> String {
    const MOST: usize = 60;
    let text = match value {
        Value::Null => return "missing".to_owned(),
        Value::String(text) => format!("\"{text}\""),
        other => other.to_string(),
    };
    if text.chars().count() <= MOST { text } else { text.chars().take(MOST - 1).collect::<String>() + "…" }
}

/// The first place where two values differ.
fn deep_difference(what: &str, theirs: &Value, ours: &Value) -> Option<Difference> {
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
    Some(Difference { what: what.to_owned(), theirs: shown(theirs), ours: shown(ours) })
}

/// The first line in which two robot files differ.
fn line_difference(theirs: &str, ours: &str) -> Difference {
    let (mut a, mut b) = (theirs.lines(), ours.lines());
    let mut number = 0;
    loop {
        number += 1;
        let (left, right) = (a.next(), b.next());
        if left != right || left.is_none() {
            let line = |line: Option<&str>| line.map_or("missing".to_owned(), |line| format!("`{}`", line.trim()));
            return Difference { what: format!("robot file, line {number}"), theirs: line(left), ours: line(right) };
        }
    }
}
