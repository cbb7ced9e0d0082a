//! Stiffness, modes and responses of a robot at an equilibrium.

use crate::answers::{self, CtrlC};
use crate::arrays::{ComplexNumbers, Count, Matrix, Number, Numbers, OwnedArray, ResultsObject, Tensor, Vector};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::{interruptible, interruptible_in_steps};
use crate::reading::sizes;
use crate::request::{model, named, points, share, terms, three};
use crate::texts::{Texts, not_empty};
use funicular::compare::TOLERANCE;
use funicular::gradient::Hold;
use funicular::math::CMat6;
use funicular::modes::damped::DECAY_PERCENT;
use funicular::response;
use funicular_study::analyses::{self, cable, frf};
use funicular_study::at_rest;
use funicular_study::names::Per;
use funicular_study::request;
use numpy::Complex64;
use numpy::ndarray::{ArrayD, IxDyn};
use pyo3::inspect::{PyStaticExpr, PyStaticOperator};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::convert::Infallible;
use std::sync::Arc;

/// Number of frequencies between two checks for Ctrl-C: some 10 ms. It is a multiple of every number of lanes, so that
/// results do not depend on it.
const CHUNK: usize = 16_384;

fn highest(frequencies: &[f64]) -> f64 {
    frequencies.iter().copied().fold(0.0, f64::max)
}

/// One or many 6×6 matrices; real if nothing depends on frequency.
pub(crate) enum Stiffness {
    Static(Matrix),
    One(Matrix<Complex64>),
    Many(Tensor<Complex64>),
}

impl<'py> IntoPyObject<'py> for Stiffness {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr = PyStaticExpr::Subscript {
        value: &PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "numpy.typing" }, attr: "NDArray" },
        slice: &PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "typing" }, attr: "Any" },
    };

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(match self {
            Self::Static(matrix) => matrix.into_pyobject(py)?.into_any(),
            Self::One(matrix) => matrix.into_pyobject(py)?.into_any(),
            Self::Many(tensor) => tensor.into_pyobject(py)?.into_any(),
        })
    }
}

/// Elements of matrices by rows; `+ 0.0` turns a negative zero, whose sign has no meaning, into a positive zero.
fn flat(matrices: &[CMat6]) -> Vec<Complex64> {
    let mut rows = Vec::with_capacity(36 * matrices.len());
    for matrix in matrices {
        rows.extend(matrix.transpose().iter().map(|z| Complex64::new(z.re + 0.0, z.im + 0.0)));
    }
    rows
}

pub(crate) fn stiffness(
    py: Python<'_>,
    of: &PyEquilibrium,
    at_hz: Option<Numbers>,
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
    winches: &str,
) -> PyResult<Stiffness> {
    let (frequencies, one) = at_hz.map_or(Ok((vec![0.0], true)), |hz| hz.frequencies_of("at_hz"))?;
    let model = model(cable_model, assembly, in_plane_only, winches)?;
    let is_static = frequencies[..] == [0.0];
    let at_rest = Arc::clone(&of.at_rest);
    let matrices = interruptible_in_steps(py, move |watch| {
        analyses::stiffness::matrices(&at_rest, model, &frequencies, watch).map(|matrices| flat(&matrices))
    })?;
    let all = matrices.map_err(|error| errors::study(&error))?;
    Ok(match (one, is_static) {
        (true, true) => Stiffness::Static(Matrix::of_rows(all.iter().map(|z| z.re).collect(), 6)),
        (true, false) => Stiffness::One(Matrix::of_rows(all, 6)),
        (false, _) => Stiffness::Many(Tensor::of_rows(all, 6, 6)),
    })
}

/// `funicular.Modes`.
pub(crate) struct ModesObject(Py<PyAny>);

impl<'py> IntoPyObject<'py> for ModesObject {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = Infallible;

    const OUTPUT_TYPE: PyStaticExpr =
        PyStaticExpr::Attribute { value: &PyStaticExpr::Name { id: "funicular._results" }, attr: "Modes" };

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(self.0.into_bound(py))
    }
}

/// Keywords of `modes`.
pub(crate) struct ModesKeywords<'a> {
    pub(crate) below_hz: Option<Number>,
    pub(crate) input: Option<String>,
    pub(crate) output: Option<String>,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    pub(crate) stations: Option<Count>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
    pub(crate) platform_share: Option<Number>,
    pub(crate) decay_percent: Option<Number>,
    pub(crate) damped: bool,
    pub(crate) rigid_cables: bool,
}

