//! The core against numbers that others published or computed: the rows of docs/validation.md.
//!
//! The numbers are in crates/funicular-study/reference, each table with its source. They are compared here and nowhere else:
//! the core's own tests have limits, identities and other algorithms. One file per section, a test for each.

mod catenary;
mod cube;
mod damped;
mod dynamics;
mod exact;
mod independent;
mod markdown;
mod paper;
mod reference;
mod robots;
mod shapes;
#[cfg(test)]
mod tests;

pub use markdown::markdown;

use anyhow::Result;
use serde::Serialize;

/// Comparisons that belong together.
#[derive(Serialize)]
pub struct Section {
    /// Title.
    pub title: &'static str,
    /// What is compared, and which differences are to be expected.
    pub note: &'static str,
    /// The comparisons.
    pub rows: Vec<Row>,
}

/// One comparison.
#[derive(Serialize)]
pub struct Row {
    /// Of what.
    pub case: String,
    /// Where their numbers come from.
    pub source: String,
    /// What is compared, with its unit.
    pub quantity: String,
    /// Their numbers; of many, those that the quantity names.
    pub theirs: Vec<f64>,
    /// Ours, in the same order.
    pub ours: Vec<f64>,
    /// Largest difference.
    pub difference: f64,
    /// What the difference is.
    pub kind: Kind,
    /// Largest difference that passes.
    pub tolerance: f64,
    /// Why the tolerance is what it is.
    pub bounded_by: Bound,
    /// The difference is within the tolerance.
    pub pass: bool,
}

/// What a difference is divided by.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Nothing: it has the unit of the quantity.
    Absolute,
    /// The size of their numbers.
    Relative,
}

/// What bounds a difference.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(into = "&'static str")]
pub enum Bound {
    /// Both are the same model; what is left is rounding, and no digit of it means anything.
    Rounding,
    /// Both are the same model, resolved by elements to a known error; below it, as with rounding.
    Elements,
    /// The digits that were printed, or the tolerance of the other program.
    Digits(&'static str),
    /// The models differ: what one of them leaves out.
    Model(&'static str),
    /// Whole numbers.
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

/// Every comparison.
///
/// # Errors
/// A reference file that cannot be read, or a robot of it without an equilibrium.
pub fn sections() -> Result<Vec<Section>> {
    let (published, independent) = (reference::published()?, reference::independent()?);
    Ok(vec![
        catenary::section(&published)?,
        robots::section(&published)?,
        independent::section(&independent)?,
        exact::section(&published, &reference::exact()?, &independent)?,
        damped::section(&reference::damped()?, &independent)?,
        dynamics::section(&published),
        cube::section(&published)?,
        paper::section(&published)?,
    ])
}

/// Where rows of one case get their case and source.
struct Case<'a> {
    name: String,
    source: &'a str,
}

impl Case<'_> {
    /// Largest absolute difference of numbers.
    fn absolute(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Row {
        let difference = largest_difference(theirs, ours);
        self.row(quantity, (theirs, ours), (difference, Kind::Absolute), tolerance, bound)
    }

    /// Largest relative difference of numbers, each over its own size.
    fn relative(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Row {
        let difference = worst(theirs.iter().zip(ours).map(|(a, b)| over((a - b).abs(), a.abs())));
        self.row(quantity, (theirs, ours), (difference, Kind::Relative), tolerance, bound)
    }

    /// Largest difference of numbers over the largest of theirs.
    fn together(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Row {
        let difference = over(largest_difference(theirs, ours), largest(theirs));
        self.row(quantity, (theirs, ours), (difference, Kind::Relative), tolerance, bound)
    }

    /// Numbers of things.
    fn count(&self, quantity: &str, theirs: usize, ours: usize) -> Row {
        self.absolute(quantity, &[theirs as f64], &[ours as f64], 0.0, Bound::Count)
    }

    /// A row whose difference was found otherwise, `shown` (theirs, ours) standing for many numbers.
    fn row(
        &self,
        quantity: &str,
        shown: (&[f64], &[f64]),
        (difference, kind): (f64, Kind),
        tolerance: f64,
        bounded_by: Bound,
    ) -> Row {
        Row {
            case: self.name.clone(),
            source: self.source.to_owned(),
            quantity: quantity.to_owned(),
            theirs: shown.0.to_vec(),
            ours: shown.1.to_vec(),
            difference,
            kind,
            tolerance,
            bounded_by,
            // A difference that is not a number is none to pass.
            pass: shown.0.len() == shown.1.len() && difference <= tolerance,
        }
    }
}

/// A quotient that is zero for nothing over nothing.
fn over(difference: f64, size: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / size }
}

/// The largest; NaN if one is not a number.
fn worst(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |most, d| if d > most || d.is_nan() { d } else { most })
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

fn largest(values: &[f64]) -> f64 {
    worst(values.iter().map(|value| value.abs()))
}
