//! A robot at rest.

use crate::answers::{self, in_words};
use crate::arrays::{Count, Keyed, Matrix, Number, Numbers, Reduced, Tensor, Vector};
use crate::errors;
use crate::pose::PyPose;
use crate::robot::PyRobot;
use crate::vibration::{self, ModesKeywords, ModesObject, Pair};
use crate::written::{self, PageKeywords, ReduceKeywords};
use funicular::cable::Sag;
use funicular::statics::{self, Stability};
use funicular_study::analyses;
use funicular_study::at_rest::{self, AtRest};
use funicular_study::request::{State, Tensions};
use numpy::Complex64;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A static equilibrium of a robot; immutable. Arrays with one entry a cable are in file order.
///
/// Made by `Robot.equilibrium`.
#[pyclass(frozen, name = "Equilibrium", module = "funicular")]
pub(crate) struct PyEquilibrium {
    /// As the user has it.
    pub(crate) of: Py<PyRobot>,
    pub(crate) state: State,
    pub(crate) tensions: Tensions,
    pub(crate) at_rest: Arc<AtRest>,
}

impl PyEquilibrium {
    pub(crate) fn of(py: Python<'_>, of: Py<PyRobot>, state: State, tensions: Tensions) -> PyResult<Self> {
        let robot = &of.get().robot;
        let at_rest = py.detach(|| at_rest::equilibrium((**robot).clone(), &state, &tensions));
        let at_rest = Arc::new(at_rest.map_err(|error| errors::study(&error))?);
        Ok(Self { of, state, tensions, at_rest })
    }

    fn sags(&self) -> impl Iterator<Item = Sag> {
        self.at_rest.equilibrium.cables.iter().enumerate().map(|(i, cable)| Sag::of(&self.at_rest.robot, i, cable))
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
        PyPose::of(&self.at_rest.equilibrium.pose)
    }