/// Keywords of `compare`.
pub(crate) struct CompareKeywords<'a> {
    pub(crate) below_hz: Number,
    pub(crate) platform: bool,
    pub(crate) platform_share: Option<Number>,
    pub(crate) tolerance: Option<Number>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
}

/// Keywords of `gradient`.
pub(crate) struct GradientKeywords<'a> {
    pub(crate) of: Option<Texts>,
    pub(crate) by: Option<Texts>,
    pub(crate) hold: &'a str,
    pub(crate) per: &'a str,
    pub(crate) tolerances: Option<Bound<'a, PyAny>>,
    pub(crate) below_hz: Option<Number>,
    pub(crate) at_hz: Option<Number>,
    pub(crate) input: Option<String>,
    pub(crate) output: Option<String>,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
}

pub(crate) fn gradient<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    keywords: GradientKeywords<'_>,
) -> PyResult<ResultsObject<'py>> {
    let request = request::GradientRequest {
        robot: of.of.get().source.clone(),
        of: not_empty(keywords.of, "of")?.unwrap_or_else(request::frequencies),
        by: not_empty(keywords.by, "by")?.unwrap_or_default(),
        hold: named("hold", keywords.hold)?,
        per: named("per", keywords.per)?,
        tolerances: keywords.tolerances.map_or_else(|| Ok(Vec::new()), |given| sizes("tolerances", &given))?,
        below_hz: keywords.below_hz.map(|hz| hz.value("below_hz")).transpose()?,
        at_hz: keywords.at_hz.map(|hz| hz.not_negative("at_hz")).transpose()?,
        input: keywords.input,
        output: keywords.output,
        points: points(keywords.input_point_m, keywords.output_point_m)?,
        state: of.state.clone(),
        tensions: of.tensions.clone(),
        model: model(keywords.cable_model, keywords.assembly, keywords.in_plane_only, keywords.winches)?,
    };
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::gradient::about(&at_rest, &request))?;
    answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
}

impl ModesKeywords<'_> {
    pub(crate) fn request(self, of: &PyEquilibrium) -> PyResult<request::ModesRequest> {
        let stations = |count: Count| {
            let max = request::MAX_STATIONS;
            count.within("stations", 2..=max, &format!("give a whole number from 2 to {max}"))
        };
        Ok(request::ModesRequest {
            robot: of.of.get().source.clone(),
            below_hz: self.below_hz.map(|hz| hz.value("below_hz")).transpose()?,
            input: self.input,
            output: self.output,
            points: points(self.input_point_m, self.output_point_m)?,
            stations: self.stations.map(stations).transpose()?,
            platform_share: share(self.platform_share)?,
            decay_percent: self.decay_percent.map_or(Ok(DECAY_PERCENT), |percent| percent.value("decay_percent"))?,
            damped: self.damped,
            rigid_cables: self.rigid_cables,
            state: of.state.clone(),
            tensions: of.tensions.clone(),
            model: model(self.cable_model, self.assembly, self.in_plane_only, self.winches)?,
        })
    }
}

pub(crate) fn modes(py: Python<'_>, of: &PyEquilibrium, keywords: ModesKeywords<'_>) -> PyResult<ModesObject> {
    let mut request = keywords.request(of)?;
    if !request.rigid_cables {
        let linearisation = at_rest::linearisation(&request.model, of.at_rest.equilibrium.model);
        let (at_rest, given) = (Arc::clone(&of.at_rest), request.below_hz);
        let limit = interruptible(py, move || at_rest.modes_limit(given, linearisation))?;
        request.below_hz = Some(limit.map_err(|error| errors::study(&error))?);
    }

    // The request of the derivatives of these modes, for `Modes.gradient`.
    let own = request.clone();
    let gradient = request::Request::Gradient(request::GradientRequest {
        robot: own.robot,
        of: request::frequencies(),
        by: Vec::new(),
        hold: Hold::default(),
        per: Per::default(),
        tolerances: Vec::new(),
        below_hz: own.below_hz,
        at_hz: None,
        input: None,
        output: None,
        points: request::ResponsePoints::default(),
        state: own.state,
        tensions: own.tensions,
        model: own.model,
    });
    let gradient = (!request.rigid_cables).then(|| gradient.to_value().to_string());

    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::modes::about(&at_rest, &request))?;
    let found = answers::plain(py, &found.map_err(|error| errors::study(&error))?)?;
    let made = py.import("funicular._results")?.call_method1("modes", (found.0, gradient))?;
    Ok(ModesObject(made.unbind()))
}

