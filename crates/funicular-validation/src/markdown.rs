//! Text of docs/validation.md. Numbers are rounded to the claimed digits, so that every machine makes the same text.

use super::comparison::{Bound, Comparison, DifferenceKind};
use super::section::ControlRun;
use super::verdict::LevelCount;
use super::wrong_references::{WRONG_REFERENCES, WrongReference};
use super::{Level, Validated};
use funicular_study::names::Named;
use funicular_study::text::{counted, decimals, significant};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of digits in a row. The last digit is far above rounding errors.
const DIGITS: i32 = 7;

/// Complete text.
pub fn markdown(found: &Validated) -> String {
    let mut text = String::from(INTRODUCTION);
    text.push_str(&counts(found));
    for (i, section) in found.sections.iter().enumerate() {
        let passed = section.rows.iter().filter(|row| row.pass).count();
        let (number, title, rows) = (i + 1, section.title, section.rows.len());
        let _ = writeln!(text, "## {number}. {title}\n\n{}\n\n{passed} of {rows} pass.", section.note);
        for rows in section.rows.chunk_by(|a, b| a.source == b.source) {
            let source = cell(&rows[0].source);
            let _ = writeln!(text, "\nSource: {}.\n\n{HEAD}", source.trim_end_matches('.'));
            for row in rows {
                let _ = writeln!(text, "{}", line(row));
            }
        }
        text.push('\n');
    }
    text.push_str(&known_differences(found));
    text.push_str(&wrong_references());
    text.push_str(&controls(&found.controls));

    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Number of comparisons, and the table of levels.
fn counts(found: &Validated) -> String {
    let (all, numbers) = (counted(found.comparisons, "comparison"), counted(found.numbers, "reference number"));
    let mut text = format!("{} of {all} pass, with {numbers} from {} sources.\n", found.passed, found.sources);
    text.push_str("\n| level | reference numbers | comparisons | numbers | sources |\n|:---|:---|---:|---:|---:|\n");
    for count in &found.levels {
        let about = Level::from_name(count.level).map_or("", Named::about);
        let LevelCount { level, comparisons, numbers, sources } = count;
        let _ = writeln!(text, "| `{level}` | {about} | {comparisons} | {numbers} | {sources} |");
    }
    text.push('\n');
    text
}

/// Differences of the models, by the effect that one of them leaves out.
fn known_differences(found: &Validated) -> String {
    let mut by_effect: BTreeMap<&str, (usize, f64, &str)> = BTreeMap::new();
    for row in found.sections.iter().flat_map(|section| &section.rows) {
        if let Bound::Model(effect) = row.bounded_by {
            let part = if row.tolerance > 0.0 { row.difference / row.tolerance } else { 0.0 };
            let (count, largest, id) = by_effect.entry(effect).or_insert((0, -1.0, ""));
            *count += 1;
            if part > *largest {
                (*largest, *id) = (part, &row.id);
            }
        }
    }
    if by_effect.is_empty() {
        return String::new();
    }
    let mut text = String::from(KNOWN_DIFFERENCES);
    for (effect, (count, _, id)) in by_effect {
        let _ = writeln!(text, "| {} | {count} | `{id}` |", cell(effect));
    }
    text.push('\n');
    text
}

/// Table of reference numbers that are not used.
fn wrong_references() -> String {
    let mut text = String::from(WRONG_HEAD);
    for WrongReference { source, quantity, published, right, why } in WRONG_REFERENCES {
        let _ = writeln!(text, "| {} | {} | {published} | {right} | {} |", cell(source), cell(quantity), cell(why));
    }
    text.push('\n');
    text
}

/// Table of the negative controls that were run.
fn controls(runs: &[ControlRun]) -> String {
    if runs.is_empty() {
        return String::new();
    }
    let mut text = String::from(CONTROLS_HEAD);
    for ControlRun { id, wrong, proves, comparisons, failed, worst, excess, caught } in runs {
        let worst = match excess {
            _ if !caught => "**none fails**".to_owned(),
            Some(excess) => format!("`{worst}`, {excess:.0e} times its tolerance"),
            None => format!("`{worst}`"),
        };
        let anchor = format!("<a id=\"control/{id}\"></a>`{id}`");
        let _ = writeln!(text, "| {anchor} | {wrong} | {proves} | {failed} of {comparisons} | {worst} |");
    }
    text
}

const INTRODUCTION: &str = "\
# Validation

Every reference number here was published by others or computed by other means. The program computes the same case and
reports the difference. This file is generated: `funicular validate --controls > docs/validation.md`. `funicular
validate --format json` gives every digit, `-o FILE.xml` a report for build servers (JUnit), `-o FILE.svg` a badge. The
reference numbers, each with its source, are in `crates/funicular-validation/reference/`.

Each comparison has an ID that stays. It is the address of its row on this page, and `funicular validate --only ID`
computes it alone; the beginning of an ID means all comparisons that begin with it, as in `--only catenary`.

| column | meaning |
|:---|:---|
| ID | name of the comparison: section, source or case, quantity |
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
| ID | case | quantity | theirs | ours | difference | tolerance | bounded by | pass |
|:---|:---|:---|---:|---:|---:|---:|:---|:---|";

const KNOWN_DIFFERENCES: &str = "\
## Known differences of the models

Where the reference has another model, the tolerance is the effect that one of the two leaves out. Nearest to its
tolerance is the comparison that is named.

| effect | comparisons | nearest to its tolerance |
|:---|---:|:---|
";

const WRONG_HEAD: &str = "\
## Reference values that were found wrong

Published values that the equations of their own source contradict. They are not used, or compared only as
what they are.

| source | quantity | published | right | why |
|:---|:---|---:|---:|:---|
";

const CONTROLS_HEAD: &str = "\
## Negative controls

A comparison proves something only if a fault makes it fail. Each control computes comparisons of its section with one
wrong input, and at least one of them must fail; `funicular validate --controls` runs them.

| ID | wrong input | fault that would be found | fail | most |
|:---|:---|:---|---:|:---|
";

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

    let id = &row.id;
    format!(
        "| <a id=\"{id}\"></a>`{id}` | {} | {} | {theirs} | {ours} | {difference} | {tolerance} | {bound} | {pass} |",
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
    use crate::Case;
    use crate::tests::all;

    #[test]
    fn the_committed_file_is_the_generated_one_and_no_id_vanishes() {
        let generated = markdown(all());
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
        let committed = std::fs::read_to_string(file).unwrap();
        let ids = |text: &str| -> Vec<String> {
            text.split("<a id=\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
        };
        let known = ids(&generated);
        let vanished: Vec<String> = ids(&committed).into_iter().filter(|id| !known.contains(id)).collect();
        assert!(
            vanished.is_empty(),
            "IDs stay: {vanished:?} are in docs/validation.md, but nothing has them; if one has to go, remove its row \
             there by hand"
        );
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(file, &generated).unwrap();
            return;
        }
        assert!(
            generated == committed,
            "docs/validation.md differs from what the program computes now; if the change is intended, regenerate it \
             with `UPDATE_DOCS=1 cargo test -p funicular-validation`"
        );
    }

    #[test]
    fn a_row_says_what_kind_of_difference_it_has_and_hides_rounding_only() {
        let case = Case::new(Level::Exact, "s", "a", "a | b");
        let of = |name| case.of("q", name);
        let row = of("H [N]").relative(&[100.0, 0.5], &[100.0 + 1e-11, 0.5], 1e-12, Bound::Rounding);
        assert_eq!(
            line(&row),
            "| <a id=\"a/q\"></a>`a/q` | a \\| b | H [N] | 100, 0.5 | 100.0000, 0.5000 | rel. < 1e-12 | 1e-12 | \
             rounding | yes |"
        );
        let row = of("x [m]").absolute(&[2.0], &[2.004], 3e-3, Bound::Digits("two decimals"));
        assert!(line(&row).ends_with("| 2 | 2.004000 | abs. 0.0040 | 0.0030 | two decimals | **no** |"));
        let row = of("H [N]").relative(&[1.0], &[f64::NAN], 1e-12, Bound::Rounding);
        assert!(!row.pass, "NaN never passes");
    }
}
