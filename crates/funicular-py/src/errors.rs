//! Exceptions of `funicular` for the errors of the other crates. A message names an option as a keyword of Python.

use funicular::cable_motion::CableMotionError;
use funicular::dynamics::DynamicsError;
use funicular::reduced_model::ReductionError;
use funicular::response::ResponseError;
use funicular::simulation::StepError;
use funicular::statics::StaticsError;
use funicular_files::FilesError;
use funicular_study::robot_file::Refused;
use funicular_study::set_values::EditError;
use funicular_study::wording::{Words, message, told};
use funicular_study::{Error, NoSolution};
use pyo3::prelude::*;
use std::ffi::CString;

/// Exceptions, which are written in Python: they have types, pickle, and can have several bases.
mod python {
    pyo3::import_exception!(funicular._errors, DynamicsError);
    pyo3::import_exception!(funicular._errors, FileError);
    pyo3::import_exception!(funicular._errors, InputError);
    pyo3::import_exception!(funicular._errors, NoSolutionError);
    pyo3::import_exception!(funicular._errors, ResponseError);
    pyo3::import_exception!(funicular._errors, RobotFileError);
    pyo3::import_exception!(funicular._errors, StaticsError);
}

/// Line, column, message and help of one error in a robot file.
type Issue = (usize, usize, String, Option<String>);

/// Exception for a wrong argument.
pub(crate) fn input(text: String) -> PyErr {
    python::InputError::new_err(text)
}

/// Exception for a change of a robot file that cannot be made.
pub(crate) fn change(text: String) -> PyErr {
    python::RobotFileError::new_err((text, Vec::<Issue>::new()))
}

/// Exception for an error of the study, chosen by its cause.
pub(crate) fn study(error: &anyhow::Error) -> PyErr {
    let cause = error.downcast_ref::<Error>().map_or(error, Error::cause);
    let text = || message(cause, Words::Python);
    if let Some(error) = cause.downcast_ref::<StaticsError>() {
        return python::StaticsError::new_err((text(), error.code()));
    }
    if let Some(refused) = cause.downcast_ref::<Refused>() {
        return robot_file(refused);
    }
    if cause.is::<EditError>() {
        return change(text());
    }
    if cause.is::<DynamicsError>() || cause.is::<CableMotionError>() {
        return python::DynamicsError::new_err(text());
    }
    if cause.is::<ResponseError>() {
        return python::ResponseError::new_err(text());
    }
    if cause.is::<NoSolution>() || cause.downcast_ref().is_some_and(ReductionError::is_no_solution) {
        return python::NoSolutionError::new_err(text());
    }
    input(text())
}

/// Exception for a robot file that cannot be used, with its lines and carets under the errors.
fn robot_file(refused: &Refused) -> PyErr {
    let Refused { name, text, error } = refused;
    let issues: Vec<Issue> = (error.issues().iter())
        .map(|issue| (issue.line, issue.column, issue.message.clone(), issue.help.clone()))
        .collect();
    python::RobotFileError::new_err((error.render(name, text, false), issues))
}

/// Exception for a file of a sweep that cannot be read or written.
pub(crate) fn files(error: &FilesError) -> PyErr {
    python::FileError::new_err(told(&error.to_string(), Words::Python))
}

/// Exception for a file of a command that cannot be written or made.
pub(crate) fn of_file(error: &anyhow::Error) -> PyErr {
    if error.is::<FilesError>() || error.is::<std::io::Error>() {
        return unwritable(message(error, Words::Python));
    }
    study(error)
}

/// Exception for a file that cannot be written.
pub(crate) fn unwritable(text: String) -> PyErr {
    python::FileError::new_err(text)
}

/// Exception for a simulation in intervals that does not take an input, or cannot follow a motion.
pub(crate) fn step(error: &StepError) -> PyErr {
    let text = told(&error.to_string(), Words::Python);
    if matches!(error, StepError::Failed(_)) { python::NoSolutionError::new_err(text) } else { input(text) }
}

pub(crate) fn response(error: &ResponseError) -> PyErr {
    python::ResponseError::new_err(error.to_string())
}

/// Returns a message in which text of the user can neither act on a terminal nor fill it, as all exceptions have it.
#[pyfunction]
pub(crate) fn shown(message: &str) -> String {
    funicular::suggest::shown(message)
}

/// Shows a warning of the class `class` at a line of the user: that of the Python function that called Rust for
/// `level` 1, that of its caller for 2. Methods are called by a function of `_hints.py`.
pub(crate) fn warn(py: Python<'_>, class: &str, text: &str, level: i32) -> PyResult<()> {
    let class = py.import("funicular._errors")?.getattr(class)?;
    let text = CString::new(told(text, Words::Python)).map_err(|error| input(error.to_string()))?;
    PyErr::warn(py, &class, &text, level)
}
