//! Tables with units in their heads, and numbers as they are printed.

use crate::text;
use askama::Template;

/// A table with caption.
#[derive(Template)]
#[template(path = "table.html")]
pub(crate) struct Table {
    id: &'static str,
    caption: String,
    columns: Vec<Column>,
    rows: Vec<Row>,
    /// Scrolls on screen; prints in full.
    tall: bool,
}

struct Column {
    name: String,
    unit: String,
    class: &'static str,
}

struct Row {
    class: &'static str,
    cells: Vec<String>,
}

/// Rows above which a table scrolls on screen.
const TALL: usize = 30;
/// Columns from which on a table prints in a smaller type.
const DENSE: usize = 12;

impl Table {
    /// An empty table. A column is `name` or `name|unit`; one that starts with `<` is text and stands left, with `<<` it
    /// may also wrap.
    pub(crate) fn new(id: &'static str, caption: impl Into<String>, columns: &[&str]) -> Self {
        let columns = columns
            .iter()
            .map(|column| {
                let (text, class) = match (column.strip_prefix("<<"), column.strip_prefix('<')) {
                    (Some(text), _) => (text, "left wrap"),
                    (None, Some(text)) => (text, "left"),
                    (None, None) => (*column, ""),
                };
                let (name, unit) = text.split_once('|').unwrap_or((text, ""));
                Column { name: name.to_owned(), unit: unit.to_owned(), class }
            })
            .collect();
        Self { id, caption: caption.into(), columns, rows: Vec::new(), tall: false }
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.marked_row("", cells);
    }

    /// Adds a row with a style class of the sheet.
    pub(crate) fn marked_row(&mut self, class: &'static str, cells: Vec<String>) {
        debug_assert_eq!(cells.len(), self.columns.len(), "a cell for every column of {}", self.id);
        self.rows.push(Row { class, cells });
        self.tall = self.rows.len() > TALL;
    }
}

/// A number with fixed decimals and a true minus sign; what rounds to zero has none. A dash if it is not a number.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    typeset(value, || text::decimals(value, decimals))
}

/// A number with a count of significant digits; as a power of ten where that is shorter.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    typeset(value, || text::significant(value, digits))
}

fn typeset(value: f64, text: impl FnOnce() -> String) -> String {
    if value.is_finite() { text().replace('-', "−") } else { text::NONE.to_owned() }
}

/// Numbers in a row, separated by commas.
pub(crate) fn listed(values: &[f64], decimals: usize) -> String {
    if values.is_empty() {
        return "none".to_owned();
    }
    values.iter().map(|v| fixed(*v, decimals)).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign_and_minus_is_a_minus() {
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(fixed(-1.5, 1), "−1.5");
        assert_eq!(fixed(f64::INFINITY, 1), "–");
    }

    #[test]
    fn significant_digits_keep_their_count() {
        assert_eq!(significant(12345.6, 4), "12346");
        assert_eq!(significant(0.012_345, 3), "0.0123");
        assert_eq!(significant(-9.3e-7, 2), "−9.3e−7");
        assert_eq!(significant(0.0, 3), "0");
    }
}
