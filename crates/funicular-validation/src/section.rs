//! Sections: each declares its comparisons and the wrong inputs with which they must fail.

use super::Comparison;
use anyhow::{Context, Result};
use serde::Serialize;

/// Section of docs/validation.md: comparisons that belong together.
#[derive(Serialize)]
pub struct Section {
    /// First part of the IDs of its comparisons.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Description of the comparisons and of the differences to expect.
    pub note: &'static str,
    /// Comparisons.
    pub rows: Vec<Comparison>,
}

/// Run of a negative control: a section with one wrong input.
#[derive(Serialize)]
pub struct ControlRun {
    /// Name that stays: section and input.
    pub id: String,
    /// Wrong input.
    pub wrong: &'static str,
    /// Fault that the section would therefore find.
    pub proves: &'static str,
    /// Number of comparisons with the wrong input.
    pub comparisons: usize,
    /// Number of those that fail.
    pub failed: usize,
    /// ID of the comparison that exceeds its tolerance most; empty if none does.
    pub worst: String,
    /// Difference of this comparison over its tolerance; absent for a count, and where a number is infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub excess: Option<f64>,
    /// True if a comparison fails, as it must.
    pub caught: bool,
}

/// Declaration of a section.
pub(super) struct Declared {
    /// First part of the IDs of its comparisons.
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pub(super) note: &'static str,
    /// Makes the comparisons.
    pub(super) rows: fn() -> Result<Vec<Comparison>>,
    /// Wrong inputs with which the section must fail.
    pub(super) controls: &'static [NegativeControl],
}

/// Declaration of a negative control.
pub(super) struct NegativeControl {
    /// Name within the section.
    pub(super) id: &'static str,
    /// Wrong input, in words.
    pub(super) wrong: &'static str,
    /// Fault that the section would therefore find.
    pub(super) proves: &'static str,
    /// Makes the comparisons, or some of them, with the wrong input.
    pub(super) rows: fn() -> Result<Vec<Comparison>>,
}

impl Declared {
    /// Makes the comparisons.
    pub(super) fn section(&self) -> Result<Section> {
        let rows = (self.rows)().with_context(|| format!("section {}", self.id))?;
        Ok(Section { id: self.id, title: self.title, note: self.note, rows: self.named(rows) })
    }

    /// Runs the negative controls.
    pub(super) fn run_controls(&self) -> impl Iterator<Item = Result<ControlRun>> {
        self.controls.iter().map(|control| {
            let rows = (control.rows)().with_context(|| format!("control {}/{}", self.id, control.id))?;
            let rows = self.named(rows);
            let excess = |row: &Comparison| if row.tolerance > 0.0 { row.difference / row.tolerance } else { 0.0 };
            let failed = || rows.iter().filter(|row| !row.pass);
            let worst = failed().max_by(|a, b| excess(a).total_cmp(&excess(b)));
            Ok(ControlRun {
                id: format!("{}/{}", self.id, control.id),
                wrong: control.wrong,
                proves: control.proves,
                comparisons: rows.len(),
                failed: failed().count(),
                worst: worst.map(|row| row.id.clone()).unwrap_or_default(),
                excess: worst.map(excess).filter(|excess| excess.is_finite() && *excess > 0.0),
                caught: worst.is_some(),
            })
        })
    }

    /// Comparisons whose IDs begin with the section.
    fn named(&self, mut rows: Vec<Comparison>) -> Vec<Comparison> {
        for row in &mut rows {
            row.id = format!("{}/{}", self.id, row.id);
        }
        rows
    }
}

/// Factor of a wrong input: 1 % too large.
pub(super) const WRONG: f64 = 1.01;

/// Robot file in which the numbers of a key are multiplied by a factor, on the first `lines` lines that have it.
pub(super) fn with_scaled(text: &str, key: &str, factor: f64, lines: usize) -> String {
    let mut left = lines;
    let mut scaled = String::new();
    for line in text.lines() {
        let value = line.trim_start().strip_prefix(key).and_then(|rest| rest.trim_start().strip_prefix('='));
        match value {
            Some(value) if left > 0 => {
                left -= 1;
                let numbers = value.trim_start().split_inclusive([',', '[', ']']).map(|part| {
                    let number = part.trim_end_matches([',', '[', ']']);
                    let end = &part[number.len()..];
                    match number.trim().parse::<f64>() {
                        Ok(number) => format!("{:?}{end}", number * factor),
                        Err(_) => part.to_owned(),
                    }
                });
                scaled.extend([key, " = "]);
                scaled.extend(numbers);
            }
            _ => scaled.push_str(line),
        }
        scaled.push('\n');
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::with_scaled;

    #[test]
    fn numbers_of_one_key_are_scaled() {
        let text = "a = 1.0\n[b]\na_b = [1.0, -2.0]\na_b = [[3.0], [4.0]]\n";
        let all = "a = 1.0\n[b]\na_b = [2.0,-4.0]\na_b = [[6.0], [8.0]]\n";
        assert_eq!(with_scaled(text, "a_b", 2.0, usize::MAX), all);
        assert_eq!(with_scaled(text, "a", 2.0, usize::MAX), text.replace("a = 1.0", "a = 2.0"));
        assert_eq!(with_scaled(text, "a_b", 2.0, 1), text.replace("[1.0, -2.0]", "[2.0,-4.0]"));
    }
}
