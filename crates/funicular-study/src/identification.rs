//! Identification: the values of a robot file that fit measurements best, and how well the measurements determine them.
//!
//! docs/theory.md, section 18a, has the equations.

mod assignment;
mod chi2;
mod derivatives;
mod draws;
mod experiment;
mod lists;
mod model;
mod observations;
mod precision;
mod profile;
mod reading;
mod resolution;
mod ridge;
mod search;
mod starts;
mod unknowns;

pub(crate) use assignment::Assigning;
pub(crate) use model::IdentifiedModel;
pub(crate) use observations::{Observation, Subject};
pub(crate) use precision::judge;
pub(crate) use profile::LIMIT;
pub use profile::{OpenEnd, Profile};
pub(crate) use resolution::unresolved_peaks;
pub(crate) use ridge::{Profiled, profiles};
pub(crate) use search::search;
pub(crate) use starts::StartRow;
pub(crate) use unknowns::{Unknown, unknowns};
