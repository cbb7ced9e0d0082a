//! Rows of results, stored as columns.

use std::borrow::Cow;
use std::ops::Range;

/// Description of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name with its unit: `first_frequency_hz`.
    pub name: String,
    /// Unit: `Hz`, `m`, `N/m`, `deg`, `1`; empty for text and flags.
    pub unit: Cow<'static, str>,
    /// Meaning in one line.
    pub about: String,
    /// Kind of its values.
    pub kind: ColumnKind,
}

/// Kind of a column's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Numbers.
    Real,
    /// Yes or no.
    Flag,
    /// Words or sentences.
    Text,
}

/// Values of one column for some rows. A value that does not exist is `None`, never NaN.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers.
    Real(Vec<Option<f64>>),
    /// Yes or no.
    Flag(Vec<bool>),
    /// Words or sentences.
    Text(Vec<Option<Cow<'static, str>>>),
}

impl Values {
    /// Empty column of a kind, with room for `capacity` values.
    pub fn new(kind: ColumnKind, capacity: usize) -> Self {
        match kind {
            ColumnKind::Real => Self::Real(Vec::with_capacity(capacity)),
            ColumnKind::Flag => Self::Flag(Vec::with_capacity(capacity)),
            ColumnKind::Text => Self::Text(Vec::with_capacity(capacity)),
        }
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Flag(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// True if there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds the values `rows` of another column of the same kind.
    ///
    /// # Panics
    /// If the other column has another kind or fewer rows.
    pub fn extend(&mut self, other: &Self, rows: Range<usize>) {
        match (self, other) {
            (Self::Real(values), Self::Real(more)) => values.extend_from_slice(&more[rows]),
            (Self::Flag(values), Self::Flag(more)) => values.extend_from_slice(&more[rows]),
            (Self::Text(values), Self::Text(more)) => values.extend_from_slice(&more[rows]),
            (values, more) => unreachable!("columns differ in kind: {values:?} and {more:?}"),
        }
    }

    /// Adds one value.
    ///
    /// # Panics
    /// If the value has another kind than the column.
    pub(crate) fn push(&mut self, value: Value) {
        match (self, value) {
            (Self::Real(values), Value::Real(value)) => values.push(Some(value)),
            (Self::Flag(values), Value::Flag(value)) => values.push(value),
            (Self::Text(values), Value::Text(value)) => values.push(Some(value)),
            (Self::Real(values), Value::Nothing) => values.push(None),
            (Self::Text(values), Value::Nothing) => values.push(None),
            (values, value) => unreachable!("{value:?} among {values:?}"),
        }
    }
}

/// Single value of a column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Real(f64),
    Flag(bool),
    Text(Cow<'static, str>),
    Nothing,
}

impl Value {
    /// Number; nothing if it is absent or not finite.
    pub(crate) fn real(value: Option<f64>) -> Self {
        match value {
            // `+ 0.0` makes a negative zero positive.
            Some(value) if value.is_finite() => Self::Real(value + 0.0),
            _ => Self::Nothing,
        }
    }
}

/// Rows of a plan that are computed together.
#[derive(Debug, Clone, PartialEq)]
pub struct Chunk {
    /// Index of the chunk in the plan, from 0.
    pub index: usize,
    /// Columns in the order of [`Plan::columns`](crate::sweep::Plan::columns), all of the same length.
    pub columns: Vec<Values>,
}

impl Chunk {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Values::len)
    }
}
