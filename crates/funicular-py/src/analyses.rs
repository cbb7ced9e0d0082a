//! `funicular.Analyses`: the methods that `Robot` and `Equilibrium` share, with their signatures in a file per
//! subject.

mod gradient;
mod reduced;
mod statics;
mod vibration;
mod written;

use crate::equilibrium::PyEquilibrium;
use crate::robot::PyRobot;
use funicular_study::request::{State, Tensions};
use pyo3::prelude::*;

/// Analyses of a robot at an equilibrium: the methods that `Equilibrium` and `Robot` share.
///
/// Those of `Robot` analyse the equilibrium in the state of the robot file, which every call computes again.
#[pyclass(frozen, subclass, name = "Analyses", module = "funicular")]
pub(crate) struct PyAnalyses;

impl PyAnalyses {
    /// Runs `analyse` on the equilibrium that a method is called on; for a robot on that of the state of its file.
    fn at<R>(slf: &Bound<'_, Self>, analyse: impl FnOnce(&PyEquilibrium) -> PyResult<R>) -> PyResult<R> {
        if let Ok(equilibrium) = slf.cast::<PyEquilibrium>() {
            return analyse(equilibrium.get());
        }
        let robot = slf.cast::<PyRobot>()?.clone().unbind();
        analyse(&PyEquilibrium::of(slf.py(), robot, State::default(), Tensions::default())?)
    }
}
