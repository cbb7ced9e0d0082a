//! Poles of measured time histories: frequencies, damping ratios and shapes with their covariance. Knows no robot.
//!
//! A free decay is fitted by damped sinusoids with variable projection ([`decay`]), a record under unknown broad-band
//! excitation by its covariances ([`ambient`]). docs/theory.md, section 18g, has the equations.

pub mod ambient;
pub mod decay;
mod fitting;
mod poles;
pub mod quality;
mod realisation;

pub use poles::{IdentifiedPole, PoleSet, Samples, SamplesError, mac};