    /// How cables carry their load: `ideal`, `spring` or `catenary`.
    #[getter]
    fn model(&self) -> &'static str {
        self.at_rest.equilibrium.model.name()
    }

    /// The rule that tensions were chosen by; None where there was no choice.
    #[getter]
    fn tension_rule(&self) -> Option<&'static str> {
        self.at_rest.rule.as_ref().map(statics::TensionRule::name)
    }

    /// Unstrained lengths [m].
    #[getter]
    fn lengths(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
    }

    /// Tensions at the platform [N].
    #[getter]
    fn tensions(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect()
    }

    /// Tensions at the anchors [N].
    #[getter]
    fn anchor_tensions(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.tension_anchor).collect()
    }

    /// Forces of the cables on the platform, world axes [N], one row a cable.
    #[getter]
    fn forces(&self) -> Matrix {
        let cables = &self.at_rest.equilibrium.cables;
        Matrix::of_rows(cables.iter().flat_map(|cable| cable.force_on_platform_w.iter().copied()).collect(), 3)
    }

    /// Chord lengths, attachment to anchor [m].
    #[getter]
    fn chords(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(statics::CableState::chord).collect()
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
        match self.at_rest.equilibrium.stability {
            Stability::Stable { .. } => Some(true),
            Stability::Unstable { .. } => Some(false),
            Stability::Rigid => None,
        }
    }

    /// Least eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; None for ideal cables.
    #[getter]
    fn stiffness_min_n_per_m(&self) -> Option<f64> {
        min_stiffness(&self.at_rest.equilibrium.stability)
    }

    /// What is left of the wrench on the platform, over the sum of all forces.
    #[getter]
    fn residual(&self) -> f64 {
        self.at_rest.equilibrium.residual
    }

    /// Iterations taken.
    #[getter]
    fn iterations(&self) -> usize {
        self.at_rest.equilibrium.iterations
    }

    /// Distance from the pose asked [m], where fewer cables than degrees of freedom hold only the nearest; else None.
    #[getter]
    fn nearest_pose_distance_m(&self) -> Option<f64> {
        self.at_rest.requested_pose.map(|(_, distance)| distance)
    }

    /// What to know before trusting the result.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        in_words(&self.at_rest.warnings(None))
    }

    /// The cables one by one, with the keys of the program's JSON.
    #[getter]
    fn cables<'py>(&self, py: Python<'py>) -> PyResult<Vec<Keyed<'py>>> {
        let rows = serde_json::to_string(&analyses::statics::cable_rows(&self.at_rest));
        let rows = rows.map_err(|error| errors::input(error.to_string()))?;
        let rows = py.import("json")?.call_method1("loads", (rows,))?;
        rows.try_iter()?.map(|row| Ok(Keyed(row?.cast_into()?))).collect()
    }

    /// Points along every cable at rest, world axes [m]: (cables, points, 3), from the platform to the anchor, at equal
    /// parts of the unstrained length; 33 on each if `points` is not given.
    #[pyo3(signature = (points=Count::of(33)))]
    fn cable_points(&self, points: Count) -> PyResult<Tensor> {
        let points = points.within("points", 2..=10_000, "it must be from 2 to 10000")?;
        let mut flat = Vec::with_capacity(3 * points * self.at_rest.robot.cables.len());
        for cable in &self.at_rest.equilibrium.cables {
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
    /// at_hz
    ///     Frequency [Hz], or a row of n of them; 0 if not given.
    /// cable_model
    ///     How cables answer motion: `catenary-dynamic`, `shallow-dynamic`, `shallow-static`, `catenary-static`, `spring`. If not given,
    ///     `catenary-dynamic` for cables that hang, else `shallow-dynamic`; at 0 Hz the exact tangent of the static model, in wind
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
    #[pyo3(signature = (at_hz=None, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn stiffness(
        &self,
        py: Python<'_>,
        at_hz: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<vibration::Stiffness> {
        vibration::stiffness(py, self, at_hz, cable_model, assembly, in_plane_only)
    }

    /// Every equilibrium that a search finds with the lengths of this one: the program's `statics --all`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON: `equilibria` has them, the lowest first, each with `pose`, `stable`, `energy_j`,
    /// `distance_m` and `tensions_platform_n`; `search` says what was searched. Lists of numbers are arrays.
    pub(crate) fn all_equilibria<'py>(&self, py: Python<'py>) -> PyResult<Keyed<'py>> {
        let at_rest = Arc::clone(&self.at_rest);
        let found = crate::interrupt::interruptible(py, move || analyses::statics::about(&at_rest, true))?;
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Every natural frequency below a limit, counted: none missed.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     The limit [Hz].
    /// input, output
    ///     Signals of a response, as of `frf`: every mode then has its residue and the height of its own peak.
    /// input_point_m, output_point_m
    ///     As of `frf`.
    /// stations
    ///     Number of points along every cable, ends included, whose displacements are wanted.
    /// cable_model, assembly, in_plane_only
    ///     As of `stiffness`.
    /// damped
    ///     Seek the damped partner of every mode, too, as the program does: damping ratios are then those of complex
    ///     frequencies. False is faster; damping ratios are then of first order and there are no eigenvalues.
    #[pyo3(signature = (
        below_hz, *, input=None, output=None, input_point_m=None, output_point_m=None, stations=None, cable_model=None,
        assembly="consistent", in_plane_only=false, damped=true
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn modes(
        &self,
        py: Python<'_>,
        below_hz: Number,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        stations: Option<Count>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        damped: bool,
    ) -> PyResult<ModesObject> {
        let keywords = ModesKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            stations,
            cable_model,
            assembly,
            in_plane_only,
            damped,
        };
        vibration::modes(py, self, keywords)
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

    /// Every cable model side by side, each against the exact one: which frequencies it has, misses and gets wrong, and
    /// which model to take, with the keys of the program's JSON; lists of numbers are arrays.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Limit of the frequencies [Hz].
    /// assembly, in_plane_only
    ///     As of `stiffness`.
    #[pyo3(signature = (below_hz, *, assembly="consistent", in_plane_only=false))]
    fn compare<'py>(
        &self,
        py: Python<'py>,
        below_hz: Number,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<Keyed<'py>> {
        vibration::compare(py, self, below_hz, assembly, in_plane_only)
    }

    /// Dynamic stiffness of one cable's platform end, its anchor held, with the keys of the program's JSON.
    ///
    /// Parameters
    /// ----------
    /// name
    ///     Name of the cable.
    /// hz
    ///     Frequencies [Hz], a row of n.
    /// cable_model, in_plane_only
    ///     As of `stiffness`.
    ///
    /// Returns
    /// -------
    /// `local` has `k_a`, `k_b`, `k_c`, `k_o` (n, complex): along the chord, coupling, normal in plane, out of plane [N/m];
    /// `world` is (n, 3, 3), complex, in world axes; `clamped_frequencies_hz` are those of the cable with both ends held.
    #[pyo3(signature = (name, hz, *, cable_model=None, in_plane_only=false))]
    fn cable<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        hz: Numbers,
        cable_model: Option<&str>,
        in_plane_only: bool,
    ) -> PyResult<Keyed<'py>> {
        vibration::cable(py, self, name, hz, cable_model, in_plane_only)
    }

    /// A second-order model M x'' + C x' + K x = B f, y = L x for control design, as `funicular.ReducedModel`.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Highest frequency that the model is for [Hz].
    /// input, output
    ///     Lists of signals, as of `frf`; all forces and moments on the platform and all its displacements and rotations if
    ///     not given.
    /// input_point_m, output_point_m
    ///     As of `frf`.
    /// tolerance
    ///     Maximum relative error of the responses by modes left out.
    /// damping_at_hz
    ///     Frequency at which constant damping ratios are right when made viscous [Hz]; at every natural frequency if not
    ///     given.
    /// cable_model, assembly, in_plane_only
    ///     As of `stiffness`.
    #[pyo3(signature = (
        below_hz, input=None, output=None, *, input_point_m=None, output_point_m=None, tolerance=Number::of(1e-3),
        damping_at_hz=None, cable_model=None, assembly="consistent", in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn reduce(
        &self,
        py: Python<'_>,
        below_hz: Number,
        input: Option<Vec<String>>,
        output: Option<Vec<String>>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        tolerance: Number,
        damping_at_hz: Option<Number>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<written::ReducedObject> {
        let keywords = ReduceKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            tolerance,
            damping_at_hz,
            cable_model,
            assembly,
            in_plane_only,
        };
        written::reduce(py, self, keywords)
    }

    /// Writes the robot at rest as a file of another program; returns what to know before trusting it.
    ///
    /// Parameters
    /// ----------
    /// to
    ///     `opensees`, `moordyn` or `vtk`.
    /// path
    ///     The file, written as a whole or not at all.
    /// segments
    ///     Elements for each cable.
    /// modes_below_hz
    ///     Limit of the modes in the file [Hz].
    ///
    /// Raises
    /// ------
    /// FileError
    ///     The file cannot be written.
    #[pyo3(signature = (to, path, *, segments=Count::of(20), modes_below_hz=None))]
    fn export(
        &self,
        py: Python<'_>,
        to: &str,
        path: PathBuf,
        segments: Count,
        modes_below_hz: Option<Number>,
    ) -> PyResult<Vec<String>> {
        written::export(py, self, to, path, segments, modes_below_hz)
    }

    /// A page in HTML with everything about the robot at rest, as `funicular.Page`, which notebooks show.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     Write the page there, too.
    /// below_hz
    ///     Limit of the frequencies [Hz].
    /// input, output
    ///     Signals of the response on the page, as of `frf`; `fz` and `az` if not given, or `fx` and `ax` of a platform that
    ///     cannot move along z.
    /// input_point_m, output_point_m, cable_model, assembly, in_plane_only
    ///     As of `frf`.
    #[pyo3(signature = (
        path=None, *, below_hz=Number::of(20.0), input=None, output=None, input_point_m=None, output_point_m=None,
        cable_model=None, assembly="consistent", in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn report(
        &self,
        py: Python<'_>,
        path: Option<PathBuf>,
        below_hz: Number,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<written::PageObject> {
        let keywords = PageKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
        };
        written::report(py, self, path, keywords)
    }

    /// The result with the keys of the program's JSON.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Keyed<'py>> {
        let found = py.detach(|| analyses::statics::about(&self.at_rest, false));
        answers::plain(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// The cables as a table of pandas, which has to be installed.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._tables")?.call_method1("cables", (slf,))
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (this, other) = (&*self.at_rest, &*other.at_rest);
        this.equilibrium == other.equilibrium
            && this.requested_pose == other.requested_pose
            && this.rule == other.rule
            && this.robot == other.robot
    }

    fn __hash__(&self) -> u64 {
        self.at_rest
            .equilibrium
            .cables
            .iter()
            .fold(0, |hash, cable| hash.rotate_left(7) ^ (cable.unstrained_length + 0.0).to_bits())
    }

    fn __repr__(&self) -> String {
        let tensions = self.at_rest.equilibrium.cables.iter().map(|cable| cable.tension_platform);
        let (least, most) = tensions.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let p = &self.at_rest.equilibrium.pose.position_w;
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

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (Py<PyRobot>, String)>> {
        let py = slf.py();
        let Self { of, state, tensions, .. } = slf.get();
        // The keys of a request are the keywords of `Robot.equilibrium`.
        let keywords = written::joined(&[&serde_json::to_value(state), &serde_json::to_value(tensions)])?;
        let rebuild = py.import("funicular._rebuild")?.getattr("equilibrium")?;
        Ok((rebuild, (of.clone_ref(py), keywords)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}

pub(crate) fn min_stiffness(stability: &Stability) -> Option<f64> {
    match stability {
        Stability::Stable { min_stiffness } | Stability::Unstable { min_stiffness, .. } => Some(*min_stiffness),
        Stability::Rigid => None,
    }
}
