//! Output of an equilibrium for other programs and people: a model for control design, a file, a page.

use crate::answers::{self, CtrlC, in_words};
use crate::arrays::{Matrix, Numbers, TextKeyed};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::{interruptible, interruptible_in_steps};
use crate::request::joined;
use crate::vibration::{PROMINENCE_DB, pairs};
use funicular::math::DMat;
use funicular::reduced_model::StateSpace;
use funicular::robot::Robot;
use funicular_answers::document;
use funicular_files::endings::{self, Kind};
use funicular_files::mat::{self, Value, Variable};
use funicular_formats::export;
use funicular_formats::fmu::{self, UnitModel};
use funicular_formats::uff_writing::{frf_file, modes_file};
use funicular_pages::pages::report;
use funicular_pages::pages::summary::Summary;
use funicular_study::Silent;
use funicular_study::analyses;
use funicular_study::analyses::frf;
use funicular_study::analyses::reduce::{Reduced, ReducedForm};
use funicular_study::request::{ExportRequest, FrfRequest, ModesRequest, ReduceRequest, ReportRequest};
use funicular_study::wording::{Words, worded};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Model for control design with the keys of the program's JSON, and its matrices.
pub(crate) fn reduced<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    request: ReduceRequest,
) -> PyResult<(TextKeyed<'py>, TextKeyed<'py>)> {
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible_in_steps(py, move |watch| analyses::reduce::about(&at_rest, &request, watch))?;
    let found = found.map_err(|error| errors::study(&error))?;

    let matrices = PyDict::new(py);
    match &found {
        ReducedForm::StateSpace(of) => {
            let space = &of.model.space;
            for (name, matrix) in [("A", &space.a), ("B", &space.b), ("C", &space.c), ("D", &space.d)] {
                matrices.set_item(name, array(matrix))?;
            }
        }
        ReducedForm::SecondOrder(of) => second_order(py, of, &matrices)?,
    }
    Ok((answers::plain(py, &found)?, TextKeyed(matrices)))
}

/// Adds the matrices of the second-order form.
fn second_order(py: Python<'_>, of: &Reduced, matrices: &Bound<'_, PyDict>) -> PyResult<()> {
    let (second, space) = (&of.model, of.model.state_space().ok());
    for (name, matrix) in [
        ("mass", &second.mass),
        ("damping", &second.damping),
        ("stiffness", &second.stiffness),
        ("input", &second.input),
        ("output", &second.output),
    ] {
        matrices.set_item(name, array(matrix))?;
    }
    for (name, all) in [
        ("input_rates", &second.input_rates[..]),
        ("output_rates", &second.output_rates[..]),
        ("feedthrough", &second.feedthrough[..]),
    ] {
        matrices.set_item(name, PyTuple::new(py, all.iter().map(array))?)?;
    }
    let of_space = |of: fn(&StateSpace) -> &DMat| space.as_ref().map(|space| array(of(space)));
    matrices.set_item("a", of_space(|space| &space.a))?;
    matrices.set_item("b", of_space(|space| &space.b))?;
    matrices.set_item("c", of_space(|space| &space.c))?;
    matrices.set_item("d", of_space(|space| &space.d))
}

fn array(matrix: &DMat) -> Matrix {
    Matrix::of_rows(matrix.transpose().iter().copied().collect(), matrix.ncols())
}

