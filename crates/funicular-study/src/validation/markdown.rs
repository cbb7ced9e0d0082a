//! The text of docs/validation.md. Rounded to what is claimed, so that it is the same wherever it is made.

use super::{Bound, Kind, Row, Section};
use crate::text::{counted, decimals, significant};
use std::fmt::Write;

/// Digits of the numbers of a row; their last are far above rounding.
const DIGITS: i32 = 7;

/// The whole text.
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

Every number here was published by others or computed by other means; the program computes the same case and says how
far it is off. This file is generated: `funicular validate -o docs/validation.md`. `funicular validate --format json`
gives every digit. The reference numbers, each with its source, are in `crates/funicular-study/reference/`.

| column | meaning |
|:---|:---|
| case | what was computed |
| quantity | what is compared, with its unit; of several numbers all are compared |
| theirs, ours | the reference and this program, rounded here |
| difference | the largest one: *rel.* over the size of their number, *abs.* in the unit of the quantity |
| tolerance | the largest difference that passes |
| bounded by | why it is not smaller |
| pass | the difference is within the tolerance |

Where both sides solve the same equations, only rounding is left, or the small error of elements; its size depends on
the machine and means nothing, so it is given as less than the tolerance. Where the models differ, or few digits were
printed, the difference is what it is, and three causes are to be expected: the closed form has no *axial inertia* (a
cable is too stiff along its chord by about (ω l √(m/EA))²/3); it has *one tension per string*, while the tension of a
real one grows towards its upper end; and the *strain* of a rope, which models count into its length and mass in
different ways.

";

const HEAD: &str = "\
| case | quantity | theirs | ours | difference | tolerance | bounded by | pass |
|:---|:---|---:|---:|---:|---:|:---|:---|";

pub(super) fn line(row: &Row) -> String {
    let Row { case, quantity, theirs, ours, difference, kind, tolerance, bounded_by, pass, .. } = row;
    let places = if *bounded_by == Bound::Count { Places::Decimals(0) } else { Places::of(theirs) };
    let kind = match kind {
        _ if *bounded_by == Bound::Count => "",
        Kind::Absolute => "abs. ",
        Kind::Relative => "rel. ",
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

/// How the numbers of a row are printed: all with the decimals of the largest.
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

    /// As printed, if that is shorter.
    fn of_theirs(&self, value: f64) -> String {
        let (rounded, printed) = (self.show(value), format!("{value}"));
        if printed.len() < rounded.len() { printed } else { rounded }
    }
}

/// Two digits.
fn two(value: f64) -> String {
    if value != 0.0 && (value.abs() < 1e-3 || value.abs() >= 100.0) {
        format!("{value:.1e}")
    } else {
        significant(value, 2)
    }
}

/// One digit: tolerances of rounding are chosen so.
fn power(value: f64) -> String {
    format!("{value:e}")
}

/// Text that a table can hold.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validation::{Case, sections};

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
            "docs/validation.md is not what the program computes now; if the change is meant, regenerate it with \
             `UPDATE_DOCS=1 cargo test -p funicular-study validation`"
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
        assert!(!row.pass, "what is not a number does not pass");
    }
}
