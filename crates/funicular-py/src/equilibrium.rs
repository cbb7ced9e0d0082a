//! `funicular.Equilibrium`: static equilibrium of a robot, and the analyses that start from it.

use crate::analyses::PyAnalyses;
use crate::answers::{self, in_words};
use crate::arrays::{Count, Matrix, Number, PickleParts, Tensor, TextKeyed, Vector};
use crate::errors;
use crate::pose::PyPose;
use crate::request::{Keywords, joined};
use crate::robot::PyRobot;
use crate::simulation::PySimulation;
use funicular::cable::Sag;
use funicular::simulation::{ElementMesh, SimulationSettings};
use funicular::statics;
use funicular_study::analyses;
use funicular_study::analyses::statics::Extras;
use funicular_study::at_rest::{self, AtRest};
use funicular_study::columns::Tabled;
use funicular_study::reading_table::ReadingTable;
use funicular_study::request::{Request, State, Tensions};
use pyo3::prelude::*;
use std::sync::Arc;

/// Static equilibrium of a robot; immutable. Arrays with one entry per cable are in the order of the file.
///
/// Made by `Robot.equilibrium`.
#[pyclass(frozen, extends = PyAnalyses, name = "Equilibrium", module = "funicular")]
pub(crate) struct PyEquilibrium {
    /// Robot as the user has it, without the changes of the request.
    pub(crate) of: Py<PyRobot>,
    pub(crate) state: State,
    pub(crate) tensions: Tensions,
    pub(crate) at_rest: Arc<AtRest>,
}

impl PyEquilibrium {
    pub(crate) fn of(py: Python<'_>, of: Py<PyRobot>, state: State, tensions: Tensions) -> PyResult<Self> {
        let PyRobot { robot, source, .. } = of.get();
        let at_rest = py.detach(|| at_rest::equilibrium((**robot).clone(), source, &state, &tensions));
        let at_rest = Arc::new(at_rest.map_err(|error| errors::study(&error))?);
        Ok(Self { of, state, tensions, at_rest })
    }

    pub(crate) fn into_object(self, py: Python<'_>) -> PyResult<Py<Self>> {
        Py::new(py, PyClassInitializer::from(PyAnalyses).add_subclass(self))
    }

    /// Rounded table with one row per cable.
    fn reading_table(&self, py: Python<'_>) -> PyResult<ReadingTable> {
        let extras = Extras { alone: true, ..Extras::default() };
        let found = py.detach(|| analyses::statics::about(&self.at_rest, extras));
        Ok(found.map_err(|error| errors::study(&error))?.table().reading())
    }

    /// Request about this equilibrium.
    pub(crate) fn request(&self, keywords: Keywords) -> PyResult<Request> {
        keywords.request_at(&self.of.get().source, &self.state, &self.tensions)
    }

    fn sags(&self) -> impl Iterator<Item = Sag> {
        self.at_rest.equilibrium.cables.iter().enumerate().map(|(i, cable)| Sag::of(&self.at_rest.robot, i, cable))
    }
}

/// Number of a cable; NaN for a slack cable and for a value that is not finite.
fn or_nan(taut: bool, value: f64) -> f64 {
    if taut && value.is_finite() { value } else { f64::NAN }
}

#[pymethods]
impl PyEquilibrium {
    /// Robot of the equilibrium.
    #[getter]
    fn robot(&self, py: Python<'_>) -> Py<PyRobot> {
        self.of.clone_ref(py)
    }

    /// Pose of the platform.
    #[getter]
    fn pose(&self) -> PyPose {
        PyPose::of(&self.at_rest.equilibrium.pose)
    }

    /// Pose whose unstrained lengths are held, as with `hold_lengths_of_pose=True`; else None.
    #[getter]
    fn held_pose(&self) -> Option<PyPose> {
        self.at_rest.held_pose.as_ref().map(PyPose::of)
    }

