//! Stiffness, modes and responses of a robot at rest.

use crate::arrays::{ComplexNumbers, Matrix, Number, Numbers, Tensor, Vector};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::names;
use crate::waiting::interruptible;
use funicular::cable::CableModel;
use funicular::dynamics::{Dynamics, DynamicsError, Linearisation};
use funicular::math::{CMat6, Vec3};
use funicular::modes::damped::{DampedMode, DampedModes};
use funicular::modes::{self, Modes};
use funicular::ports::{Input, Output, Places};
use funicular::response;
use funicular::statics::{self, StaticModel};
use funicular::validity;
use numpy::Complex64;
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::convert::Infallible;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Frequencies between two looks for Ctrl-C: some 10 ms. A multiple of every number of lanes, so that the numbers do not
/// depend on it.
const CHUNK: usize = 16_384;

fn linearised(of: &PyEquilibrium, linearisation: Linearisation, up_to_hz: f64) -> Result<Dynamics, DynamicsError> {
    Dynamics::about(&of.robot, &of.rest.equilibrium, linearisation, up_to_hz)
}

fn highest(frequencies: &[f64]) -> f64 {
    frequencies.iter().copied().fold(0.0, f64::max)
}

/// A 6×6, or many; real where nothing depends on frequency.
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

/// Row by row; `+ 0.0` makes a negative zero positive, whose sign would mean nothing.
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
    hz: Option<Numbers>,
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
) -> PyResult<Stiffness> {
    let (frequencies, one) = hz.map_or(Ok((vec![0.0], true)), Numbers::frequencies)?;
    let linearisation = names::linearisation(cable_model, assembly, in_plane_only, of.rest.equilibrium.model)?;
    let matrices = py.detach(|| -> Result<Vec<CMat6>, DynamicsError> {
        let at_rest = |wanted: &[f64]| wanted.contains(&0.0);
        // The tangent of the static model, which the exact model has at rest, whatever the static model is.
        let still = if cable_model.is_none() {
            Linearisation { cable_model: CableModel::CatenaryTangent, ..linearisation }
        } else {
            linearisation
        };
        let tangent = if at_rest(&frequencies) { Some(tangent(of, still, cable_model.is_none())?) } else { None };
        let moving = if frequencies.iter().any(|hz| *hz > 0.0) {
            Some(linearised(of, linearisation, highest(&frequencies))?)
        } else {
            None
        };
        let at = |hz: &f64| match (&tangent, &moving) {
            (Some(tangent), _) if *hz == 0.0 => *tangent,
            (_, Some(dynamics)) => dynamics.stiffness(hz * TAU),
            (tangent, None) => tangent.unwrap_or_default(),
        };
        Ok(frequencies.iter().map(at).collect())
    });
    let all = flat(&matrices.map_err(|error| errors::dynamics(&error))?);
    Ok(match (one, frequencies[..] == [0.0]) {
        (true, true) => Stiffness::Static(Matrix::of_rows(all.iter().map(|z| z.re).collect(), 6)),
        (true, false) => Stiffness::One(Matrix::of_rows(all, 6)),
        (false, _) => Stiffness::Many(Tensor::of_rows(all, 6, 6)),
    })
}