pub(crate) fn compare<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    keywords: CompareKeywords<'_>,
) -> PyResult<ResultsObject<'py>> {
    let request = request::CompareRequest {
        robot: of.of.get().source.clone(),
        below_hz: keywords.below_hz.value("below_hz")?,
        platform: keywords.platform,
        platform_share: share(keywords.platform_share)?,
        tolerance: keywords.tolerance.map_or(Ok(TOLERANCE), |tolerance| tolerance.value("tolerance"))?,
        state: of.state.clone(),
        tensions: of.tensions.clone(),
        terms: terms(keywords.assembly, keywords.in_plane_only, keywords.winches)?,
    };
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::compare::about(&at_rest, &request))?;
    answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
}

/// Keywords of `settle`.
pub(crate) struct SettleKeywords<'a> {
    pub(crate) release_n: Option<Numbers>,
    pub(crate) release_n_m: Option<Numbers>,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    pub(crate) tolerance_m: Option<Number>,
    pub(crate) below_hz: Option<Number>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
}

pub(crate) fn settle<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    keywords: SettleKeywords<'_>,
) -> PyResult<ResultsObject<'py>> {
    let tolerance = |given: Number| given.value("tolerance_m");
    let request = request::SettleRequest {
        robot: of.of.get().source.clone(),
        release_n: three(keywords.release_n, "release_n")?,
        release_n_m: three(keywords.release_n_m, "release_n_m")?,
        points: points(keywords.input_point_m, keywords.output_point_m)?,
        tolerance_m: keywords.tolerance_m.map_or(Ok(request::SETTLED_WITHIN), tolerance)?,
        below_hz: keywords.below_hz.map(|hz| hz.value("below_hz")).transpose()?,
        state: of.state.clone(),
        tensions: of.tensions.clone(),
        model: model(keywords.cable_model, keywords.assembly, keywords.in_plane_only, keywords.winches)?,
    };
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::settle::about(&at_rest, &request))?;
    answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
}

pub(crate) fn cable<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    name: &str,
    hz: Numbers,
    cable_model: Option<&str>,
    in_plane_only: bool,
    winches: &str,
) -> PyResult<ResultsObject<'py>> {
    let (frequency_hz, _) = hz.frequencies()?;
    if frequency_hz.is_empty() {
        return Err(errors::input("`hz` is an empty list: give at least one frequency".to_owned()));
    }
    let cable_model = cable_model.map(|name| named("cable_model", name)).transpose()?;
    let winches = named("winches", winches)?;
    let (at_rest, name) = (Arc::clone(&of.at_rest), name.to_owned());
    let found = interruptible_in_steps(py, move |watch| {
        let requested = cable::RequestedCable { name: &name, frequency_hz, cable_model, in_plane_only, winches };
        cable::about(&at_rest, requested, watch)
    })?;
    let mut found = found.map_err(|error| errors::study(&error))?;

    // Text of JSON takes several times longer than the computation of such long lists.
    let cable::Local { k_a, k_b, k_c, k_o } = std::mem::take(&mut found.local);
    let cable::World { real, imag } = std::mem::take(&mut found.world);
    let frequency_hz: Vector = std::mem::take(&mut found.frequency_hz).into_iter().collect();
    let results = answers::with_arrays(py, &found)?;
    let local = PyDict::new(py);
    for (key, values) in [("k_a", k_a), ("k_b", k_b), ("k_c", k_c), ("k_o", k_o)] {
        let values: Vector<Complex64> = complex(values.real, values.imag).collect();
        local.set_item(key, values)?;
    }
    let flat = |matrices: Vec<[[f64; 3]; 3]>| matrices.into_flattened().into_flattened();
    results.0.set_item("frequency_hz", frequency_hz)?;
    results.0.set_item("local", local)?;
    results.0.set_item("world", Tensor::of_rows(complex(flat(real), flat(imag)).collect(), 3, 3))?;
    Ok(results)
}

