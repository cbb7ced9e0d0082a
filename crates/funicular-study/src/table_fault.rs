//! Fault of a table of numbers that a request holds: the front end that has read its file names the line.

use funicular::suggest::nearest;
use std::collections::BTreeMap;
use thiserror::Error;

/// Fault of a table.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("⟪{key}⟫{}: {text}", row.map_or_else(String::new, |row| format!(", row {}", row + 1)))]
pub struct TableFault {
    /// Key of the request.
    pub key: &'static str,
    /// Index of the row; `None` for a fault of the whole table.
    pub row: Option<usize>,
    /// Fault and remedy.
    pub text: String,
}

impl TableFault {
    /// Fault of a whole table.
    pub(crate) fn of_table(key: &'static str, text: String) -> Self {
        Self { key, row: None, text }
    }

    /// Refuses a column that is none of the known ones. `wanted` says which columns a table has.
    pub(crate) fn refuse_unknown<V>(
        key: &'static str,
        columns: &BTreeMap<String, Vec<V>>,
        known: &[String],
        wanted: &str,
    ) -> Result<(), Self> {
        let unknown = columns.keys().find(|name| !known.contains(name));
        unknown.map_or(Ok(()), |name| {
            let near = nearest(name, known.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            Err(Self::of_table(key, format!("there is a column `{name}`{near}: {wanted}; drop other columns")))
        })
    }

    /// Refuses columns of different lengths.
    pub(crate) fn refuse_uneven<V>(key: &'static str, columns: &BTreeMap<String, Vec<V>>) -> Result<(), Self> {
        let Some((first, values)) = columns.first_key_value() else { return Ok(()) };
        let count = values.len();
        columns.iter().find(|(_, values)| values.len() != count).map_or(Ok(()), |(name, values)| {
            let text =
                format!("`{name}` has {} values and `{first}` {count}: give as many in all columns", values.len());
            Err(Self::of_table(key, text))
        })
    }
}
