//! Comparisons of the core with numbers that others published or computed: the rows of docs/validation.md.
//!
//! The numbers are in crates/funicular-validation/reference, each table with its source. They are compared only here:
//! the core's own tests use limits, identities and other algorithms. There is one file per section, with a test.

mod catenary;
mod centres;
mod cube;
mod damped;
mod distances;
mod driven;
mod drives;
mod dynamics;
mod exact;
mod gradients;
mod identification;
mod independent;
mod load_factors;
mod markdown;
mod measured;
mod paper;
mod reference;
mod robots;
mod shapes;
mod simulations;
mod stretch_loss;
mod sway;
#[cfg(test)]
mod tests;
mod trajectories;
mod uncertainty;
mod verdict;
mod workspaces;

pub use markdown::markdown;
pub use verdict::{Validated, run, schema, tables};

use anyhow::Result;
use serde::Serialize;

/// Section of docs/validation.md: comparisons that belong together.
#[derive(Serialize)]
pub struct Section {
    /// Title.
    pub title: &'static str,
    /// Description of the comparisons and of the differences to expect.
    pub note: &'static str,
    /// Comparisons.
    pub rows: Vec<Comparison>,
}

/// Comparison of numbers of the program with reference numbers.
#[derive(Serialize)]
pub struct Comparison {
    /// Case: the robot or cable, and its state.
    pub case: String,
    /// Source of the reference numbers.
    pub source: String,
    /// Compared quantity, with its unit.
    pub quantity: String,
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
    fn name(self) -> &'static str {
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

/// Makes all comparisons, in sections.
///
/// # Errors
/// A reference file that cannot be read, or a robot in it without an equilibrium.
pub fn sections() -> Result<Vec<Section>> {
    let (published, independent) = (reference::published()?, reference::independent()?);
    let of_drives = reference::drives()?;
    Ok(vec![
        catenary::section(&published)?,
        robots::section(&published)?,
        independent::section(&independent)?,
        exact::section(&published, &reference::exact()?, &independent)?,
        damped::section(&reference::damped()?, &independent)?,
        stretch_loss::section(&reference::stretch_loss()?)?,
        sway::section(&reference::sway()?)?,
        drives::section(&of_drives, driven::comparisons(&of_drives)?)?,
        gradients::section(&reference::gradients()?)?,
        measured::section(&reference::measured()?.grab)?,
        identification::section(&reference::identification()?, &reference::measured()?.grab)?,
        dynamics::section(&published),
        cube::section(&published)?,
        paper::section(&published)?,
        uncertainty::section()?,
        load_factors::section(&reference::load_factors()?)?,
        distances::section(&reference::distances()?)?,
        trajectories::section(&reference::trajectories()?)?,
        workspaces::section(&reference::workspaces()?)?,
        simulations::section(&reference::histories()?)?,
        centres::section(&reference::centres()?)?,
    ])
}

/// Case and source that several comparisons share.
struct Case<'a> {
    name: String,
    source: &'a str,
}

impl Case<'_> {
    /// Comparison by the maximum absolute difference.
    fn absolute(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = largest_difference(theirs, ours);
        self.row(quantity, (theirs, ours), (difference, DifferenceKind::Absolute), tolerance, bound)
    }

    /// Comparison by the maximum relative difference, each relative to its own reference number.
    fn relative(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = worst(theirs.iter().zip(ours).map(|(a, b)| over((a - b).abs(), a.abs())));
        self.row(quantity, (theirs, ours), (difference, DifferenceKind::Relative), tolerance, bound)
    }

    /// Comparison by the maximum difference, relative to the largest reference number.
    fn together(&self, quantity: &str, theirs: &[f64], ours: &[f64], tolerance: f64, bound: Bound) -> Comparison {
        let difference = over(largest_difference(theirs, ours), largest(theirs));
        self.row(quantity, (theirs, ours), (difference, DifferenceKind::Relative), tolerance, bound)
    }

    /// Comparison of two counts.
    fn count(&self, quantity: &str, theirs: usize, ours: usize) -> Comparison {
        self.absolute(quantity, &[theirs as f64], &[ours as f64], 0.0, Bound::Count)
    }

    /// Comparison with a given difference of many numbers, of which only `shown` (theirs, ours) is printed.
    fn row(
        &self,
        quantity: &str,
        shown: (&[f64], &[f64]),
        (difference, kind): (f64, DifferenceKind),
        tolerance: f64,
        bounded_by: Bound,
    ) -> Comparison {
        Comparison {
            case: self.name.clone(),
            source: self.source.to_owned(),
            quantity: quantity.to_owned(),
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

/// Quotient, with 0/0 = 0.
fn over(difference: f64, size: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / size }
}

/// Maximum difference; NaN if one of them is NaN.
fn worst(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |max, d| if d > max || d.is_nan() { d } else { max })
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

fn largest(values: &[f64]) -> f64 {
    worst(values.iter().map(|value| value.abs()))
}

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