/// Complex numbers of their parts.
fn complex(real: Vec<f64>, imag: Vec<f64>) -> impl Iterator<Item = Complex64> {
    real.into_iter().zip(imag).map(|(re, im)| Complex64::new(re, im))
}

/// Responses of all pairs of output and input, with their frequencies if these were chosen.
pub(crate) enum Responses {
    Given(OwnedArray<Complex64, IxDyn>),
    Adaptive(Vector, OwnedArray<Complex64, IxDyn>),
}

impl<'py> IntoPyObject<'py> for Responses {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    // scripts/test-python makes overloads of it, one per value of `adaptive`.
    const OUTPUT_TYPE: PyStaticExpr = PyStaticExpr::BinOp {
        left: &<Vector<Complex64> as IntoPyObject<'py>>::OUTPUT_TYPE,
        op: PyStaticOperator::BitOr,
        right: &<(Vector, Vector<Complex64>) as IntoPyObject<'py>>::OUTPUT_TYPE,
    };

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(match self {
            Self::Given(values) => values.into_pyobject(py)?.into_any(),
            Self::Adaptive(hz, values) => (hz, values).into_pyobject(py)?.into_any(),
        })
    }
}

/// Minimum height of a peak above the valleys beside it, if none is given [dB]; the default of the requests.
pub(crate) const PROMINENCE_DB: f64 = 1.0;

/// Keywords for inputs and outputs of responses.
pub(crate) struct PairKeywords<'a> {
    pub(crate) input: Option<Texts>,
    pub(crate) output: Option<Texts>,
    pub(crate) adaptive: bool,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
    pub(crate) cable_model: Option<&'a str>,
    pub(crate) assembly: &'a str,
    pub(crate) in_plane_only: bool,
    pub(crate) winches: &'a str,
}

/// Signals and models of responses.
pub(crate) struct Pairs {
    inputs: Vec<String>,
    outputs: Vec<String>,
    /// True for one input and one output, none of them in a list.
    one: bool,
    points: request::ResponsePoints,
    model: request::Model,
}

impl PairKeywords<'_> {
    pub(crate) fn pairs(self) -> PyResult<Pairs> {
        let signals = |given: Option<Texts>, key: &'static str, default: &str| {
            given.map_or_else(|| Ok((vec![default.to_owned()], true)), |names| names.one_or_several(key))
        };
        let (inputs, one_input) = signals(self.input, "input", request::DEFAULT_INPUT)?;
        let (outputs, one_output) = signals(self.output, "output", request::DEFAULT_OUTPUT)?;
        let points = points(self.input_point_m, self.output_point_m)?;
        let model = model(self.cable_model, self.assembly, self.in_plane_only, self.winches)?;
        Ok(Pairs { inputs, outputs, one: one_input && one_output, points, model })
    }
}

impl Pairs {
    pub(crate) fn of_study(&self) -> frf::Pairs<'_> {
        frf::Pairs { inputs: &self.inputs, outputs: &self.outputs, points: self.points, model: self.model }
    }
}

pub(crate) fn frf(
    py: Python<'_>,
    of: &PyEquilibrium,
    hz: Option<Numbers>,
    keywords: PairKeywords<'_>,
) -> PyResult<Responses> {
    let adaptive = keywords.adaptive;
    let pairs = keywords.pairs()?;
    let frequencies = match hz {
        Some(hz) => hz.frequencies()?.0,
        None if adaptive => default_frequencies(py, of, pairs.model)?,
        None => {
            return Err(errors::input(
                "`hz` is missing: give the frequencies, or `adaptive=True` for those that the program chooses"
                    .to_owned(),
            ));
        }
    };

    let found = py.detach(|| {
        let mut watch = CtrlC::new();
        frf::response(&of.at_rest, &pairs.of_study(), frequencies, adaptive, &mut watch)
            .map_err(|error| watch.or(&error))
    })?;
    if let Some(caveat) = &found.caveat {
        errors::warn(py, "ResponseWarning", caveat, 2)?;
    }

    let frf::Response { frequencies_hz, mut values, .. } = found;
    let shape = [pairs.outputs.len(), pairs.inputs.len(), frequencies_hz.len()];
    let values = if pairs.one {
        ArrayD::from_shape_vec(IxDyn(&shape[2..]), values.swap_remove(0)).expect("one row")
    } else {
        ArrayD::from_shape_vec(IxDyn(&shape), values.concat()).expect("a row per pair")
    };
    let values = OwnedArray(values);
    Ok(if adaptive {
        Responses::Adaptive(frequencies_hz.into_iter().collect(), values)
    } else {
        Responses::Given(values)
    })
}