/// The stiffness at 0 Hz, as the program gives it; without a named cable model the drag of the wind turns with the cables.
fn tangent(of: &PyEquilibrium, linearisation: Linearisation, drag_turns: bool) -> Result<CMat6, DynamicsError> {
    let equilibrium = &of.rest.equilibrium;
    if linearisation.cable_model == CableModel::CatenaryTangent && equilibrium.model == StaticModel::Ideal {
        return Err(DynamicsError::Rigid);
    }
    let whole_tangent = Linearisation { cable_model: CableModel::CatenaryTangent, ..Linearisation::default() };
    let of_statics = if drag_turns { statics::tangent_with_drag } else { statics::tangent_stiffness };
    if linearisation == whole_tangent
        && let Some(tangent) = of_statics(&of.robot, equilibrium)
    {
        return Ok(tangent.map(|k| Complex64::new(k, 0.0)));
    }
    Ok(linearised(of, linearisation, 0.0)?.stiffness(0.0))
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

/// A list and its damped partners.
struct Found {
    modes: Modes,
    damped: Option<DampedModes>,
    warnings: Vec<String>,
}

pub(crate) fn modes(
    py: Python<'_>,
    of: &PyEquilibrium,
    below_hz: Number,
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
    damped: bool,
) -> PyResult<ModesObject> {
    let below_hz = below_hz.positive("below_hz")?;
    let linearisation = names::linearisation(cable_model, assembly, in_plane_only, of.rest.equilibrium.model)?;
    let mut warnings = of.static_warnings();
    let about = validity::of_dynamics(&of.robot, &of.rest.equilibrium, linearisation.cable_model, below_hz);
    warnings.extend(about.iter().map(ToString::to_string));
    let (robot, rest) = (Arc::clone(&of.robot), Arc::clone(&of.rest));
    let found = interruptible(py, move || {
        let dynamics = Dynamics::about(&robot, &rest.equilibrium, linearisation, below_hz);
        let dynamics = dynamics.map_err(|error| errors::dynamics(&error))?;
        modes::check_count(&dynamics, below_hz, modes::MOST).map_err(|error| errors::too_many(&error))?;
        let modes = modes::below(&dynamics, below_hz);
        warnings.extend(modes.doubt());
        let (damped, doubt) = if damped { modes::damped_partners(&dynamics, &modes) } else { (None, None) };
        warnings.extend(doubt);
        Ok::<_, PyErr>(Found { modes, damped, warnings })
    })??;
    to_python(py, of, linearisation, &found).map(ModesObject)
}

fn to_python(py: Python<'_>, of: &PyEquilibrium, linearisation: Linearisation, found: &Found) -> PyResult<Py<PyAny>> {
    let Found { modes: Modes { modes, below_hz, count_below, unstable_directions, certified }, damped, warnings } =
        found;
    let fields = PyDict::new(py);
    let column = |of: fn(&modes::Mode) -> f64| modes.iter().map(of).collect::<Vector>();
    fields.set_item("frequency_hz", column(|mode| mode.frequency_hz))?;
    let multiplicity: Vector<i64> =
        modes.iter().map(|mode| i64::try_from(mode.multiplicity).unwrap_or(i64::MAX)).collect();
    fields.set_item("multiplicity", multiplicity)?;
    if let Some(damped) = damped {
        let ratios: Vector = damped.modes.iter().map(DampedMode::damping_ratio).collect();
        let eigenvalues: Vector<Complex64> = damped.modes.iter().map(DampedMode::eigenvalue).collect();
        fields.set_item("damping_ratio", ratios)?;
        fields.set_item("eigenvalue_per_s", eigenvalues)?;
    } else {
        fields.set_item("damping_ratio", column(|mode| mode.damping_ratio))?;
        fields.set_item("eigenvalue_per_s", py.None())?;
    }
    let kinds: Vec<&str> = modes.iter().map(|mode| mode.kind.name()).collect();
    fields.set_item("kind", py.import("numpy")?.call_method1("array", (kinds, "U8"))?)?;
    fields.set_item("platform_energy_fraction", column(|mode| mode.platform_energy_fraction))?;
    let cables = of.robot.cables.len();
    let energies = modes.iter().flat_map(|mode| mode.cable_energy_fractions.iter().copied()).collect();
    fields.set_item("cable_energy_fractions", Matrix::of_rows(energies, cables))?;
    let shapes = modes.iter().flat_map(|mode| mode.shape.map(|x| x + 0.0)).collect();
    fields.set_item("shape", Matrix::of_rows(shapes, 6))?;
    fields.set_item("modal_mass_kg", column(|mode| mode.modal_mass))?;
    fields.set_item("residual", column(|mode| mode.residual))?;
    fields.set_item("below_hz", below_hz)?;
    fields.set_item("count_below", count_below)?;
    fields.set_item("certified", certified)?;
    fields.set_item("unstable_directions", unstable_directions)?;
    fields.set_item("damped_certified", damped.as_ref().map(|damped| damped.certified))?;
    let names = of.robot.cables.iter().map(|cable| cable.name.as_str());
    fields.set_item("cable_names", pyo3::types::PyTuple::new(py, names.collect::<Vec<_>>())?)?;
    fields.set_item("robot", &of.robot.name)?;
    fields.set_item("static_model", of.rest.equilibrium.model.name())?;
    fields.set_item("cable_model", linearisation.cable_model.name())?;
    fields.set_item("assembly", linearisation.assembly.name())?;
    fields.set_item("in_plane_only", linearisation.in_plane_only)?;
    fields.set_item("warnings", pyo3::types::PyTuple::new(py, warnings)?)?;
    Ok(py.import("funicular._results")?.getattr("Modes")?.call((), Some(&fields))?.unbind())
}

/// Input and output of a response, as Python gives them.
pub(crate) struct Pair<'a> {
    pub(crate) input: &'a str,
    pub(crate) output: &'a str,
    pub(crate) input_point_m: Option<Numbers>,
    pub(crate) output_point_m: Option<Numbers>,
}

