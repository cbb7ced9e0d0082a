//! Tables of pages with units in their heads, and formatting of numbers.

use askama::Template;
use funicular_study::columns::{Columns, Style};
use funicular_study::text;
use std::borrow::Borrow;

/// Table of a page, with a caption.
#[derive(Template)]
#[template(path = "table.html")]
pub(crate) struct PageTable {
    id: &'static str,
    caption: String,
    columns: Vec<TableColumn>,
    rows: Vec<TableRow>,
    /// True if the table scrolls on screen; it prints in full.
    tall: bool,
}

struct TableColumn {
    name: String,
    unit: String,
    class: &'static str,
}

struct TableRow {
    class: &'static str,
    cells: Vec<String>,
}

/// Number of rows above which a table scrolls on screen.
const TALL: usize = 30;
/// Number of columns from which on a table is printed in a smaller font.
const DENSE: usize = 12;

impl PageTable {
    /// Creates an empty table. A column is `name` or `name|unit`. A leading `<` marks a text column, aligned left; `<<`
    /// also allows line breaks.
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
                TableColumn { name: name.to_owned(), unit: unit.to_owned(), class }
            })
            .collect();
        Self { id, caption: caption.into(), columns, rows: Vec::new(), tall: false }
    }

    /// Table of rows with the columns of their kind.
    pub(crate) fn of<R>(
        id: &'static str,
        caption: impl Into<String>,
        columns: &Columns<R>,
        rows: impl IntoIterator<Item: Borrow<R>>,
    ) -> Self {
        Self::marked(id, caption, columns, rows, |_| "")
    }

    /// Table of rows, each with the class of the style sheet that `class` gives.
    pub(crate) fn marked<R>(
        id: &'static str,
        caption: impl Into<String>,
        columns: &Columns<R>,
        rows: impl IntoIterator<Item: Borrow<R>>,
        class: impl Fn(&R) -> &'static str,
    ) -> Self {
        let columns_of_page = columns.headings(Style::Typeset).into_iter().map(|heading| TableColumn {
            name: heading.name.to_owned(),
            unit: heading.unit.to_owned(),
            class: if heading.is_text { "left" } else { "" },
        });
        let columns_of_page = columns_of_page.collect();
        let mut table = Self { id, caption: caption.into(), columns: columns_of_page, rows: Vec::new(), tall: false };
        for row in rows {
            let row = row.borrow();
            table.marked_row(class(row), columns.texts(row, Style::Typeset));
        }
        table
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.marked_row("", cells);
    }

    /// Adds a row with a class of the style sheet.
    pub(crate) fn marked_row(&mut self, class: &'static str, cells: Vec<String>) {
        assert_eq!(cells.len(), self.columns.len(), "a cell for every column of {}", self.id);
        self.rows.push(TableRow { class, cells });
        self.tall = self.rows.len() > TALL;
    }
}

/// Number with fixed decimals and a real minus sign. A value that rounds to zero has no sign; NaN gives a dash.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    typeset(value, || text::decimals(value, decimals))
}

/// Number with a count of significant digits, as a power of ten if that is shorter.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    typeset(value, || text::significant(value, digits))
}

fn typeset(value: f64, text: impl FnOnce() -> String) -> String {
    if value.is_finite() { text().replace('-', "−") } else { text::NONE.to_owned() }
}

/// Numbers separated by commas; "none" for an empty list.
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
