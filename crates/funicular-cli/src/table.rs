//! Text: aligned tables and rounded numbers.

use comfy_table::{CellAlignment, ContentArrangement, presets};
use std::fmt;

/// A table with a header; columns from the second on hold numbers and are aligned to the right.
pub(crate) struct Table {
    inner: comfy_table::Table,
}

impl Table {
    pub(crate) fn new(header: &[&str]) -> Self {
        let mut inner = comfy_table::Table::new();
        // Never wrapped: a table in a pipe or a file looks as it does in a wide terminal.
        inner.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
        let mut table = Self { inner };
        for index in 1..header.len() {
            table.align(index, CellAlignment::Right);
        }
        table
    }

    /// Aligns these columns to the left: they hold text.
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

/// With a number of decimals; no minus before zero.
pub(crate) fn decimals(value: f64, count: usize) -> String {
    let text = format!("{value:.count$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        _ => text,
    }
}

/// With a number of significant digits; as a power of ten where that is shorter.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor() as i64;
    if (-4..=6).contains(&exponent) {
        decimals(value, (i64::try_from(digits).unwrap_or(i64::MAX) - 1 - exponent).max(0) as usize)
    } else {
        format!("{value:.places$e}", places = digits.saturating_sub(1))
    }
}

/// As [`significant`], without the zeros at the end: for numbers that the user chose.
pub(crate) fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// What stands where there is no number.
pub(crate) const NONE: &str = "–";

/// As [`decimals`], or a dash.
pub(crate) fn decimals_or_none(value: Option<f64>, count: usize) -> String {
    value.map_or_else(|| NONE.to_owned(), |value| decimals(value, count))
}

/// `a, b, c` with a number of decimals each.
pub(crate) fn vector(values: &[f64], count: usize) -> String {
    values.iter().map(|value| decimals(*value, count)).collect::<Vec<_>>().join(", ")
}

/// `1 mode`, `2 modes`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_as_said() {
        assert_eq!(decimals(-0.0001, 2), "0.00");
        assert_eq!(decimals(-0.016, 2), "-0.02");
        assert_eq!(significant(1234.5678, 6), "1234.57");
        assert_eq!(significant(-0.000_012_345, 3), "-1.23e-5");
        assert_eq!(significant(1.5e9, 4), "1.500e9");
        assert_eq!(significant(0.0, 4), "0");
        assert_eq!(short(10.55, 6), "10.55");
        assert_eq!(short(100.0, 6), "100");
    }

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&["cable", "tension [N]"]);
        table.row(vec!["é".to_owned(), "1.0".to_owned()]);
        table.row(vec!["long name".to_owned(), "100.0".to_owned()]);
        assert_eq!(table.to_string(), "  cable      tension [N]\n  é                  1.0\n  long name        100.0\n");
    }
}
