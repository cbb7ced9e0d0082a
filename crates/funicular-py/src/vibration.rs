//! Stiffness, modes and responses of a robot at an equilibrium.

use crate::answers::{self, CtrlC};
use crate::arrays::{ComplexNumbers, Matrix, Number, Numbers, OwnedArray, ResultsObject, Tensor, TextKeyed, Vector};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::{interruptible, interruptible_in_steps};
use funicular::math::CMat6;
use funicular::response;
use funicular_study::analyses::{self, cable, frf};
use funicular_study::at_rest;
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

/// Number of functions of Python between a line of the user and the compiled half.
const LEVEL: i32 = 3;

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
    model: request::Model,
) -> PyResult<Stiffness> {
    let (frequencies, one) = at_hz.map_or(Ok((vec![0.0], true)), |hz| hz.frequencies_of("at_hz"))?;
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

/// Modes with the keys of the program's JSON, and the request of their derivatives if they have any.
pub(crate) fn modes<'py>(
    py: Python<'py>,
    of: &PyEquilibrium,
    mut request: request::ModesRequest,
) -> PyResult<(TextKeyed<'py>, Option<String>)> {
    if !request.rigid_cables {
        let linearisation = at_rest::linearisation(&request.model, of.at_rest.equilibrium.model);
        let (at_rest, given) = (Arc::clone(&of.at_rest), request.below_hz);
        let limit = interruptible(py, move || at_rest.modes_limit(given, linearisation))?;
        request.below_hz = Some(limit.map_err(|error| errors::study(&error))?);
    }

    let own = request.clone();
    let gradient = request::Request::Gradient(request::GradientRequest {
        robot: own.robot,
        below_hz: own.below_hz,
        state: own.state,
        tensions: own.tensions,
        model: own.model,
        ..request::GradientRequest::default()
    });
    let gradient = (!request.rigid_cables).then(|| gradient.to_value().to_string());

    let at_rest = Arc::clone(&of.at_rest);
    let found = interruptible(py, move || analyses::modes::about(&at_rest, &request))?;
    Ok((answers::plain(py, &found.map_err(|error| errors::study(&error))?)?, gradient))
}

/// Stiffness of one cable over frequency; `of` has its models.
pub(crate) fn cable<'py>(
    py: Python<'py>,
    rest: &PyEquilibrium,
    name: String,
    hz: Numbers,
    of: &request::CableRequest,
) -> PyResult<ResultsObject<'py>> {
    let (frequency_hz, _) = hz.frequencies()?;
    if frequency_hz.is_empty() {
        return Err(errors::input("`hz` is an empty list: give at least one frequency".to_owned()));
    }
    let (at_rest, cable_model, in_plane_only, winches) =
        (Arc::clone(&rest.at_rest), of.cable_model, of.in_plane_only, of.winches);
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

/// Signals and models of the responses of a request.
pub(crate) fn pairs(of: &request::FrfRequest) -> frf::Pairs<'_> {
    frf::Pairs { inputs: of.input.names(), outputs: of.output.names(), points: of.signal_points, model: of.model }
}

/// Responses of a request at the frequencies `hz`.
pub(crate) fn frf(
    py: Python<'_>,
    rest: &PyEquilibrium,
    hz: Option<Numbers>,
    of: &request::FrfRequest,
) -> PyResult<Responses> {
    let (adaptive, pairs) = (of.adaptive, pairs(of));
    let frequencies = match hz {
        Some(hz) => hz.frequencies()?.0,
        None if adaptive => default_frequencies(py, rest, pairs.model)?,
        None => {
            return Err(errors::input(
                "`hz` is missing: give the frequencies, or `adaptive=True` for those that the program chooses"
                    .to_owned(),
            ));
        }
    };

    let found = py.detach(|| {
        let mut watch = CtrlC::new();
        let found = frf::response(&rest.at_rest, &pairs, frequencies, adaptive, &mut watch);
        watch.result(found)
    })?;
    if let Some(caveat) = &found.caveat {
        errors::warn(py, "ResponseWarning", caveat, LEVEL)?;
    }

    let frf::Response { frequencies_hz, mut values, .. } = found;
    let shape = [pairs.outputs.len(), pairs.inputs.len(), frequencies_hz.len()];
    let values = if of.input.is_one() && of.output.is_one() {
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
    model: request::Model,
) -> PyResult<Tensor<Complex64>> {
    let (frequencies, _) = hz.frequencies()?;
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
