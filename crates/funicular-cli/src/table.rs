//! Aligned text tables.

use comfy_table::{CellAlignment, ContentArrangement, presets};
use funicular_study::columns::{COMPONENTS, Columns, Heading, Style};
pub(crate) use funicular_study::text::{NONE, counted, decimals, decimals_or_none, short, significant, vector};
use std::borrow::Borrow;
use std::fmt;

/// Minimum width of a component of a vector in a table.
const COMPONENT_WIDTH: usize = 10;

/// Minimum number of spaces before a component of a vector.
const COMPONENT_GAP: usize = 2;

/// Table with a header. Columns from the second on hold numbers and are aligned to the right.
pub(crate) struct Table {
    inner: comfy_table::Table,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(header: &[&str]) -> Self {
        let mut inner = comfy_table::Table::new();
        // Lines are never wrapped: a table in a pipe or a file is the same as in a wide terminal.
        inner.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
        let mut table = Self { inner, rows: Vec::new() };
        for index in 1..header.len() {
            table.align(index, CellAlignment::Right);
        }
        table
    }

    /// Table of rows with the columns of their kind.
    pub(crate) fn of<R>(columns: &Columns<R>, rows: impl IntoIterator<Item: Borrow<R>>) -> Self {
        let headings = columns.headings(Style::Plain);
        let names: Vec<String> = headings.iter().map(Heading::with_unit).collect();
        let texts: Vec<usize> = (0..headings.len()).filter(|index| headings[*index].is_text).collect();
        let mut table = Self::new(&names.iter().map(String::as_str).collect::<Vec<_>>()).text_columns(&texts);
        rows.into_iter().for_each(|row| table.row(columns.texts(row.borrow(), Style::Plain)));
        table
    }

    /// Aligns columns that hold text to the left.
    pub(crate) fn text_columns(mut self, columns: &[usize]) -> Self {
        for &index in columns {
            self.align(index, CellAlignment::Left);
        }
        self
    }

    fn align(&mut self, index: usize, alignment: CellAlignment) {
        if let Some(column) = self.inner.column_mut(index) {
            column.set_cell_alignment(alignment);
        }
    }

    pub(crate) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Widths of the components of the vectors in a column.
    fn component_widths(&self, column: usize) -> Vec<usize> {
        let mut widths = Vec::new();
        for cell in self.rows.iter().filter_map(|row| row.get(column)).filter(|cell| cell.contains(COMPONENTS)) {
            for (i, text) in cell.split(COMPONENTS).enumerate() {
                let width = COMPONENT_WIDTH.max(text.chars().count() + COMPONENT_GAP);
                match widths.get_mut(i) {
                    Some(known) => *known = width.max(*known),
                    None => widths.push(width),
                }
            }
        }
        widths
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<Vec<usize>> = (0..columns).map(|column| self.component_widths(column)).collect();
        let mut laid_out = self.inner.clone();
        for row in &self.rows {
            laid_out.add_row(row.iter().zip(&widths).map(|(cell, widths)| aligned(cell, widths)));
        }

        for line in laid_out.lines() {
            writeln!(f, " {}", line.trim_end())?;
        }
        Ok(())
    }
}

/// Cell with the components of a vector aligned to the right; any other cell as it is.
fn aligned(cell: &str, widths: &[usize]) -> String {
    if !cell.contains(COMPONENTS) {
        return cell.to_owned();
    }
    let parts: Vec<String> =
        cell.split(COMPONENTS).zip(widths).map(|(text, width)| format!("{text:>width$}")).collect();
    parts.concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_of_vectors_never_touch_and_stand_below_each_other() {
        let mut table = Table::new(&["cable", "anchor [m]", "n"]);
        for (name, anchor) in [("1", [17_500.0, 11_000.0, -123_456.5]), ("2", [-4.0, 3.0, 5.0])] {
            table.row(vec![name.to_owned(), Style::Plain.components(&anchor, 4), "7".to_owned()]);
        }
        table.row(vec!["3".to_owned(), NONE.to_owned(), "7".to_owned()]);
        let text = table.to_string();
        let numbers: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(numbers[1], ["1", "17500.0000", "11000.0000", "-123456.5000", "7"], "{text}");
        assert_eq!(numbers[2], ["2", "-4.0000", "3.0000", "5.0000", "7"], "{text}");

        let ends = |line: &str| -> Vec<usize> {
            let starts = line
                .char_indices()
                .filter(|(i, c)| !c.is_whitespace() && line[i + c.len_utf8()..].starts_with([' ', '\n']));
            starts.map(|(i, _)| i).collect()
        };
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(ends(lines[1]), ends(lines[2]), "{text}");
    }

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&["cable", "tension [N]"]);
        table.row(vec!["é".to_owned(), "1.0".to_owned()]);
        table.row(vec!["long name".to_owned(), "100.0".to_owned()]);
        assert_eq!(table.to_string(), "  cable      tension [N]\n  é                  1.0\n  long name        100.0\n");
    }
}