/// Makes the bytes of a file of MATLAB from matrices (name, number of rows, entries by columns) and columns of texts.
#[pyfunction]
pub(crate) fn matlab_file(
    py: Python<'_>,
    matrices: Vec<(String, usize, Vec<f64>)>,
    texts: Vec<(String, Vec<String>)>,
) -> PyResult<Bound<'_, PyBytes>> {
    let of_matrices =
        matrices.iter().map(|(name, rows, entries)| Variable { name, value: Value::Matrix(*rows, entries) });
    let of_texts = texts
        .iter()
        .map(|(name, column)| Variable { name, value: Value::Texts(column.iter().map(String::as_str).collect()) });
    let all: Vec<Variable> = of_matrices.chain(of_texts).collect();
    let bytes = mat::bytes(&all).ok_or_else(|| {
        errors::input("the matrices are too large for a file of MATLAB: write an .npz file".to_owned())
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// Writes a state space of the robot of a file as a Functional Mock-up Unit, and returns the caveats. `limits` are the
/// highest frequency [Hz] and the error, `signals` names and units of inputs and outputs, `matrices` A, B, C, D with
/// their numbers of rows and entries by columns.
#[pyfunction]
pub(crate) fn write_unit(
    py: Python<'_>,
    path: PathBuf,
    limits: (f64, f64),
    signals: [Vec<(String, String)>; 2],
    matrices: [(usize, Vec<f64>); 4],
    robot_file: &str,
    description: &str,
) -> PyResult<Vec<String>> {
    let robot = Robot::from_toml(robot_file).map_err(|error| errors::input(error.to_string()))?.name;
    let [a, b, c, d] = matrices.map(|(rows, entries)| DMat::from_vec(rows, entries.len() / rows.max(1), entries));
    let (space, (below_hz, error), [inputs, outputs]) = (StateSpace { a, b, c, d }, limits, signals);

    let packed = py.detach(|| -> anyhow::Result<_> {
        let unit = UnitModel { robot: &robot, below_hz, error, inputs, outputs, space: &space };
        let texts = fmu::texts(&unit)?;
        let resources = [("robot.toml", robot_file.as_bytes()), ("description.json", description.as_bytes())];
        let (bytes, not_compiled) =
            funicular_files::fmu::pack(fmu::IDENTIFIER, &texts.description, &texts.source, &resources)?;
        Ok((bytes, [texts.warnings, not_compiled.into_iter().collect()].concat()))
    });
    let (bytes, caveats) = packed.map_err(|error| errors::study(&error))?;
    answers::write_bytes(path, &bytes)?;
    Ok(in_words(&caveats))
}

/// Writes an equilibrium as a file of another program.
pub(crate) fn export(
    py: Python<'_>,
    of: &PyEquilibrium,
    path: PathBuf,
    request: ExportRequest,
) -> PyResult<Vec<String>> {
    answers::try_file(path.clone())?;
    if request.to.is_unit() {
        let made = interruptible(py, move || document::unit(&request))?;
        let (bytes, warnings) = made.map_err(|error| errors::study(&error))?;
        answers::write_bytes(path, &bytes)?;
        return Ok(in_words(&warnings));
    }
    let at_rest = Arc::clone(&of.at_rest);
    let exported = interruptible(py, move || {
        export::refuse(&request)?;
        export::run(&at_rest, &request)
    })?;
    let exported = exported.map_err(|error| errors::study(&error))?;
    answers::write_file(path, &worded(&exported.text, Words::Python))?;
    Ok(in_words(&exported.warnings))
}

/// Refuses a name whose ending means another kind of file than a Universal File.
fn refuse_other_ending(path: &Path) -> PyResult<()> {
    endings::check(path, "a Universal File", &[Kind::Uff]).map_err(|error| errors::files(&error))
}

/// Writes the responses of a request at the frequencies `hz` as a Universal File.
pub(crate) fn write_frf(
    py: Python<'_>,
    rest: &PyEquilibrium,
    path: PathBuf,
    hz: Numbers,
    of: &FrfRequest,
) -> PyResult<Vec<String>> {
    refuse_other_ending(&path)?;
    answers::try_file(path.clone())?;
    let (frequencies, _) = hz.frequencies()?;

    let (warnings, bytes) = py.detach(|| {
        let mut watch = CtrlC::new();
        let found = frf::about(&rest.at_rest, &pairs(of), frequencies, of.adaptive, PROMINENCE_DB, &mut watch);
        let found = watch.result(found)?;
        let bytes = frf_file(&found).map_err(|error| errors::study(&error))?;
        Ok::<_, PyErr>((found.warnings, bytes))
    })?;
    answers::write_bytes(path, &bytes)?;
    Ok(in_words(&warnings))
}

/// Writes mode shapes as a Universal File.
pub(crate) fn write_modes(
    py: Python<'_>,
    of: &PyEquilibrium,
    path: PathBuf,
    request: ModesRequest,
) -> PyResult<Vec<String>> {
    refuse_other_ending(&path)?;
    answers::try_file(path.clone())?;
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::modes::about(&at_rest, &request))?;
    let found = found.map_err(|error| errors::study(&error))?;
    answers::write_bytes(path, &modes_file(&found))?;
    Ok(in_words(&found.warnings))
}

/// Page about an equilibrium and its vibration, with its caveats.
pub(crate) fn report(py: Python<'_>, of: &PyEquilibrium, request: ReportRequest) -> PyResult<(String, Vec<String>)> {
    let call = py.import("funicular._pages")?.getattr("report_call")?;
    let call: String = call.call1((joined(&of.state, &of.tensions)?, keys_of(&request)?))?.extract()?;

    if request.summary {
        let robot = of.of.get().source.clone();
        let request = ReportRequest { robot, state: of.state.clone(), tensions: of.tensions.clone(), ..request };
        let made = interruptible(py, move || {
            let made = Summary::of_request(
                &request,
                &request.robot.read()?,
                (&call, Words::Python),
                &mut Silent,
                &funicular_answers::outputs::clock(),
            )?;
            Ok((made.html()?, made.warnings))
        })?;
        let (html, warnings) = made.map_err(|error: anyhow::Error| errors::study(&error))?;
        return Ok((html, in_words(&warnings)));
    }
    let (at_rest, text) = (Arc::clone(&of.at_rest), of.of.get().text.clone());
    let page = interruptible(py, move || report::about(&at_rest, &request, &request.robot.name, &text, call))?;
    let page = page.map_err(|error| errors::study(&error))?;
    Ok((worded(&page.html, Words::Python), in_words(&page.warnings)))
}

/// Keys of a request that are given, as JSON.
fn keys_of(request: &ReportRequest) -> PyResult<String> {
    let keys = funicular_study::request::keys_of(request).map_err(|error| errors::input(error.to_string()))?;
    Ok(serde_json::Value::Object(keys).to_string())
}
