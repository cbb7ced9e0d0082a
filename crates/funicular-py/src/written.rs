//! Output of an equilibrium for other programs and people: a model for control design, a file, a page.

use crate::answers::{self, CtrlC, in_words};
use crate::arrays::{Count, Matrix, Number, Numbers};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::{interruptible, interruptible_in_steps};
use crate::request::{joined, model, named, points, share};
use crate::texts::{Texts, not_empty};
use crate::vibration::{ModesKeywords, PROMINENCE_DB, PairKeywords};
use funicular::math::DMat;
use funicular::reduced_model::StateSpace;
use funicular_files::endings::{self, Kind};
use funicular_files::mat::{self, Value, Variable};
use funicular_study::analyses;
use funicular_study::analyses::frf;
use funicular_study::analyses::reduce::MAX_ORDER;
use funicular_study::export::{self, MAX_SEGMENTS};
use funicular_study::names::ModelForm;
use funicular_study::pages::{self, report};
use funicular_study::request;
use funicular_study::uff_writing::{frf_file, modes_file};
use funicular_study::wording::{Words, worded};
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::Arc;

macro_rules! object {
    ($name:ident, $module:literal, $class:literal) => {
        #[doc = concat!("`", $module, ".", $class, "`.")]
        pub(crate) struct $name(pub(crate) Py<PyAny>);

        impl<'py> IntoPyObject<'py> for $name {
            type Target = PyAny;
            type Output = Bound<'py, PyAny>;
            type Error = Infallible;

            const OUTPUT_TYPE: PyStaticExpr =
                PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: $module }, attr: $class };

            fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
                Ok(self.0.into_bound(py))
            }
        }
    };
}

object!(ReducedObject, "funicular._results", "ReducedModel");
object!(StateSpaceObject, "funicular._results", "StateSpaceModel");
object!(PageObject, "funicular._pages", "Page");
object!(LiveObject, "funicular._live", "Live");
object!(IdentifiedObject, "funicular._identify", "Identified");
object!(DesignedObject, "funicular._design", "Designed");
object!(UncertaintyObject, "funicular._uncertainty", "Uncertainty");

/// Keywords of `reduce` and `state_space`.
pub(crate) struct ReduceKeywords<'a> {
    pub(crate) below_hz: Number,
    pub(crate) input: Option<Texts>,
    pub(crate) output: Option<Texts>,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    /// Number of states, of a state space only.
    pub(crate) order: Option<Count>,
    pub(crate) tolerance: Option<Number>,
    pub(crate) damping_at_hz: Option<Number>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
}

impl ReduceKeywords<'_> {
    fn request(self, of: &PyEquilibrium, form: ModelForm) -> PyResult<request::ReduceRequest> {
        let rule = format!("give a number of states from 2 to {MAX_ORDER}; a mode needs two");
        Ok(request::ReduceRequest {
            robot: of.of.get().source.clone(),
            below_hz: self.below_hz.value("below_hz")?,
            input: not_empty(self.input, "input")?.unwrap_or_default(),
            output: not_empty(self.output, "output")?.unwrap_or_default(),
            points: points(self.input_point_m, self.output_point_m)?,
            form,
            order: self.order.map(|order| order.within("order", 2..=MAX_ORDER, &rule)).transpose()?,
            tolerance: self.tolerance.map(|tolerance| tolerance.value("tolerance")).transpose()?,
            damping_at_hz: self.damping_at_hz.map(|hz| hz.value("damping_at_hz")).transpose()?,
            state: of.state.clone(),
            tensions: of.tensions.clone(),
            model: model(self.cable_model, self.assembly, self.in_plane_only, self.winches)?,
        })
    }
}

pub(crate) fn reduce(py: Python<'_>, of: &PyEquilibrium, keywords: ReduceKeywords<'_>) -> PyResult<ReducedObject> {
    let request = keywords.request(of, ModelForm::SecondOrder)?;
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible_in_steps(py, move |watch| analyses::reduce::about(&at_rest, &request, watch))?;
    let found = found.map_err(|error| errors::study(&error))?;

    let matrices = PyDict::new(py);
    let (second, space) = (&found.model, found.model.state_space().ok());
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
    matrices.set_item("d", of_space(|space| &space.d))?;
    let description = answers::plain(py, &found)?;
    let made = py.import("funicular._results")?.call_method1("reduced", (description.0, matrices))?;
    Ok(ReducedObject(made.unbind()))
}

