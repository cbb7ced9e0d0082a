//! `funicular.Catenary`: one hanging cable.

use crate::arrays::{Matrix, Number, Numbers, PickleParts};
use crate::errors;
use funicular::catenary::{self, Rope};
use pyo3::prelude::*;

/// Span, rise, unstrained length, weight per length, axial stiffness.
type CatenaryArguments = (f64, f64, f64, f64, f64);

/// Elastic cable that hangs in its plane under its own weight; immutable.
///
/// Parameters
/// ----------
/// span_m, rise_m
///     Horizontal and vertical distance from the start to the end [m]; the rise may be negative.
/// unstrained_length_m
///     Unstrained length [m].
/// weight_n_per_m
///     Weight per unstrained length [N/m]; a cable without weight is straight.
/// axial_stiffness_n
///     Axial stiffness EA [N].
#[pyclass(frozen, weakref, name = "Catenary", module = "funicular")]
pub(crate) struct Catenary(catenary::Catenary);

#[pymethods]
impl Catenary {
    #[new]
    #[pyo3(signature = (span_m, rise_m, *, unstrained_length_m, weight_n_per_m, axial_stiffness_n))]
    fn new(
        span_m: Number,
        rise_m: Number,
        unstrained_length_m: Number,
        weight_n_per_m: Number,
        axial_stiffness_n: Number,
    ) -> PyResult<Self> {
        let rope = Rope {
            unstrained_length: unstrained_length_m.positive("unstrained_length_m")?,
            weight_per_length: weight_n_per_m.not_negative("weight_n_per_m")?,
            axial_stiffness: axial_stiffness_n.positive("axial_stiffness_n")?,
        };
        let (span_m, rise_m) = (span_m.finite("span_m")?, rise_m.finite("rise_m")?);
        let catenary = catenary::Catenary::between(span_m, rise_m, rope);
        let catenary = catenary.map_err(|error| errors::input(error.to_string()))?;
        let ends = [catenary.horizontal_force(), catenary.tension_at_start(), catenary.tension_at_end()];
        let tangent = catenary.tangent();
        if !ends.iter().chain(tangent.as_flattened()).all(|number| number.is_finite()) {
            return Err(errors::input(
                "the cable has no finite tension or stiffness: its numbers are too far apart; check their units"
                    .to_owned(),
            ));
        }
        Ok(Self(catenary))
    }

    /// Horizontal force at both ends [N].
    #[getter]
    fn horizontal_force_n(&self) -> f64 {
        self.0.horizontal_force()
    }

    /// Tension at the start [N].
    #[getter]
    fn tension_start_n(&self) -> f64 {
        self.0.tension_at_start()
    }

    /// Tension at the end [N].
    #[getter]
    fn tension_end_n(&self) -> f64 {
        self.0.tension_at_end()
    }

    /// Static stiffness of the start in the plane with a fixed end, 2×2 [N/m]: horizontal, vertical.
    #[getter]
    fn tangent_n_per_m(&self) -> Matrix {
        Matrix::of_rows(self.0.tangent().as_flattened().to_vec(), 2)
    }

    /// Returns the points at unstrained arc lengths from the start [m], one row per point: horizontal and vertical
    /// distance from the start.
    fn points_m(&self, arc_length_m: Numbers) -> PyResult<Matrix> {
        let length = self.0.rope().unstrained_length;
        let arcs = arc_length_m.row("arc_length_m")?;
        if let Some(bad) = arcs.iter().find(|s| !(0.0..=length).contains(*s)) {
            return Err(errors::input(format!(
                "the arc length {bad} m is not from 0 to {length} m, the unstrained length of the cable"
            )));
        }
        Ok(Matrix::of_rows(arcs.iter().flat_map(|s| self.0.point_at(*s)).collect(), 2))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    fn __hash__(&self) -> u64 {
        (self.0.horizontal_force() + 0.0).to_bits()
    }

    fn __repr__(&self) -> String {
        let (start, end) = (self.0.tension_at_start(), self.0.tension_at_end());
        format!("<Catenary: tensions {start:.6} and {end:.6} N>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<PickleParts<'py, CatenaryArguments>> {
        let py = slf.py();
        let of = &slf.get().0;
        let Rope { unstrained_length, weight_per_length, axial_stiffness } = of.rope();
        let rebuild = py.import("funicular._rebuild")?.getattr("catenary")?;
        let arguments = (of.span(), of.rise(), unstrained_length, weight_per_length, axial_stiffness);
        Ok((rebuild, arguments))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}
