//! One comparison, with its identity; the case and the quantity from which it is made.

use funicular_study::names::{Named, ValidationLevel as Level};
use serde::{Serialize, Serializer};

/// Comparison of numbers of the program with reference numbers.
#[derive(Clone, Serialize)]
pub struct Comparison {
    /// Name that stays: section, case and quantity.
    pub id: String,
    /// Case: the robot or cable, and its state.
    pub case: String,
    /// Kind of the reference.
    #[serde(serialize_with = "named")]
    pub level: Level,
    /// Source of the reference numbers.
    pub source: String,
    /// Compared quantity, with its unit.
    pub quantity: String,
    /// Number of reference numbers that are compared.
    pub numbers: usize,
    /// Reference numbers; if there are many, the ones that the quantity names.
    pub theirs: Vec<f64>,
    /// Numbers of the program, in the same order.
    pub ours: Vec<f64>,
    /// Maximum difference.
    pub difference: f64,
    /// Kind of the difference: absolute or relative.
    pub kind: DifferenceKind,
    /// Maximum difference that passes.
    pub tolerance: f64,
    /// Reason for the size of the tolerance.
    pub bounded_by: Bound,
    /// True if the difference is within the tolerance.
    pub pass: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn named<S: Serializer>(level: &Level, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(level.name())
}

/// Kind of a difference.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DifferenceKind {
    /// Absolute, in the unit of the quantity.
    Absolute,
    /// Relative, divided by the size of the reference numbers.
    Relative,
}

impl DifferenceKind {
    /// Name in tables, as in JSON.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Absolute => "absolute",
            Self::Relative => "relative",
        }
    }
}

/// Cause that bounds a difference.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(into = "&'static str")]
pub enum Bound {
    /// Rounding only: both sides have the same model, and no digit of the difference has a meaning.
    Rounding,
    /// Known error of elements that resolve the same model; digits of the difference have no meaning.
    Elements,
    /// Number of printed digits, or the tolerance of the other program.
    Digits(&'static str),
    /// Difference of the models: the effect that one of them leaves out.
    Model(&'static str),
    /// Integers, which must be equal.
    Count,
}

impl From<Bound> for &'static str {
    fn from(bound: Bound) -> Self {
        match bound {
            Bound::Rounding => "rounding",
            Bound::Elements => "error of the elements",
            Bound::Count => "a count",
            Bound::Digits(text) | Bound::Model(text) => text,
        }
    }
}

/// Case and source that several comparisons share.
pub(super) struct Case<'a> {
    id: String,
    name: String,
    level: Level,
    source: &'a str,
}

impl<'a> Case<'a> {
    /// Case by its name within the section, for IDs and for readers.
    pub(super) fn new(level: Level, source: &'a str, id: &str, name: &str) -> Self {
        Self { id: id.to_owned(), name: name.to_owned(), level, source }
    }

    /// Case with numbers of another level and source.
    pub(super) fn with(self, level: Level, source: &'a str) -> Self {
        Self { level, source, ..self }
    }

    /// Quantity by its name within the case, for IDs and for readers.
    pub(super) fn of<'b>(&'b self, id: &'b str, name: &'b str) -> ComparedQuantity<'b> {
        ComparedQuantity { case: self, id, name, level: self.level, numbers: None }
    }
}

/// Quantity of a case, ready to be compared.
pub(super) struct ComparedQuantity<'a> {
    case: &'a Case<'a>,
    id: &'a str,
    name: &'a str,
    level: Level,
    numbers: Option<usize>,
}

impl ComparedQuantity<'_> {
    /// Number of reference numbers, where not all are shown.
    pub(super) fn numbers(self, numbers: usize) -> Self {
        Self { numbers: Some(numbers), ..self }
    }

    /// Level that is not that of the case.
    pub(super) fn level(self, level: Level) -> Self {
        Self { level, ..self }
    }

    /// Comparison by the maximum absolute difference.
    pub(super) fn absolute(self, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = largest_difference(theirs, ours);
        self.row((theirs, ours), (difference, DifferenceKind::Absolute), tolerance, bound)
    }

    /// Comparison by the maximum relative difference, each relative to its own reference number.
    pub(super) fn relative(self, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = worst(theirs.iter().zip(ours).map(|(a, b)| over((a - b).abs(), a.abs())));
        self.row((theirs, ours), (difference, DifferenceKind::Relative), tolerance, bound)
    }

    /// Comparison by the maximum difference, relative to the largest reference number.
    pub(super) fn together(self, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = over(largest_difference(theirs, ours), largest(theirs));
        self.row((theirs, ours), (difference, DifferenceKind::Relative), tolerance, bound)
    }

    /// Comparison of two counts.
    pub(super) fn count(self, theirs: usize, ours: usize) -> Comparison {
        self.absolute(&[theirs as f64], &[ours as f64], 0.0, Bound::Count)
    }

    /// Comparison with a given difference of many numbers, of which only `shown` (theirs, ours) is printed.
    pub(super) fn row(
        self,
        shown: (&[f64], &[f64]),
        (difference, kind): (f64, DifferenceKind),
        tolerance: f64,
        bounded_by: Bound,
    ) -> Comparison {
        Comparison {
            id: format!("{}/{}", self.case.id, self.id),
            case: self.case.name.clone(),
            level: self.level,
            source: self.case.source.to_owned(),
            quantity: self.name.to_owned(),
            numbers: self.numbers.unwrap_or(shown.0.len()),
            theirs: shown.0.to_vec(),
            ours: shown.1.to_vec(),
            difference,
            kind,
            tolerance,
            bounded_by,
            // NaN never passes.
            pass: shown.0.len() == shown.1.len() && difference <= tolerance,
        }
    }
}

/// Name in an ID: letters, digits, dots and signs of a text, and a dash for all between them.
pub(super) fn slug(text: &str) -> String {
    let mut slug = String::new();
    for letter in text.to_lowercase().chars() {
        let kept = match letter {
            'λ' => "lambda",
            'ξ' => "xi",
            '²' => "2",
            'η' => "eta",
            _ => "",
        };
        let is_plain = letter.is_ascii_alphanumeric() || letter == '.';
        if is_plain {
            slug.push(letter);
        } else if !kept.is_empty() {
            slug.push_str(kept);
        } else if !slug.ends_with('-') && !slug.is_empty() {
            slug.push('-');
        }
    }
    slug.trim_end_matches(['-', '.']).to_owned()
}

/// Quotient, with 0/0 = 0.
pub(super) fn over(difference: f64, size: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / size }
}

/// Maximum difference; NaN if one of them is NaN.
pub(super) fn worst(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |max, d| if d > max || d.is_nan() { d } else { max })
}

pub(super) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

pub(super) fn largest(values: &[f64]) -> f64 {
    worst(values.iter().map(|value| value.abs()))
}