pub(crate) fn state_space(
    py: Python<'_>,
    of: &PyEquilibrium,
    keywords: ReduceKeywords<'_>,
) -> PyResult<StateSpaceObject> {
    let request = keywords.request(of, ModelForm::StateSpace)?;
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible_in_steps(py, move |watch| analyses::control_model::about(&at_rest, &request, watch))?;
    let found = found.map_err(|error| errors::study(&error))?;

    let matrices = PyDict::new(py);
    let space = &found.model.space;
    for (name, matrix) in [("A", &space.a), ("B", &space.b), ("C", &space.c), ("D", &space.d)] {
        matrices.set_item(name, array(matrix))?;
    }
    let description = answers::plain(py, &found)?;
    let made = py.import("funicular._results")?.call_method1("state_space", (description.0, matrices))?;
    Ok(StateSpaceObject(made.unbind()))
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

fn array(matrix: &DMat) -> Matrix {
    Matrix::of_rows(matrix.transpose().iter().copied().collect(), matrix.ncols())
}

pub(crate) fn export(
    py: Python<'_>,
    of: &PyEquilibrium,
    to: &str,
    path: PathBuf,
    segments: Option<Count>,
    modes_below_hz: Option<Number>,
) -> PyResult<Vec<String>> {
    let rule = format!("give a whole number from 1 to {MAX_SEGMENTS}");
    let request = request::ExportRequest {
        robot: of.of.get().source.clone(),
        to: named("to", to)?,
        segments: segments.map_or(Ok(20), |count| count.within("segments", 1..=MAX_SEGMENTS, &rule))?,
        modes_below_hz: modes_below_hz.map(|hz| hz.value("modes_below_hz")).transpose()?,
        state: of.state.clone(),
        tensions: of.tensions.clone(),
    };
    let at_rest = Arc::clone(&of.at_rest);
    let exported = interruptible(py, move || export::run(&at_rest, &request))?;
    let exported = exported.map_err(|error| errors::study(&error))?;
    answers::write_file(path, &worded(&exported.text, Words::Python))?;
    Ok(in_words(&exported.warnings))
}

/// Refuses a name whose ending means another kind of file than a Universal File.
fn refuse_other_ending(path: &Path) -> PyResult<()> {
    endings::check(path, "a Universal File", &[Kind::Uff]).map_err(|error| errors::files(&error))
}

/// Writes frequency responses as a Universal File.
pub(crate) fn write_frf(
    py: Python<'_>,
    of: &PyEquilibrium,
    path: PathBuf,
    hz: Numbers,
    keywords: PairKeywords<'_>,
) -> PyResult<Vec<String>> {
    refuse_other_ending(&path)?;
    let (frequencies, _) = hz.frequencies()?;
    let adaptive = keywords.adaptive;
    let pairs = keywords.pairs()?;

    let (warnings, bytes) = py.detach(|| {
        let mut watch = CtrlC::new();
        let found = frf::about(&of.at_rest, &pairs.of_study(), frequencies, adaptive, PROMINENCE_DB, &mut watch);
        let found = found.map_err(|error| watch.or(&error))?;
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
    keywords: ModesKeywords<'_>,
) -> PyResult<Vec<String>> {
    refuse_other_ending(&path)?;
    let request = keywords.request(of)?;
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::modes::about(&at_rest, &request))?;
    let found = found.map_err(|error| errors::study(&error))?;
    answers::write_bytes(path, &modes_file(&found))?;
    Ok(in_words(&found.warnings))
}

/// Keywords of `report`.
pub(crate) struct PageKeywords<'a> {
    pub(crate) below_hz: Option<Number>,
    pub(crate) input: Option<String>,
    pub(crate) output: Option<String>,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
    pub(crate) platform_share: Option<Number>,
}

pub(crate) fn report(
    py: Python<'_>,
    of: &PyEquilibrium,
    path: Option<PathBuf>,
    keywords: PageKeywords<'_>,
) -> PyResult<PageObject> {
    let request = request::ReportRequest {
        robot: of.of.get().source.clone(),
        below_hz: keywords.below_hz.map_or(Ok(20.0), |below_hz| below_hz.value("below_hz"))?,
        input: keywords.input,
        output: keywords.output,
        points: points(keywords.input_point_m, keywords.output_point_m)?,
        platform_share: share(keywords.platform_share)?,
        state: of.state.clone(),
        tensions: of.tensions.clone(),
        model: model(keywords.cable_model, keywords.assembly, keywords.in_plane_only, keywords.winches)?,
    };

    let state = joined(&[&serde_json::to_value(&of.state), &serde_json::to_value(&of.tensions)])?;
    let all = joined(&[&serde_json::to_value(&request)])?;
    let pages = py.import("funicular._pages")?;
    let call: String = pages.call_method1("report_call", (state, all))?.extract()?;

    let (at_rest, text) = (Arc::clone(&of.at_rest), of.of.get().text.clone());
    let page = interruptible(py, move || report::about(&at_rest, &request, &request.robot.name, &text, call))?;
    let page = page.map_err(|error| errors::study(&error))?;
    let made = pages.call_method1("page", (worded(&page.html, Words::Python), in_words(&page.warnings), path))?;
    Ok(PageObject(made.unbind()))
}

/// Page on which the robot of an equilibrium can be moved.
pub(crate) fn live(
    py: Python<'_>,
    of: &PyEquilibrium,
    path: Option<PathBuf>,
    model: request::Model,
) -> PyResult<LiveObject> {
    let (robot, state, tensions) = (of.of.get().source.clone(), of.state.clone(), of.tensions.clone());
    let html = pages::live::live(&request::LiveRequest { robot, state, tensions, model });
    let html = html.map_err(|error| errors::study(&error))?;
    let made = py.import("funicular._live")?.call_method1("live", (html, path))?;
    Ok(LiveObject(made.unbind()))
}
