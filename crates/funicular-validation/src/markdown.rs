//! Text of docs/validation.md. Numbers are rounded to the claimed digits, so that every machine makes the same text.

use super::{Bound, Comparison, DifferenceKind, Section};
use funicular_study::text::{counted, decimals, significant};
use std::fmt::Write;

/// Number of digits in a row. The last digit is far above rounding errors.
const DIGITS: i32 = 7;

/// Complete text.
pub fn markdown(sections: &[Section]) -> String {
    let mut text = String::from(INTRODUCTION);
    let all = || sections.iter().flat_map(|section| &section.rows);
    let _ =
        writeln!(text, "{} of {} pass.\n", all().filter(|row| row.pass).count(), counted(all().count(), "comparison"));

    for (i, section) in sections.iter().enumerate() {
        let passed = section.rows.iter().filter(|row| row.pass).count();
        let (number, title, rows) = (i + 1, section.title, section.rows.len());
        let _ = writeln!(text, "## {number}. {title}\n\n{}\n\n{passed} of {rows} pass.", section.note);
        for rows in section.rows.chunk_by(|a, b| a.source == b.source) {
            let _ =
                writeln!(text, "\nSource: {}\n\n{HEAD}", cell(&rows[0].source).trim_end_matches('.').to_owned() + ".");
            for row in rows {
                let _ = writeln!(text, "{}", line(row));
            }
        }
        text.push('\n');
    }

    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

const INTRODUCTION: &str = "\
# Validation

Every reference number here was published by others or computed by other means. The program computes the same case and
reports the difference. This file is generated: `funicular validate -o docs/validation.md`. `funicular validate --format
json` gives every digit. The reference numbers, each with its source, are in `crates/funicular-validation/reference/`.

| column | meaning |
|:---|:---|
| case | the robot or cable, and its state |
| quantity | the compared quantity, with its unit; if it has several numbers, all are compared |
| theirs, ours | the reference and this program, rounded |
| difference | the maximum difference: *rel.* relative to the reference number, *abs.* in the unit of the quantity |
| tolerance | the maximum difference that passes |
| bounded by | the reason why the tolerance is not smaller |
| pass | whether the difference is within the tolerance |

If both sides solve the same equations, only rounding or the small error of elements remains. The size of this
difference depends on the machine and has no meaning, so the table gives it as less than the tolerance. If the models
differ, or if few digits were printed, the table gives the difference itself. Three causes are to be expected. The model
`shallow-dynamic` has no *axial inertia*: a cable is too stiff along its chord by about (ω l √(m/EA))²/3. It has *one
tension per string*, while the tension of a real cable grows towards its upper end. And the *strain* of a rope enters
its length and mass differently in different models.

";

const HEAD: &str = "\
| case | quantity | theirs | ours | difference | tolerance | bounded by | pass |
|:---|:---|---:|---:|---:|---:|:---|:---|";

pub(super) fn line(row: &Comparison) -> String {
    let Comparison { case, quantity, theirs, ours, difference, kind, tolerance, bounded_by, pass, .. } = row;
    let places = if *bounded_by == Bound::Count { Places::Decimals(0) } else { Places::of(theirs) };
    let kind = match kind {
        _ if *bounded_by == Bound::Count => "",
        DifferenceKind::Absolute => "abs. ",
        DifferenceKind::Relative => "rel. ",
    };

    let difference = match bounded_by {
        Bound::Count => format!("{difference}"),
        Bound::Rounding | Bound::Elements if *pass => format!("{kind}< {}", power(*tolerance)),
        _ => format!("{kind}{}", two(*difference)),
    };
    let tolerance = match bounded_by {
        Bound::Count => "0".to_owned(),
        Bound::Rounding | Bound::Elements => power(*tolerance),
        _ => two(*tolerance),
    };
    let list =
        |values: &[f64], show: &dyn Fn(f64) -> String| values.iter().map(|v| show(*v)).collect::<Vec<_>>().join(", ");
    let theirs = list(theirs, &|value| places.of_theirs(value));
    let ours = list(ours, &|value| places.show(value));

    let bound: &str = (*bounded_by).into();
    let pass = if *pass { "yes" } else { "**no**" };

    format!(
        "| {} | {} | {theirs} | {ours} | {difference} | {tolerance} | {bound} | {pass} |",
        cell(case),
        cell(quantity)
    )
}

/// Format of the numbers in a row: all have the decimals of the largest number.
enum Places {
    Decimals(usize),
    Powers,
}

impl Places {
    fn of(values: &[f64]) -> Self {
        let largest = super::largest(values);
        if largest == 0.0 {
            return Self::Decimals(0);
        }
        let exponent = largest.log10().floor() as i32;
        if exponent < -4 { Self::Powers } else { Self::Decimals(usize::try_from(DIGITS - 1 - exponent).unwrap_or(0)) }
    }

    fn show(&self, value: f64) -> String {
        match self {
            Self::Decimals(count) => decimals(value, *count),
            Self::Powers => significant(value, DIGITS as usize),
        }
    }

    /// Shortest exact text of a number if it is shorter than the rounded one.
    fn of_theirs(&self, value: f64) -> String {
        let (rounded, printed) = (self.show(value), format!("{value}"));
        if printed.len() < rounded.len() { printed } else { rounded }
    }
}

/// Number with two digits.
fn two(value: f64) -> String {
    if value != 0.0 && (value.abs() < 1e-3 || value.abs() >= 100.0) {
        format!("{value:.1e}")
    } else {
        significant(value, 2)
    }
}

/// Number with one digit, which tolerances of rounding have.
fn power(value: f64) -> String {
    format!("{value:e}")
}

/// Text with the escapes that a table needs.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Case, sections};

    #[test]
    fn the_committed_file_is_the_generated_one() {
        let generated = markdown(&sections().unwrap());
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(file, &generated).unwrap();
        }
        let committed = std::fs::read_to_string(file).unwrap();
        assert!(
            generated == committed,
            "docs/validation.md differs from what the program computes now; if the change is intended, regenerate it \
             with `UPDATE_DOCS=1 cargo test -p funicular-validation`"
        );
    }

    #[test]
    fn a_row_says_what_kind_of_difference_it_has_and_hides_rounding_only() {
        let case = Case { name: "a | b".to_owned(), source: "s" };
        let row = case.relative("H [N]", &[100.0, 0.5], &[100.0 + 1e-11, 0.5], 1e-12, Bound::Rounding);
        assert_eq!(
            line(&row),
            "| a \\| b | H [N] | 100, 0.5 | 100.0000, 0.5000 | rel. < 1e-12 | 1e-12 | rounding | yes |"
        );
        let row = case.absolute("x [m]", &[2.0], &[2.004], 3e-3, Bound::Digits("two decimals"));
        assert_eq!(line(&row), "| a \\| b | x [m] | 2 | 2.004000 | abs. 0.0040 | 0.0030 | two decimals | **no** |");
        let row = case.relative("H [N]", &[1.0], &[f64::NAN], 1e-12, Bound::Rounding);
        assert!(!row.pass, "NaN never passes");
    }
}
