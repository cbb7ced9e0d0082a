//! The core's errors as the exceptions of `funicular`, with the same texts.

use funicular::cable_motion::CableMotionError;
use funicular::dynamics::DynamicsError;
use funicular::modes::TooMany;
use funicular::ports::{PlaceError, PortError};
use funicular::response::ResponseError;
use funicular::robot::spec::SpecError;
use funicular::statics::StaticsError;
use funicular_files::FilesError;
use pyo3::PyErr;

/// The exceptions, which are written in Python so that they have types, pickle and can be caught by any base.
mod python {
    pyo3::import_exception!(funicular._errors, DynamicsError);
    pyo3::import_exception!(funicular._errors, FileError);
    pyo3::import_exception!(funicular._errors, InputError);
    pyo3::import_exception!(funicular._errors, ResponseError);
    pyo3::import_exception!(funicular._errors, RobotFileError);
    pyo3::import_exception!(funicular._errors, StaticsError);
}

/// An argument that has to change.
pub(crate) fn input(text: String) -> PyErr {
    python::InputError::new_err(text)
}

/// A robot file that cannot be used: its lines, and carets under what is wrong.
pub(crate) fn robot_file(error: &SpecError, name: &str, text: &str) -> PyErr {
    let issues: Vec<(usize, usize, String, Option<String>)> = error
        .issues()
        .iter()
        .map(|issue| (issue.line, issue.column, issue.message.clone(), issue.help.clone()))
        .collect();
    python::RobotFileError::new_err((error.render(name, text, false), issues))
}

/// A change of a robot file that cannot be made.
pub(crate) fn change(text: String) -> PyErr {
    python::RobotFileError::new_err((text, Vec::<(usize, usize, String, Option<String>)>::new()))
}

/// What the program's texts advise, and how Python says it.
const ADVICE: [(&str, &str); 3] = [
    ("--resume", "`resume=True`"),
    ("--discard", "`force=True`"),
    ("`--format csv` without a file writes to standard output", "leave out `file` for rows in memory"),
];

/// A file of a sweep that cannot be read or written; what to do in the words of Python.
pub(crate) fn files(error: &FilesError) -> PyErr {
    let text = ADVICE.iter().fold(error.to_string(), |text, (program, python)| text.replace(program, python));
    python::FileError::new_err(text)
}

pub(crate) fn statics(error: &StaticsError) -> PyErr {
    python::StaticsError::new_err((error.to_string(), error.code()))
}

pub(crate) fn dynamics(error: &DynamicsError) -> PyErr {
    python::DynamicsError::new_err(error.to_string())
}

pub(crate) fn response(error: &ResponseError) -> PyErr {
    python::ResponseError::new_err(error.to_string())
}

pub(crate) fn port(error: &PortError) -> PyErr {
    input(error.to_string())
}

pub(crate) fn place(error: &PlaceError) -> PyErr {
    match error {
        PlaceError::Port(error) => port(error),
        PlaceError::Motion(error) => motion(error),
    }
}

fn motion(error: &CableMotionError) -> PyErr {
    python::DynamicsError::new_err(error.to_string())
}

pub(crate) fn too_many(error: &TooMany) -> PyErr {
    input(error.to_string())
}
