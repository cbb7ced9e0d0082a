//! Comparisons of the core with numbers that others published or computed: the rows of docs/validation.md.
//!
//! The numbers are in crates/funicular-validation/reference, each table with its source. They are compared only here:
//! the core's own tests use limits, identities and other algorithms. There is one file per section, which declares its
//! comparisons and its negative controls; a test runs each.

mod catenary;
mod centres;
mod comparison;
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
mod section;
mod shapes;
mod simulations;
mod stretch_loss;
mod strings;
mod summary;
mod sway;
#[cfg(test)]
mod tests;
mod trajectories;
mod uncertainty;
mod verdict;
mod workspaces;
mod wrong_references;

pub use comparison::{Bound, Comparison, DifferenceKind};
pub use markdown::markdown;
pub use section::{ControlRun, Section};
pub use summary::{badge, junit};
pub use verdict::{LevelCount, Validated, run, schema, tables};

use comparison::{Case, ComparedQuantity, largest, largest_difference, over, slug, worst};
use funicular_study::names::ValidationLevel as Level;
use section::{Declared, NegativeControl};

/// Sections in the order of docs/validation.md.
static SECTIONS: [Declared; 22] = [
    catenary::SECTION,
    robots::SECTION,
    independent::SECTION,
    exact::SECTION,
    damped::SECTION,
    stretch_loss::SECTION,
    sway::SECTION,
    driven::SECTION,
    gradients::SECTION,
    measured::SECTION,
    identification::SECTION,
    dynamics::SECTION,
    strings::SECTION,
    cube::SECTION,
    paper::SECTION,
    uncertainty::SECTION,
    load_factors::SECTION,
    distances::SECTION,
    trajectories::SECTION,
    workspaces::SECTION,
    simulations::SECTION,
    centres::SECTION,
];

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