/// Frequencies from which an adaptive response starts if none are given, as those of the program's `frf`.
fn default_frequencies(py: Python<'_>, of: &PyEquilibrium, model: request::Model) -> PyResult<Vec<f64>> {
    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || {
        let linearisation = at_rest::linearisation(&model, at_rest.equilibrium.model);
        at_rest.response_range(&request::ResponseRange::default(), linearisation)?.starts()
    })?;
    found.map_err(|error| errors::study(&error))
}

/// Computes values at all frequencies, with checks for Ctrl-C.
fn in_chunks<T: Send>(
    py: Python<'_>,
    frequencies: &[f64],
    compute: impl Fn(&[f64]) -> Result<Vec<T>, response::ResponseError> + Sync + Send,
) -> PyResult<Vec<T>> {
    let (first, rest) = frequencies.split_at(frequencies.len().min(CHUNK));
    // The vector of the first chunk grows, so that a call with one chunk copies nothing.
    let mut values = py.detach(|| compute(first)).map_err(|error| errors::response(&error))?;
    values.reserve_exact(rest.len());
    for chunk in rest.chunks(CHUNK) {
        py.check_signals()?;
        values.extend(py.detach(|| compute(chunk)).map_err(|error| errors::response(&error))?);
    }
    Ok(values)
}

pub(crate) fn receptance(
    py: Python<'_>,
    of: &PyEquilibrium,
    hz: Numbers,
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
    winches: &str,
) -> PyResult<Tensor<Complex64>> {
    let (frequencies, _) = hz.frequencies()?;
    let model = model(cable_model, assembly, in_plane_only, winches)?;
    let linearisation = at_rest::linearisation(&model, of.at_rest.equilibrium.model);
    let dynamics = py.detach(|| of.at_rest.dynamics(linearisation, highest(&frequencies)));
    let (dynamics, _) = dynamics.map_err(|error| errors::study(&error))?;
    let matrices = in_chunks(py, &frequencies, |chunk| response::receptances(&dynamics, chunk))?;
    // No copy: nalgebra stores a matrix by columns.
    Ok(Tensor::of_six(matrices.into_iter().map(|matrix| matrix.data.0).collect()))
}

/// Finds the peaks of a response; returns their frequencies [Hz], heights above the valleys beside them [dB] and
/// magnitudes.
///
/// Parameters
/// ----------
/// hz
///     Frequencies [Hz] in ascending order.
/// response
///     Response at these frequencies, as `frf` returns it.
/// prominence_db
///     Minimum height of a peak above the valleys beside it [dB]; 1 if not given.
#[pyfunction]
#[pyo3(signature = (hz, response, *, prominence_db=None))]
pub(crate) fn peaks(
    hz: Numbers,
    response: ComplexNumbers,
    prominence_db: Option<Number>,
) -> PyResult<(Vector, Vector, Vector)> {
    let (frequencies, _) = hz.frequencies()?;
    let prominence_db =
        prominence_db.map_or(Ok(PROMINENCE_DB), |prominence| prominence.not_negative("prominence_db"))?;
    let values = response.row("response")?;
    if values.len() != frequencies.len() {
        return Err(errors::input(format!("{} frequencies for {} values", frequencies.len(), values.len())));
    }
    if let Some((hz, value)) = frequencies.iter().zip(&values).find(|(_, value)| !value.norm().is_finite()) {
        return Err(errors::input(format!("`response` is {value} at {hz} Hz: it must be finite")));
    }
    if frequencies.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(errors::input("`hz` does not ascend: sort the frequencies and give each of them once".to_owned()));
    }

    let found = funicular::response::peaks(&frequencies, &values, prominence_db);
    Ok((
        found.iter().map(|peak| peak.frequency_hz).collect(),
        found.iter().map(|peak| peak.prominence_db).collect(),
        found.iter().map(|peak| peak.magnitude).collect(),
    ))
}
