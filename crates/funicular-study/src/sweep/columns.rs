//! Results as columns.

use std::borrow::Cow;

/// What a column is.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, the unit included: `first_frequency_hz`.
    pub name: String,
    /// Unit: `Hz`, `m`, `N/m`, `deg`, `1`; empty for text and flags.
    pub unit: Cow<'static, str>,
    /// What it says, in a line.
    pub about: String,
    /// Kind of its values.
    pub kind: Kind,
}

/// Kind of a column's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Numbers.
    Real,
    /// Yes or no.
    Flag,
    /// Words or sentences.
    Text,
}

/// Values of one column of some rows. What does not exist is `None`, never NaN.
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
    /// None yet, of a kind.
    pub fn new(kind: Kind, capacity: usize) -> Self {
        match kind {
            Kind::Real => Self::Real(Vec::with_capacity(capacity)),
            Kind::Flag => Self::Flag(Vec::with_capacity(capacity)),
            Kind::Text => Self::Text(Vec::with_capacity(capacity)),
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Flag(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// There are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds one value.
    ///
    /// # Panics
    /// For a value of another kind.
    pub(super) fn push(&mut self, value: Value) {
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

/// One value on its way into a column.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Real(f64),
    Flag(bool),
    Text(Cow<'static, str>),
    Nothing,
}

impl Value {
    /// A number; nothing if it is none.
    pub(super) fn real(value: Option<f64>) -> Self {
        match value {
            // `+ 0.0` makes a negative zero positive.
            Some(value) if value.is_finite() => Self::Real(value + 0.0),
            _ => Self::Nothing,
        }
    }
}

/// Rows of a plan that are computed in one go.
#[derive(Debug, Clone, PartialEq)]
pub struct Chunk {
    /// Its place in the plan, from 0.
    pub index: usize,
    /// Its columns, in the order of [`Plan::columns`](super::Plan::columns); all of one length.
    pub columns: Vec<Values>,
}

impl Chunk {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Values::len)
    }
}
