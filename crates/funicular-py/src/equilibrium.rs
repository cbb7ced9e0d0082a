//! A robot at rest.

use crate::arrays::{Count, Keyed, Matrix, Number, Numbers, Reduced, Tensor, Vector};
use crate::errors;
use crate::pose::PyPose;
use crate::request::{Asked, Options};
use crate::robot::PyRobot;
use crate::vibration::{self, ModesObject, Pair};
use funicular::cable::Sag;
use funicular::robot::Robot;
use funicular::statics::{self, Rest, Stability};
use funicular::validity;
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A static equilibrium of a robot; immutable. Arrays with one entry a cable are in file order.
///
/// Made by `Robot.equilibrium`.
#[pyclass(frozen, name = "Equilibrium", module = "funicular")]
pub(crate) struct PyEquilibrium {
    /// As the user has it.
    of: Py<PyRobot>,
    asked: Asked,
    options: Options,
    /// In the state asked, with its limits and loads.
    pub(crate) robot: Arc<Robot>,
    pub(crate) rest: Arc<Rest>,
}

impl PyEquilibrium {
    pub(crate) fn of(py: Python<'_>, of: Py<PyRobot>, asked: Asked, options: Options) -> PyResult<Self> {
        let robot = asked.robot(options.robot(&of.get().robot)?)?;
        let (model, rule) = (options.model, options.rule.clone());
        let rest = py.detach(|| statics::rest(&robot, model, rule)).map_err(|error| errors::statics(&error))?;
        Ok(Self { of, asked, options, robot: Arc::new(robot), rest: Arc::new(rest) })
    }

    fn sags(&self) -> impl Iterator<Item = Sag> {
        self.rest.equilibrium.cables.iter().enumerate().map(|(i, cable)| Sag::of(&self.robot, i, cable))
    }

    /// What there is to warn of the statics.
    pub(crate) fn static_warnings(&self) -> Vec<String> {
        let Rest { equilibrium, instead_of, .. } = &*self.rest;
        let elsewhere =
            instead_of.and_then(|(asked, distance)| validity::of_pose(&self.robot, equilibrium, &asked, distance));
        elsewhere.iter().chain(&validity::of_statics(&self.robot, equilibrium)).map(ToString::to_string).collect()
    }
}

/// A number of a cable that it may not have.
fn or_nan(taut: bool, value: f64) -> f64 {
    if taut && value.is_finite() { value } else { f64::NAN }
}

#[pymethods]
impl PyEquilibrium {
    /// The robot that it is of.
    #[getter]
    fn robot(&self, py: Python<'_>) -> Py<PyRobot> {
        self.of.clone_ref(py)
    }

    /// Pose of the platform.
    #[getter]
    fn pose(&self) -> PyPose {
        PyPose::of(&self.rest.equilibrium.pose)
    }

