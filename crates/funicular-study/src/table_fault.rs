//! Fault of a table of numbers that a request holds: the front end that has read its file names the line.

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
