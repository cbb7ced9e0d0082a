//! Uncertainty of results: deviations of numbers of the robot file become deviations of results.
//!
//! The linear way uses the gradients of all results, and two tests decide where it holds: whether a cable may become
//! slack, and whether natural frequencies may cross. Where it does not hold, or where a result has no gradient, robots are
//! sampled (docs/theory.md, section "Uncertainty").
//!
//! The work comes in parts that do not depend on each other: poses, then chunks of sampled robots. A front end runs them
//! on its own threads and may keep the samples in a file, as those of a sweep.

mod distribution;
mod inputs;
mod linear;
mod results;
mod sampling;
mod statistics;

pub(crate) use inputs::{Distribution, Input, Inputs};
pub(crate) use linear::{LinearPose, Row};
pub(crate) use results::GROUPS;
pub(crate) use sampling::{SampleSet, SampleTable, Sampling};
pub(crate) use statistics::Statistics;
