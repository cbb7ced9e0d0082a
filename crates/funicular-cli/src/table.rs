//! Aligned text tables.

use comfy_table::{CellAlignment, ContentArrangement, presets};
pub(crate) use funicular_study::text::{
    NONE, counted, decimals, decimals_or_none, digits_for, short, significant, vector,
};
use std::fmt;

/// Table with a header. Columns from the second on hold numbers and are aligned to the right.
pub(crate) struct Table {
    inner: comfy_table::Table,
}

impl Table {
    pub(crate) fn new(header: &[&str]) -> Self {
        let mut inner = comfy_table::Table::new();
        // Lines are never wrapped: a table in a pipe or a file is the same as in a wide terminal.
        inner.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
        let mut table = Self { inner };
        for index in 1..header.len() {
            table.align(index, CellAlignment::Right);
        }
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
        self.inner.add_row(cells);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for line in self.inner.lines() {
            writeln!(f, " {}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&["cable", "tension [N]"]);
        table.row(vec!["é".to_owned(), "1.0".to_owned()]);
        table.row(vec!["long name".to_owned(), "100.0".to_owned()]);
        assert_eq!(table.to_string(), "  cable      tension [N]\n  é                  1.0\n  long name        100.0\n");
    }
}