    /// Static model of the cables: `ideal`, `spring` or `catenary`.
    #[getter]
    fn static_model(&self) -> &'static str {
        self.at_rest.equilibrium.model.name()
    }

    /// Rule by which tensions were chosen; None if there was no choice.
    #[getter]
    fn tension_rule(&self) -> Option<&'static str> {
        self.at_rest.rule.as_ref().map(statics::TensionRule::name)
    }

    /// True if the tensions of the rule `centre` are certified to be the only ones; None for another rule. The key
    /// `centre` of `to_dict` has the numbers of the proof.
    #[getter]
    fn unique_centre(&self) -> Option<bool> {
        analyses::statics::CentreRow::of(&self.at_rest).map(|proof| proof.unique)
    }

    /// Unstrained lengths [m].
    #[getter]
    fn unstrained_length_m(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect()
    }

    /// Tensions at the platform ends [N].
    #[getter]
    fn tension_platform_n(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.tension_platform).collect()
    }

    /// Tensions at the anchor ends [N].
    #[getter]
    fn tension_anchor_n(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(|cable| cable.tension_anchor).collect()
    }

    /// Tensions at the drums [N]; those at the anchor ends for cables without pulley and winch.
    #[getter]
    fn tension_drum_n(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(statics::CableState::tension_drum).collect()
    }

    /// Points at which the cables leave their pulleys in world axes [m], one row per cable; the anchors without
    /// pulleys.
    #[getter]
    fn exit_m(&self) -> Matrix {
        let cables = &self.at_rest.equilibrium.cables;
        Matrix::of_rows(cables.iter().flat_map(|cable| cable.anchor_w.iter().copied()).collect(), 3)
    }

    /// Displacements of the flexible supports in world axes [m], one row per support in the order of their names; no
    /// rows on a rigid frame.
    #[getter]
    fn support_displacement_m(&self) -> Matrix {
        Matrix::of_points(self.at_rest.equilibrium.support_displacements(&self.at_rest.robot).into_iter())
    }

    /// Forces of the cables on the platform in world axes [N], one row per cable.
    #[getter]
    fn force_on_platform_n(&self) -> Matrix {
        let cables = &self.at_rest.equilibrium.cables;
        Matrix::of_rows(cables.iter().flat_map(|cable| cable.force_on_platform_w.iter().copied()).collect(), 3)
    }

    /// Motions of the platform that no cable opposes by its tension, in words; empty unless the directions of the
    /// cables are dependent or the equilibrium is indifferent.
    #[getter]
    fn free_motions(&self) -> Vec<String> {
        let free = statics::free_motions(&self.at_rest.robot, &self.at_rest.equilibrium);
        free.iter().map(ToString::to_string).collect()
    }

    /// Chord lengths from attachment to anchor [m].
    #[getter]
    fn chord_m(&self) -> Vector {
        self.at_rest.equilibrium.cables.iter().map(statics::CableState::chord).collect()
    }

    /// Ratios of sag to chord; NaN for a cable without tension.
    #[getter]
    fn sag_ratio(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.ratio())).collect()
    }

    /// Irvine's parameters λ²; NaN for a cable without tension.
    #[getter]
    fn lambda2(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.lambda2)).collect()
    }

    /// First frequencies of the cables as taut strings [Hz]; NaN for a cable without tension or mass.
    #[getter]
    fn string_frequency_hz(&self) -> Vector {
        self.sags().map(|sag| or_nan(sag.tension > 0.0, sag.string_frequency_hz())).collect()
    }

    /// True if every small motion is opposed; None for ideal cables, which are rigid.
    #[getter]
    fn stable(&self) -> Option<bool> {
        self.at_rest.equilibrium.stability.is_stable()
    }

    /// Minimum eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; None for ideal cables.
    #[getter]
    fn stiffness_min_n_per_m(&self) -> Option<f64> {
        self.at_rest.equilibrium.stability.min_stiffness()
    }

    /// Unbalanced wrench on the platform relative to the sum of all forces.
    #[getter]
    fn residual(&self) -> f64 {
        self.at_rest.equilibrium.residual
    }

    /// Number of iterations of the solver.
    #[getter]
    fn iterations(&self) -> usize {
        self.at_rest.equilibrium.iterations
    }

    /// Distance from the requested pose [m] with fewer cables than degrees of freedom; else None.
    #[getter]
    fn nearest_pose_distance_m(&self) -> Option<f64> {
        self.at_rest.requested_pose.map(|(_, distance)| distance)
    }

    /// Caveats of the result.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        in_words(&self.at_rest.warnings(None))
    }

    /// One dictionary per cable, with the keys of the program's JSON.
    #[getter]
    fn cables<'py>(&self, py: Python<'py>) -> PyResult<Vec<TextKeyed<'py>>> {
        let rows = serde_json::to_string(&analyses::statics::cable_rows(&self.at_rest));
        let rows = rows.map_err(|error| errors::input(error.to_string()))?;
        let rows = py.import("json")?.call_method1("loads", (rows,))?;
        rows.try_iter()?.map(|row| Ok(TextKeyed(row?.cast_into()?))).collect()
    }

    /// Returns points along the hanging cables in world axes [m]: (cables, points, 3), from the platform to the anchor.
    ///
    /// The points are at equal steps of the unstrained length; 33 per cable if `points` is not given.
    #[pyo3(signature = (points=None))]
    fn cable_points(&self, points: Option<Count>) -> PyResult<Tensor> {
        let points =
            points.map_or(Ok(33), |points| points.within("points", 2..=10_000, "it must be from 2 to 10000"))?;

        let mut flat = Vec::with_capacity(3 * points * self.at_rest.robot.cables.len());
        for cable in &self.at_rest.equilibrium.cables {
            for i in 0..points {
                let fraction = i as f64 / (points - 1) as f64;
                let point = match &cable.hanging {
                    Some(hanging) => hanging.point_w(fraction * cable.free_length()),
                    None => cable.attachment_w + (cable.anchor_w - cable.attachment_w) * fraction,
                };
                flat.extend(point.iter());
            }
        }
        Ok(Tensor::of_rows(flat, points, 3))
    }

    /// Begins a simulation that advances by intervals, at this equilibrium.
    ///
    /// Parameters
    /// ----------
    /// tension_control
    ///     Names of the cables whose winches may be told to hold a tension; none if not given.
    /// tolerance_m
    ///     Error of a position that one step may have [m]; 1e-7 if not given.
    /// elements
    ///     Number of elements of each rope; 3 if not given.
    /// degree
    ///     Degree of the polynomials of each element; 8 if not given.
    /// damping_frequency_hz
    ///     Frequency at which the damping ratio of the ropes and their loss factor hold [Hz]; if not given, the first
    ///     natural frequency, for a loss factor that of the mode with most stretch.
    /// stretch_damping_time_s
    ///     Damping time of the stretch of all ropes [s] in place of that of the robot file.
    /// hold_platform
    ///     Hold the platform where it is, so that only the ropes move.
    /// gust_seed
    ///     Number from which the gusts of the wind's turbulence are drawn; the mean wind alone if not given.
    #[pyo3(signature = (*, tension_control=None, tolerance_m=None, elements=None, degree=None,
        damping_frequency_hz=None, stretch_damping_time_s=None, hold_platform=false, gust_seed=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn simulation(
        &self,
        py: Python<'_>,
        tension_control: Option<Vec<String>>,
        tolerance_m: Option<Number>,
        elements: Option<Count>,
        degree: Option<Count>,
        damping_frequency_hz: Option<Number>,
        stretch_damping_time_s: Option<Number>,
        hold_platform: bool,
        gust_seed: Option<Count>,
    ) -> PyResult<PySimulation> {
        let mut settings = SimulationSettings { platform_is_held: hold_platform, ..SimulationSettings::default() };
        if let Some(tolerance) = tolerance_m {
            let [least, most] = SimulationSettings::TOLERANCES;
            settings.tolerance = tolerance.positive("tolerance_m")?;
            if !(least..=most).contains(&settings.tolerance) {
                let text = format!("`tolerance_m` is {} m: give {least} to {most} m", settings.tolerance);
                return Err(errors::input(text));
            }
        }
        if let Some(elements) = elements {
            let rule = format!("give 1 to {}", ElementMesh::MAX_ELEMENTS);
            settings.mesh.elements = elements.within("elements", 1..=ElementMesh::MAX_ELEMENTS, &rule)?;
        }
        if let Some(degree) = degree {
            let rule = format!("give 1 to {}", ElementMesh::MAX_DEGREE);
            settings.mesh.degree = degree.within("degree", 1..=ElementMesh::MAX_DEGREE, &rule)?;
        }
        settings.damping_frequency_hz =
            damping_frequency_hz.map(|number| number.positive("damping_frequency_hz")).transpose()?;
        settings.stretch_damping_time =
            stretch_damping_time_s.map(|number| number.not_negative("stretch_damping_time_s")).transpose()?;
        let seed = |seed: Count| seed.within("gust_seed", 0..=u32::MAX as usize, "give a whole number below 2³²");
        settings.gust_seed = gust_seed.map(seed).transpose()?.map(|seed| seed as u64);
        PySimulation::begun(py, &self.at_rest, &tension_control.unwrap_or_default(), settings)
    }

    /// Returns a dictionary with the keys of the program's JSON.
    ///
    /// Parameters
    /// ----------
    /// another_stable_equilibrium
    ///     Search for another stable equilibrium of the same lengths, too, as the program does. The search takes
    ///     about a hundred times as long as the equilibrium; the key of this name is absent if there is none.
    #[pyo3(signature = (*, another_stable_equilibrium=false))]
    fn to_dict<'py>(&self, py: Python<'py>, another_stable_equilibrium: bool) -> PyResult<TextKeyed<'py>> {
        let extras = Extras { alone: !another_stable_equilibrium, ..Extras::default() };
        let found = py.detach(|| analyses::statics::about(&self.at_rest, extras));
        answers::plain(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Makes a table of pandas with one row per cable; pandas has to be installed.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._show")?.call_method1("table", (slf,))
    }

    /// Rounded table with one row per cable for LaTeX, with the rules of booktabs and the numbers of siunitx.
    fn to_latex(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.reading_table(py)?.latex())
    }

    /// Rounded table with one row per cable for Markdown.
    fn to_markdown(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.reading_table(py)?.markdown())
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
        let (min, max) = tensions.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let p = &self.at_rest.equilibrium.pose.position_w;
        format!(
            "<Equilibrium at [{:.6}, {:.6}, {:.6}] m, {} cables, tensions {min:.3} to {max:.3} N>",
            p.x,
            p.y,
            p.z,
            self.static_model()
        )
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._show")?.call_method1("html", (slf,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<PickleParts<'py, (Py<PyRobot>, String)>> {
        let py = slf.py();
        let Self { of, state, tensions, .. } = slf.get();
        // The keys of a request are the keywords of `Robot.equilibrium`.
        let keywords = joined(state, tensions)?;
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
