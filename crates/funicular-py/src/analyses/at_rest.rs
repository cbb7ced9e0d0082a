//! The equilibrium that the shared methods analyse.

use super::PyAnalyses;
use crate::equilibrium::PyEquilibrium;
use crate::robot::PyRobot;
use funicular_study::request::{State, Tensions};
use pyo3::prelude::*;

impl PyAnalyses {
    /// Runs `analyse` on the equilibrium that a method is called on; for a robot on that of the state of its file.
    pub(super) fn at<R>(slf: &Bound<'_, Self>, analyse: impl FnOnce(&PyEquilibrium) -> PyResult<R>) -> PyResult<R> {
        if let Ok(equilibrium) = slf.cast::<PyEquilibrium>() {
            return analyse(equilibrium.get());
        }
        let robot = slf.cast::<PyRobot>()?.clone().unbind();
        analyse(&PyEquilibrium::of(slf.py(), robot, State::default(), Tensions::default())?)
    }
}