pub(crate) fn frf(
    py: Python<'_>,
    of: &PyEquilibrium,
    hz: Numbers,
    pair: Pair<'_>,
    cable_model: Option<&str>,
    assembly: &str,
    in_plane_only: bool,
) -> PyResult<Vector<Complex64>> {
    let (frequencies, _) = hz.frequencies()?;
    let equilibrium = &of.rest.equilibrium;
    let linearisation = names::linearisation(cable_model, assembly, in_plane_only, equilibrium.model)?;
    let input = Input::parse(pair.input).map_err(|error| errors::input(format!("input {}: {error}", pair.input)))?;
    let output =
        Output::parse(pair.output).map_err(|error| errors::input(format!("output {}: {error}", pair.output)))?;
    let point = |numbers: Option<Numbers>, what| -> PyResult<Option<Vec3>> {
        numbers.map(|numbers| numbers.three(what).map(Vec3::from)).transpose()
    };
    let from = input.direction(&of.robot, point(pair.input_point_m, "input_point_m")?);
    let to = output.direction(&of.robot, point(pair.output_point_m, "output_point_m")?);
    let (from, to) = (from.map_err(|error| errors::port(&error))?, to.map_err(|error| errors::port(&error))?);
    let dynamics = py.detach(|| linearised(of, linearisation, highest(&frequencies)));
    let dynamics = dynamics.map_err(|error| errors::dynamics(&error))?;
    let places = Places::new(&of.robot, equilibrium, &dynamics, input.on_cable.as_ref(), output.on_cable.as_ref())
        .map_err(|error| errors::place(&error))?;
    let from = places.port(places.input, from.vector(&equilibrium.pose), input.direction_w);
    let to = places.port(places.output, to.vector(&equilibrium.pose), output.direction_w);
    in_chunks(py, &frequencies, |chunk| response::between(&dynamics, chunk, &from, &to, output.quantity))
        .map(|values| values.into_iter().collect())
}

/// Values of all frequencies, with looks for Ctrl-C.
fn in_chunks<T: Send>(
    py: Python<'_>,
    frequencies: &[f64],
    compute: impl Fn(&[f64]) -> Result<Vec<T>, response::ResponseError> + Sync + Send,
) -> PyResult<Vec<T>> {
    let (first, rest) = frequencies.split_at(frequencies.len().min(CHUNK));
    // The values of the first are kept where they are: most calls have no more.
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
) -> PyResult<Tensor<Complex64>> {
    let (frequencies, _) = hz.frequencies()?;
    let linearisation = names::linearisation(cable_model, assembly, in_plane_only, of.rest.equilibrium.model)?;
    let dynamics = py.detach(|| linearised(of, linearisation, highest(&frequencies)));
    let dynamics = dynamics.map_err(|error| errors::dynamics(&error))?;
    let matrices = in_chunks(py, &frequencies, |chunk| response::receptances(&dynamics, chunk))?;
    // In place: a matrix of nalgebra is its columns.
    Ok(Tensor::of_six(matrices.into_iter().map(|matrix| matrix.data.0).collect()))
}

/// Peaks of a response: frequencies [Hz], heights above the valleys beside them [dB], magnitudes.
///
/// Parameters
/// ----------
/// hz
///     Frequencies [Hz], ascending.
/// response
///     What `frf` gives at them.
/// prominence_db
///     Least height of a peak above the valleys beside it [dB]; 1 if not given.
#[pyfunction]
#[pyo3(signature = (hz, response, *, prominence_db=Number::of(1.0)))]
pub(crate) fn peaks(
    hz: Numbers,
    response: ComplexNumbers,
    prominence_db: Number,
) -> PyResult<(Vector, Vector, Vector)> {
    let (frequencies, _) = hz.frequencies()?;
    let prominence_db = prominence_db.not_negative("prominence_db")?;
    let values = response.row("response")?;
    if values.len() != frequencies.len() {
        return Err(errors::input(format!("{} frequencies for {} values", frequencies.len(), values.len())));
    }
    if let Some((hz, value)) = frequencies.iter().zip(&values).find(|(_, value)| !value.norm().is_finite()) {
        return Err(errors::input(format!("`response` is {value} at {hz} Hz: it must be finite")));
    }
    if frequencies.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(errors::input("`hz` does not ascend".to_owned()));
    }
    let found = funicular::response::peaks(&frequencies, &values, prominence_db);
    Ok((
        found.iter().map(|peak| peak.frequency_hz).collect(),
        found.iter().map(|peak| peak.prominence_db).collect(),
        found.iter().map(|peak| peak.magnitude).collect(),
    ))
}
