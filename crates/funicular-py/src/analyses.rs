//! `funicular.Analyses`: the methods that `Robot` and `Equilibrium` share, with their signatures in a file per
//! subject.

mod at_rest;
mod gradient;
mod reduced;
mod statics;
mod vibration;
mod written;

use pyo3::prelude::*;

/// Analyses of a robot at an equilibrium: the methods that `Equilibrium` and `Robot` share.
///
/// Those of `Robot` analyse the equilibrium in the state of the robot file, which every call computes again.
#[pyclass(frozen, subclass, weakref, name = "Analyses", module = "funicular")]
pub(crate) struct PyAnalyses;