    /// How cables carry their load: `ideal`, `spring` or `catenary`.
    #[getter]
    fn model(&self) -> &'static str {
        self.rest.equilibrium.model.name()
    }

    /// The rule that tensions were chosen by; None where there was no choice.
    #[getter]
    fn tension_rule(&self) -> Option<&'static str> {
        self.rest.rule.as_ref().map(statics::TensionRule::name)
    }

    /// Unstrained lengths [m].
    #[getter]
    fn lengths(&self) -> Vector {
        self.rest.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
    }

    /// Tensions at the platform [N].
    #[getter]
    fn tensions(&self) -> Vector {
        self.rest.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect()
    }

    /// Tensions at the anchors [N].
    #[getter]
    fn anchor_tensions(&self) -> Vector {
        self.rest.equilibrium.cables.iter().map(|cable| cable.tension_anchor).collect()
    }

    /// Forces of the cables on the platform, world axes [N], one row a cable.
    #[getter]
    fn forces(&self) -> Matrix {
        let cables = &self.rest.equilibrium.cables;
        Matrix::of_rows(cables.iter().flat_map(|cable| cable.force_on_platform_w.iter().copied()).collect(), 3)
    }

    /// Chord lengths, attachment to anchor [m].
    #[getter]
    fn chords(&self) -> Vector {
        self.rest.equilibrium.cables.iter().map(statics::CableState::chord).collect()
    }

    /// Sags over chords; NaN for a cable without tension.
    #[getter]
    fn sag_ratio(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.ratio())).collect()
    }

    /// Irvine's λ² of the cables; NaN for a cable without tension.
    #[getter]
    fn lambda2(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.lambda2)).collect()
    }

    /// First frequencies of the cables as taut strings [Hz]; NaN for one without tension or mass.
    #[getter]
    fn string_frequency_hz(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.string_frequency_hz())).collect()
    }

    /// Whether every small motion is opposed; None for ideal cables, which are rigid.
    #[getter]
    fn stable(&self) -> Option<bool> {
        match self.rest.equilibrium.stability {
            Stability::Stable { .. } => Some(true),
            Stability::Unstable { .. } => Some(false),
            Stability::Rigid => None,
        }
    }

    /// Least eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; None for ideal cables.
    #[getter]
    fn least_stiffness_n_per_m(&self) -> Option<f64> {
        least_stiffness(&self.rest.equilibrium.stability)
    }

    /// What is left of the wrench on the platform, over the sum of all forces.
    #[getter]
    fn residual(&self) -> f64 {
        self.rest.equilibrium.residual
    }

    /// Iterations taken.
    #[getter]
    fn iterations(&self) -> usize {
        self.rest.equilibrium.iterations
    }

    /// Distance from the pose asked [m], where fewer cables than freedoms hold only the nearest; else None.
    #[getter]
    fn nearest_pose_distance_m(&self) -> Option<f64> {
        self.rest.instead_of.map(|(_, distance)| distance)
    }

    /// What to know before trusting the result.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.static_warnings()
    }

    /// The cables one by one, with the keys of the program's JSON.
    #[getter]
    fn cables<'py>(&self, py: Python<'py>) -> PyResult<Vec<Keyed<'py>>> {
        let states = self.rest.equilibrium.cables.iter().zip(&self.robot.cables).zip(self.sags());
        let row = |((state, cable), sag): ((&statics::CableState, &funicular::robot::Cable), Sag)| {
            let row = PyDict::new(py);
            row.set_item("name", &cable.name)?;
            row.set_item("unstrained_length_m", state.unstrained_length)?;
            row.set_item("tension_platform_n", state.tension_platform)?;
            row.set_item("tension_anchor_n", state.tension_anchor)?;
            row.set_item("chord_m", state.chord())?;
            let numbers = [
                ("sag_ratio", sag.ratio()),
                ("lambda2", sag.lambda2),
                ("string_frequency_hz", sag.string_frequency_hz()),
            ];
            for (key, value) in numbers {
                if sag.tension > 0.0 && value.is_finite() {
                    row.set_item(key, value)?;
                }
            }
            row.set_item("force_on_platform_n", <[f64; 3]>::from(state.force_on_platform_w))?;
            Ok(Keyed(row))
        };
        states.map(row).collect()
    }

    /// Points along every cable at rest, world axes [m]: (cables, points, 3), from the platform to the anchor, at equal
    /// parts of the unstrained length; 33 on each if `points` is not given.
    #[pyo3(signature = (points=Count::of(33)))]
    fn cable_points(&self, points: Count) -> PyResult<Tensor> {
        let points = points.within("points", 2..=10_000, "it must be from 2 to 10000")?;
        let mut flat = Vec::with_capacity(3 * points * self.robot.cables.len());
        for cable in &self.rest.equilibrium.cables {
            for i in 0..points {
                let part = i as f64 / (points - 1) as f64;
                let point = match &cable.hanging {
                    Some(hanging) => hanging.point_w(part * cable.unstrained_length),
                    None => cable.attachment_w + (cable.anchor_w - cable.attachment_w) * part,
                };
                flat.extend(point.iter());
            }
        }
        Ok(Tensor::of_rows(flat, points, 3))
    }

    /// Stiffness about the platform origin, world axes [N/m, N, N m].
    ///
    /// Parameters
    /// ----------
    /// hz
    ///     Frequency [Hz], or a row of n of them.
    /// cable_model
    ///     How cables answer motion: `exact`, `closed-form`, `static-sag`, `catenary-tangent`, `spring`. If not given,
    ///     `exact` for cables that hang, else `closed-form`; at 0 Hz the exact tangent of the static model, in wind
    ///     with a drag that turns with the cables, which makes it unsymmetric (theory (49d)). A named model has the
    ///     symmetric stiffness with the drag held, as have other frequencies.
    /// assembly
    ///     `consistent`, or `paper`: the cables' end stiffness only, as Yuan et al. 2014.
    /// in_plane_only
    ///     Leave out the stiffness of cables out of their planes, as Yuan et al. 2014.
    ///
    /// Returns
    /// -------
    /// (6, 6), real at 0 Hz and complex at another frequency; of a row of frequencies (n, 6, 6), complex.
    #[pyo3(signature = (hz=None, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn stiffness(
        &self,
        py: Python<'_>,
        hz: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<vibration::Stiffness> {
        vibration::stiffness(py, self, hz, cable_model, assembly, in_plane_only)
    }

    /// Every natural frequency below a limit, counted: none missed.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     The limit [Hz].
    /// cable_model, assembly, in_plane_only
    ///     As of `stiffness`.
    /// damped
    ///     Seek the damped partner of every mode, too, as the program does: damping ratios are then those of complex
    ///     frequencies. False is faster; damping ratios are then of first order and there are no eigenvalues.
    #[pyo3(signature = (below_hz, *, cable_model=None, assembly="consistent", in_plane_only=false, damped=true))]
    fn modes(
        &self,
        py: Python<'_>,
        below_hz: Number,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        damped: bool,
    ) -> PyResult<ModesObject> {
        vibration::modes(py, self, below_hz, cable_model, assembly, in_plane_only, damped)
    }

    /// Frequency response of one output to one input, complex, e^{+iωt}: [m/N] and so on by both.
    ///
    /// Parameters
    /// ----------
    /// hz
    ///     Frequencies [Hz], a row of n.
    /// input
    ///     Force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a direction; world axes; a
    ///     force on a cable as in `cable:3@0.5:fz`.
    /// output
    ///     Displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a` (acceleration) before it, or
    ///     `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable as in `cable:3@0.5:az`.
    /// input_point_m, output_point_m
    ///     Where the force acts and the motion is measured, platform frame [m]; the origin if not given.
    /// cable_model, assembly, in_plane_only
    ///     As of `stiffness`.
    ///
    /// Raises
    /// ------
    /// ResponseError
    ///     An undamped natural frequency lies at one of the frequencies.
    #[pyo3(signature = (
        hz, input, output, *, input_point_m=None, output_point_m=None, cable_model=None, assembly="consistent",
        in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn frf(
        &self,
        py: Python<'_>,
        hz: Numbers,
        input: &str,
        output: &str,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<Vector<Complex64>> {
        let pair = Pair { input, output, input_point_m, output_point_m };
        vibration::frf(py, self, hz, pair, cable_model, assembly, in_plane_only)
    }

    /// Receptance of all six motions to all six wrench components about the platform origin, world axes: (n, 6, 6).
    ///
    /// The parameters are those of `frf`.
    #[pyo3(signature = (hz, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn receptance(
        &self,
        py: Python<'_>,
        hz: Numbers,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<Tensor<Complex64>> {
        vibration::receptance(py, self, hz, cable_model, assembly, in_plane_only)
    }

    /// The result with the keys of the program's JSON.
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Keyed<'py>> {
        Ok(Keyed(slf.py().import("funicular._tables")?.call_method1("statics", (slf,))?.cast_into()?))
    }

    /// The cables as a table of pandas, which has to be installed.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._tables")?.call_method1("cables", (slf,))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.rest == other.rest && self.robot == other.robot
    }

    fn __hash__(&self) -> u64 {
        self.rest
            .equilibrium
            .cables
            .iter()
            .fold(0, |hash, cable| hash.rotate_left(7) ^ (cable.unstrained_length + 0.0).to_bits())
    }

    fn __repr__(&self) -> String {
        let tensions = self.rest.equilibrium.cables.iter().map(|cable| cable.tension_platform);
        let (least, most) = tensions.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let p = &self.rest.equilibrium.pose.position_w;
        format!(
            "<Equilibrium at [{:.6}, {:.6}, {:.6}] m, {} cables, tensions {least:.3} to {most:.3} N>",
            p.x,
            p.y,
            p.z,
            self.model()
        )
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._html")?.call_method1("equilibrium", (slf,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Py<PyRobot>, Keyed<'py>)>> {
        let py = slf.py();
        let Self { of, asked, options, .. } = slf.get();
        let arguments = PyDict::new(py);
        asked.to_python(&arguments)?;
        options.to_python(&arguments)?;
        let rebuild = py.import("funicular._rebuild")?.getattr("equilibrium")?;
        Ok((rebuild, (of.clone_ref(py), Keyed(arguments))))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}

pub(crate) fn least_stiffness(stability: &Stability) -> Option<f64> {
    match stability {
        Stability::Stable { least_stiffness } | Stability::Unstable { least_stiffness, .. } => Some(*least_stiffness),
        Stability::Rigid => None,
    }
}
