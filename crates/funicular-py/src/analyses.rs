//! `funicular.Analyses`: the analyses that `Robot` and `Equilibrium` share.
//!
//! The methods for users are declared in `_equilibrium_methods.py`, which calls those of this file whose names begin
//! with `_`; their `given` has the keywords of the command.

use crate::answered::PyAnswered;
use crate::answers;
use crate::arrays::{Numbers, ResultsObject, Tensor, TextKeyed};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::{interruptible, interruptible_in_steps};
use crate::request::Keywords;
use crate::robot::PyRobot;
use crate::vibration::{self, Responses};
use crate::written;
use funicular_pages::pages;
use funicular_study::analyses;
use funicular_study::analyses::statics::Extras;
use funicular_study::request::{Request, State, Tensions};
use funicular_study::run_at;
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// Analyses of a robot at an equilibrium: the methods that `Equilibrium` and `Robot` share.
///
/// Those of `Robot` analyse the equilibrium in the state of the robot file, which every call computes again.
#[pyclass(frozen, subclass, weakref, name = "Analyses", module = "funicular")]
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

/// Runs `$analyse` on equilibrium `$rest` and the request `$request` of a command, made from the keywords.
macro_rules! about {
    ($slf:ident, $Command:ident $name:literal, $given:ident, |$rest:ident, $request:ident| $analyse:expr) => {{
        let keywords = Keywords::read($name, $given, &[])?;
        Self::at($slf, |$rest| {
            let Request::$Command($request) = $rest.request(keywords)? else {
                unreachable!("the request is of {}", $name)
            };
            $analyse
        })
    }};
}

#[pymethods]
impl PyAnalyses {
    /// Results of a command, with the keys of the program's JSON.
    #[pyo3(name = "_results")]
    fn results(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        command: &str,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<PyAnswered> {
        let keywords = Keywords::read(command, given, &[])?;
        Self::at(slf, |rest| {
            let request = rest.request(keywords)?;
            let (asked, at_rest) = (request.clone(), Arc::clone(&rest.at_rest));
            let found = interruptible_in_steps(py, move |watch| run_at(&request, &at_rest, watch))?;
            Ok(PyAnswered::new(asked, found.map_err(|error| errors::study(&error))?))
        })
    }

    #[pyo3(name = "_modes")]
    fn modes<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        given: &Bound<'py, PyDict>,
    ) -> PyResult<(TextKeyed<'py>, Option<String>)> {
        about!(slf, Modes "modes", given, |rest, request| vibration::modes(py, rest, request))
    }

    #[pyo3(name = "_stiffness")]
    fn stiffness(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        at_hz: Option<Numbers>,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<vibration::Stiffness> {
        let model = Keywords::read("stiffness", given, &[])?.part()?;
        Self::at(slf, |rest| vibration::stiffness(py, rest, at_hz, model))
    }

    #[pyo3(name = "_frf")]
    fn frf(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        hz: Option<Numbers>,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Responses> {
        let request = Keywords::read("frf", given, &[])?.part()?;
        Self::at(slf, |rest| vibration::frf(py, rest, hz, &request))
    }

    #[pyo3(name = "_receptance")]
    fn receptance(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        hz: Numbers,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Tensor<Complex64>> {
        let model = Keywords::read("frf", given, &[])?.part()?;
        Self::at(slf, |rest| vibration::receptance(py, rest, hz, model))
    }

    #[pyo3(name = "_cable")]
    fn cable<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        name: String,
        hz: Numbers,
        given: &Bound<'py, PyDict>,
    ) -> PyResult<ResultsObject<'py>> {
        let request = Keywords::read("cable", given, &[])?.part()?;
        Self::at(slf, |rest| vibration::cable(py, rest, name, hz, &request))
    }

    /// Results of `reduce`, and the matrices of the model.
    #[pyo3(name = "_reduced")]
    fn reduced<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        given: &Bound<'py, PyDict>,
    ) -> PyResult<(TextKeyed<'py>, TextKeyed<'py>)> {
        about!(slf, Reduce "reduce", given, |rest, request| written::reduced(py, rest, request))
    }

    #[pyo3(name = "_export")]
    fn export(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: PathBuf,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Vec<String>> {
        about!(slf, Export "export", given, |rest, request| written::export(py, rest, path, request))
    }

    #[pyo3(name = "_write_frf")]
    fn write_frf(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: PathBuf,
        hz: Numbers,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Vec<String>> {
        let request = Keywords::read("frf", given, &[])?.part()?;
        Self::at(slf, |rest| written::write_frf(py, rest, path, hz, &request))
    }

    #[pyo3(name = "_write_modes")]
    fn write_modes(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: PathBuf,
        given: &Bound<'_, PyDict>,
    ) -> PyResult<Vec<String>> {
        about!(slf, Modes "modes", given, |rest, request| written::write_modes(py, rest, path, request))
    }

    /// Page in HTML on which the robot can be moved.
    #[pyo3(name = "_live")]
    fn live(slf: &Bound<'_, Self>, given: &Bound<'_, PyDict>) -> PyResult<String> {
        about!(slf, Live "live", given, |rest, request| pages::live::live(&request)
            .map_err(|error| errors::study(&error)))
    }

    /// Page in HTML about the equilibrium, and its caveats.
    #[pyo3(name = "_report")]
    fn report(slf: &Bound<'_, Self>, py: Python<'_>, given: &Bound<'_, PyDict>) -> PyResult<(String, Vec<String>)> {
        about!(slf, Report "report", given, |rest, request| written::report(py, rest, request))
    }

    /// Searches for all equilibria of the unstrained lengths of the equilibrium.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `equilibria` lists the solutions, the lowest first, each with `pose`, `stable`,
    /// `energy_j`, `distance_m` and `tensions_platform_n`; `search` describes the search. Lists of numbers are arrays.
    fn all_equilibria<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let found =
            interruptible(py, move || analyses::statics::about(&at_rest, Extras { all: true, ..Extras::default() }))?;
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Computes the interval in which friction of pulleys leaves pose and tensions.
    ///
    /// Every cable may have run last towards the platform or towards its drum. If the lengths are given or held, pose
    /// and tensions vary; if the pose is given, the tensions at the drums and the lengths vary.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `friction_interval` has `held`, which is `lengths` or `pose`; with lengths held
    /// `translation_m` (3, 2) and `rotation_deg` (3, 2), the rotation vector, both in world axes; and `cables`, each
    /// with `friction_exponent`, `excess_length_m`, `tension_platform_n`, `tension_anchor_n` and `tension_drum_n`.
    /// Pairs are minimum and maximum. Theory (71) to (74).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     No cable runs over a pulley with friction.
    /// NoSolutionError
    ///     The equilibrium is indifferent.
    fn friction_interval<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let extras = Extras { friction_interval: true, ..Extras::default() };
        let found = py.detach(|| analyses::statics::about(&at_rest, extras));
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }
}
