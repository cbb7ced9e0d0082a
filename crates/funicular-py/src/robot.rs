//! `funicular.Robot`: the text of a robot file and the robot that the core has read from it.

use crate::analyses::PyAnalyses;
use crate::answers::{self, CtrlC};
use crate::arrays::{Count, Matrix, Number, Numbers, PickleParts, TextKeyed, Vector};
use crate::batch;
use crate::dict_to_toml;
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::pose::PoseLike;
use crate::request::{StateKeywords, TensionKeywords, model};
use crate::robot_text;
use crate::sweep::{self, Axes, ExecutorArgument, ProgressArgument, PyPlan, RunKeywords, SweepObject};
use crate::threads::Threads;
use crate::written::IdentifiedObject;
use funicular::robot::{Robot, State};
use funicular_study::analyses;
use funicular_study::request::{self as requests, MapRequest, Request, RobotText, SweepRequest};
use funicular_study::robot_file::RobotFile;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::path::PathBuf;
use std::sync::Arc;

/// Cable-driven parallel robot, read from the text of a robot file (TOML); immutable.
///
/// Made by `Robot.from_file`, `Robot.from_toml`, `Robot.from_dict` or `Robot.example`.
#[pyclass(frozen, extends = PyAnalyses, name = "Robot", module = "funicular")]
pub(crate) struct PyRobot {
    /// Text and changes, as in a request.
    pub(crate) source: RobotText,
    /// Text with its changes.
    pub(crate) text: String,
    pub(crate) robot: Arc<Robot>,
}

impl PyRobot {
    pub(crate) fn read(py: Python<'_>, source: RobotText) -> PyResult<Py<Self>> {
        let RobotFile { robot, text, .. } = source.read().map_err(|error| errors::study(&error))?;
        let robot = Self { source, text, robot: Arc::new(robot) };
        Py::new(py, PyClassInitializer::from(PyAnalyses).add_subclass(robot))
    }

    fn of_text(py: Python<'_>, name: &str, text: String) -> PyResult<Py<Self>> {
        Self::read(py, RobotText { name: name.to_owned(), text, set: Vec::new() })
    }
}

#[pymethods]
impl PyRobot {
    /// Reads a robot file.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The file is not a valid robot file; the message shows its lines.
    /// OSError
    ///     The file cannot be read.
    #[classmethod]
    fn from_file(cls: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Py<Self>> {
        let (name, text) = robot_text::of_file(&path)?;
        Self::of_text(cls.py(), &name, text)
    }

    /// Reads the text of a robot file.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The text is not a valid robot file; the message shows its lines.
    #[classmethod]
    fn from_toml(cls: &Bound<'_, PyType>, text: String) -> PyResult<Py<Self>> {
        Self::of_text(cls.py(), "<text>", text)
    }

    /// Reads a dictionary with the keys of a robot file, such as that of `to_dict`.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The dictionary is not a valid robot; the message shows it as a robot file.
    #[classmethod]
    fn from_dict(cls: &Bound<'_, PyType>, robot: TextKeyed<'_>) -> PyResult<Py<Self>> {
        Self::of_text(cls.py(), "<dict>", dict_to_toml::of_dict(&robot.0)?)
    }

    /// Makes the robot that is part of the package: six cables of 4 mm (Yuan, Courteille and Deblaise 2014).
    #[classmethod]
    fn example(cls: &Bound<'_, PyType>) -> PyResult<Py<Self>> {
        Self::read(cls.py(), RobotText::embedded())
    }

    /// Returns the text of the robot file with all changes.
    fn to_toml(&self) -> &str {
        &self.text
    }

    /// Returns the robot file as a dictionary.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        let text = self.text.trim_start_matches('\u{feff}');
        Ok(TextKeyed(py.import("tomllib")?.call_method1("loads", (text,))?.cast_into()?))
    }

    /// Makes a robot with other values; this robot stays as it is.
    ///
    /// Parameters
    /// ----------
    /// changes
    ///     New values by their paths in the robot file, as in the program's `--set`; cables by their names:
    ///     `{"materials.rope-4mm.diameter_m": 0.008, "cables.3.unstrained_length_m": 6.7}`.
    /// mass_kg
    ///     Mass of the platform [kg]; inertia and centre of mass do not change.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The file has no such path, or the value is wrong there.
    #[pyo3(signature = (changes=None, *, mass_kg=None))]
    fn with_(&self, py: Python<'_>, changes: Option<TextKeyed<'_>>, mass_kg: Option<Number>) -> PyResult<Py<Self>> {
        let source = robot_text::changed(py, &self.source, changes, mass_kg)?;
        Self::read(py, source)
    }

    /// Name of the robot.
    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    /// Source of the robot's numbers.
    #[getter]
    fn source(&self) -> &str {
        &self.robot.source
    }

    /// Mass of the platform [kg].
    #[getter]
    fn mass_kg(&self) -> f64 {
        self.robot.platform.mass
    }

    /// Motion of the platform, as in the robot file: `rigid`, `point-mass`, `planar` and so on.
    #[getter]
    fn motion(&self) -> &'static str {
        self.robot.platform.motion.name()
    }

    /// Names of the cables, in the order of the file, which every array with one entry per cable has.
    #[getter]
    fn cable_names(&self) -> Vec<&str> {
        self.robot.cables.iter().map(|cable| cable.name.as_str()).collect()
    }

    /// Anchors in world axes [m], one row per cable.
    #[getter]
    fn anchor_m(&self) -> Matrix {
        Matrix::of_points(self.robot.cables.iter().map(|cable| cable.anchor.reference_w()))
    }

    /// Attachments in the platform frame [m], one row per cable.
    #[getter]
    fn attachment_m(&self) -> Matrix {
        Matrix::of_points(self.robot.cables.iter().map(|cable| cable.attachment_p))
    }

    /// Unstrained lengths of the robot file [m], one per cable; None if the file gives a pose or no state.
    #[getter]
    fn lengths_m(&self) -> Option<Vector> {
        match &self.robot.state {
            State::Lengths(lengths) => Some(lengths.iter().copied().collect()),
            State::Pose(_) | State::Unknown => None,
        }
    }

    /// Computes the static equilibrium for a pose or for unstrained lengths.
    ///
    /// Without `pose` and `lengths_m` the state is that of the robot file.
    ///
    /// Parameters
    /// ----------
    /// pose
    ///     A `Pose`, or x, y, z [m], or x, y, z, roll, pitch, yaw [m, degrees], or x, y, z and a quaternion w, x, y, z.
    ///     The lengths follow. With fewer cables than degrees of freedom: the nearest pose that the cables can hold.
    /// lengths_m
    ///     Unstrained lengths [m], one per cable in the order of the file; the pose follows.
    /// static_model
    ///     How cables carry their static load: `ideal`, `spring` or `catenary`.
    /// tension_rule
    ///     Which of the tensions that hold a pose: more cables than degrees of freedom leave a choice. `lowest` (the
    ///     default), `closest` (to `target_tension_n`), `middle` or `stiffest`.
    /// target_tension_n
    ///     Tensions to come close to with the rule `closest` [N], one for all cables or one per cable.
    /// min_tension_n, max_tension_n
    ///     Minimum and maximum tension anywhere in a cable [N], instead of the limits of the robot file.
    /// mass_kg
    ///     Mass of the platform [kg], instead of the mass in the robot file.
    /// force_n, moment_n_m, load_point_m
    ///     Dead load on the platform, instead of the load in the robot file: force and moment in world axes [N, N m],
    ///     and point where the force acts in the platform frame [m].
    /// wind_m_s
    ///     Velocity of the wind in world axes [m/s], instead of the wind in the robot file.
    /// cable_load_n_per_m
    ///     Load per metre of every cable besides its weight, in world axes [N/m].
    /// hold_lengths_of_pose
    ///     Hold the unstrained lengths with which the robot, as it was read and before `with_`, rests at the pose. All
    ///     changes, those of `with_` and those of this call, then act at these lengths and move the platform.
    ///
    /// Raises
    /// ------
    /// StaticsError
    ///     There is no such equilibrium; `code` gives the reason as one word.
    /// InputError
    ///     An argument is wrong; the message says which and what to give.
    #[pyo3(signature = (
        pose=None, lengths_m=None, static_model="catenary", tension_rule=None, *, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None, hold_lengths_of_pose=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn equilibrium(
        slf: Py<Self>,
        py: Python<'_>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
    ) -> PyResult<Py<PyEquilibrium>> {
        let state = StateKeywords {
            pose,
            lengths_m,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        PyEquilibrium::of(py, slf, state.request()?, tensions.request()?)?.into_object(py)
    }

    /// Computes the equilibria of many states in parallel, without Python's lock.
    ///
    /// A state without equilibrium is a row with its reason, never an exception. Each row has, bit for bit, the numbers
    /// of `equilibrium`.
    ///
    /// Parameters
    /// ----------
    /// poses
    ///     (n, 3), (n, 6) or (n, 7): x, y, z [m], then roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
    /// lengths_m
    ///     (n, m): unstrained lengths [m] of m cables.
    /// threads
    ///     Number of threads; one per processor if not given.
    ///
    /// The other parameters are those of `equilibrium`.
    #[pyo3(signature = (
        poses=None, lengths_m=None, static_model="catenary", tension_rule=None, *, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None, hold_lengths_of_pose=false, threads=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn equilibria(
        &self,
        py: Python<'_>,
        poses: Option<Numbers>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
        threads: Option<Threads>,
    ) -> PyResult<batch::Equilibria> {
        let states = batch::States::read(poses, lengths_m)?;
        let state = StateKeywords {
            pose: None,
            lengths_m: None,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        batch::equilibria(py, self, states, &state.request()?, &tensions.request()?, threads)
    }

    /// Computes quantities over poses, one row per pose.
    ///
    /// The rows are those of the program's `map`, bit for bit, with any number of threads or workers. A pose without
    /// equilibrium is a row with its reason, never an exception.
    ///
    /// Parameters
    /// ----------
    /// grid
    ///     Axes of a grid of poses: x, y, z [m], roll, pitch, yaw [degrees], as in `{"x": (-4, 4, 81), "z": [0.5, 1,
    ///     2]}`. A tuple is the first value, the last value and their number; anything else is values. x varies
    ///     fastest, then y.
    /// quantities
    ///     What is computed at every point; docs/sweeps.md has the list; `tension-min` and `tension-max` if not given.
    /// poses
    ///     Poses instead of a grid, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
    /// pose, lengths_m
    ///     Values of the axes that the grid does not have: x, y, z [m], roll, pitch, yaw [degrees], or the pose of
    ///     unstrained lengths [m]; the state of the robot file if not given.
    /// up_to_hz
    ///     Limit of the search for natural frequencies [Hz]; 1000 if not given.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for `first-platform-frequency`; 0.5 if not given.
    /// payload_center_m
    ///     Centre of mass of the payload for `payload-max`, platform frame [m]; that of the platform if not given.
    /// file
    ///     File of the rows: .parquet, .csv or .vti. It is written when all rows are there; until then FILE.partial
    ///     holds them, also after a crash. The rows of a Parquet file are read into memory at their first use.
    /// resume, discard
    ///     Continue with the rows of the same sweep in FILE.partial, or delete them.
    /// part
    ///     Part k of n, as in "3/8"; each part has its own Parquet `file`, and `funicular.merge` joins them.
    /// threads
    ///     Number of threads of this process; one per processor if not given.
    /// executor
    ///     Executor whose workers compute (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
    ///     `MPIPoolExecutor`), or a function that makes an executor and is called again when the executor breaks.
    /// chunks_per_task
    ///     Number of chunks of rows that a worker gets at once; chosen from measured times if not given.
    /// progress
    ///     Function that is called with the number of finished rows and the number of all rows.
    ///
    /// The other parameters are those of `equilibrium` and `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An argument is wrong; the message says which and what to give.
    /// FileError
    ///     The file cannot be written, or belongs to another sweep.
    /// ExecutorError
    ///     The executor's workers died; `resume` of the exception continues.
    ///
    /// Warns
    /// -----
    /// RobotWarning
    ///     The robot has a value that no usual robot has; once per call, before the rows are computed.
    #[pyo3(signature = (
        grid=None, quantities=None, *, poses=None, pose=None, lengths_m=None, static_model="catenary",
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given", up_to_hz=None,
        platform_share=None, payload_center_m=None, tension_rule=None, target_tension_n=None, min_tension_n=None,
        max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None, wind_m_s=None,
        cable_load_n_per_m=None, hold_lengths_of_pose=false, file=None, resume=false, discard=false, part=None,
        threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "Python\'s keywords")]
    fn map(
        &self,
        py: Python<'_>,
        grid: Option<Axes>,
        quantities: Option<Vec<String>>,
        poses: Option<Numbers>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        up_to_hz: Option<Number>,
        platform_share: Option<Number>,
        payload_center_m: Option<Numbers>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<ExecutorArgument>,
        chunks_per_task: Option<Count>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<SweepObject> {
        let state = StateKeywords {
            pose,
            lengths_m,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };

        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let model = model(cable_model, assembly, in_plane_only, winches)?;
        let point = sweep::each_point(quantities, up_to_hz, platform_share, payload_center_m, state, tensions, model)?;
        let grid = grid.map_or_else(Vec::new, |Axes(axes)| axes);
        let poses = poses.map(sweep::poses).transpose()?;
        let request = Request::Map(MapRequest { robot: self.source.clone(), grid, poses, point });

        let plan = PyPlan::of(py, request, part)?;
        RunKeywords { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// Computes quantities over values of the robot file, one row per combination, as the program's `sweep`.
    ///
    /// Parameters
    /// ----------
    /// vary
    ///     Values of the robot file that vary, by their paths as in `with_`: `{"platform.mass_kg": (10, 90, 81)}`. A
    ///     tuple is the first value, the last value and their number; anything else is values. The first path varies
    ///     fastest.
    ///
    /// The other parameters are those of `map`.
    #[pyo3(signature = (
        vary, quantities=None, *, pose=None, lengths_m=None, static_model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given", up_to_hz=None, platform_share=None,
        payload_center_m=None, tension_rule=None, target_tension_n=None, min_tension_n=None, max_tension_n=None,
        mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None, wind_m_s=None, cable_load_n_per_m=None,
        hold_lengths_of_pose=false, file=None, resume=false, discard=false, part=None, threads=None, executor=None,
        chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "Python\'s keywords")]
    fn sweep(
        &self,
        py: Python<'_>,
        vary: Axes,
        quantities: Option<Vec<String>>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        up_to_hz: Option<Number>,
        platform_share: Option<Number>,
        payload_center_m: Option<Numbers>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<ExecutorArgument>,
        chunks_per_task: Option<Count>,
        progress: Option<ProgressArgument>,
    ) -> PyResult<SweepObject> {
        let state = StateKeywords {
            pose,
            lengths_m,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };

        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let model = model(cable_model, assembly, in_plane_only, winches)?;
        let point = sweep::each_point(quantities, up_to_hz, platform_share, payload_center_m, state, tensions, model)?;
        let request = Request::Sweep(SweepRequest { robot: self.source.clone(), vary: vary.0, point });

        let plan = PyPlan::of(py, request, part)?;
        RunKeywords { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// Returns the robot as it was read, with the keys of the program's `check`; lists of numbers are arrays.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        answers::with_arrays(py, &analyses::check::run((*self.robot).clone()))
    }

    /// Returns every number of the robot file, with the keys of the program's `parameters`: `path`, `value`, `unit`,
    /// `range`, `minimum`, `maximum`, `meaning` and `given`. `Robot.with_` and `vary=` use the same paths.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        answers::plain(py, &analyses::parameters::run(&self.source).map_err(|error| errors::study(&error))?)
    }

    /// Computes the minimum and the maximum payload at a pose, with the cables whose tension limits bind.
    ///
    /// The payload is held by any tensions within the limits, not only by those of a tension rule. The pose need not be
    /// held without a payload.
    ///
    /// Parameters
    /// ----------
    /// payload_center_m
    ///     Centre of mass of the payload, platform frame [m]; that of the platform if not given.
    ///
    /// The other parameters are those of `equilibrium`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON: `minimum` and `maximum` with `payload_kg` and `cables`; without `maximum` if no
    /// maximum tension limits the payload.
    ///
    /// Raises
    /// ------
    /// StaticsError
    ///     No payload is held at this pose.
    #[pyo3(signature = (
        pose=None, lengths_m=None, static_model="catenary", tension_rule=None, *, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None, hold_lengths_of_pose=false, payload_center_m=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn payload<'py>(
        &self,
        py: Python<'py>,
        pose: Option<PoseLike>,
        lengths_m: Option<Numbers>,
        static_model: &str,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        mass_kg: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        wind_m_s: Option<Numbers>,
        cable_load_n_per_m: Option<Numbers>,
        hold_lengths_of_pose: bool,
        payload_center_m: Option<Numbers>,
    ) -> PyResult<TextKeyed<'py>> {
        let state = StateKeywords {
            pose,
            lengths_m,
            hold_lengths_of_pose,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let request = requests::PayloadRequest {
            robot: self.source.clone(),
            payload_center_m: payload_center_m.map(|center| center.three("payload_center_m")).transpose()?,
            state: state.request()?,
            tensions: TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n }.request()?,
        };
        let found = py.detach(|| analyses::payload::run((*self.robot).clone(), &request));
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Computes the distance of the poses of spring and catenary cables from those of ideal cables, over the platform
    /// mass.
    ///
    /// Parameters
    /// ----------
    /// mass_kg
    ///     First mass [kg], last mass [kg] and number of masses.
    /// lengths_m
    ///     Unstrained lengths of all masses [m], one per cable; those of the robot file if not given.
    /// pose
    ///     Pose instead of lengths: the lengths are those with which the robot, as it was read and before `with_`, rests
    ///     there. A robot file with a pose gives it if it is not given here.
    /// tension_rule, target_tension_n, min_tension_n, max_tension_n
    ///     Choice of the tensions at this pose, as in `equilibrium`.
    /// tolerance_mm
    ///     Distance between spring and catenary pose below which the spring is good enough [mm]; `threshold` then gives
    ///     the mass from which on this holds.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON: `points` with one entry for each mass.
    #[pyo3(signature = (
        mass_kg, *, lengths_m=None, pose=None, tension_rule=None, target_tension_n=None, min_tension_n=None,
        max_tension_n=None, tolerance_mm=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn pose_error<'py>(
        &self,
        py: Python<'py>,
        mass_kg: (Number, Number, Count),
        lengths_m: Option<Numbers>,
        pose: Option<PoseLike>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        tolerance_mm: Option<Number>,
    ) -> PyResult<TextKeyed<'py>> {
        let (from, to, count) = mass_kg;
        let max = analyses::pose_error::MAX_MASSES;
        let rule = format!("the third is the number of masses, from 2 to {max}");
        let request = requests::PoseErrorRequest {
            robot: self.source.clone(),
            mass_kg: (from.value("mass_kg[0]")?, to.value("mass_kg[1]")?, count.within("mass_kg[2]", 2..=max, &rule)?),
            lengths_m: lengths_m.map(|lengths| lengths.row("lengths_m")).transpose()?,
            pose: pose.map(|pose| pose.0),
            tensions: TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n }.request()?,
            tolerance_mm: tolerance_mm.map(|tolerance| tolerance.value("tolerance_mm")).transpose()?,
        };

        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            analyses::pose_error::run(&self.robot, &request, &mut watch).map_err(|error| watch.or(&error))
        })?;
        answers::with_arrays(py, &found)
    }

    /// Finds the values of the robot file that fit measurements best, with their deviations.
    ///
    /// Parameters
    /// ----------
    /// fit
    ///     Values to identify: a list of paths, or a mapping from paths to None, to bounds (minimum, maximum), or to a
    ///     mapping with `minimum`, `maximum`, `prior` and `prior_std`. A vector without a component stands for all its
    ///     numbers, and * for every name, as in `materials.*.mass_kg_per_m`.
    /// experiments
    ///     One mapping per state of the robot, or a single one: `responses` and `frequencies` as
    ///     `funicular.read_measurements` returns them, `measured_pose`, `measured_tensions_n`, `measured_lengths_m` with
    ///     their deviations, `cables` with the names of those that were mounted, and the keys of the state.
    /// starts
    ///     Number of starts of the search; the first one that fits ends it.
    /// from_hz, to_hz
    ///     Range of the responses that counts [Hz].
    /// response_noise, frequency_noise, damping_noise
    ///     Relative deviations of measurements that have none.
    /// rigid_cables
    ///     Natural frequencies with cables that are rigid in length; with the static model `ideal`.
    ///
    /// The other parameters are those of `equilibrium` and of `modes`; those of the state belong to every experiment that
    /// does not give them itself.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value, a path or a measurement is wrong.
    /// StaticsError
    ///     The robot has no equilibrium at any start.
    #[pyo3(signature = (
        fit, experiments, *, starts=10, from_hz=None, to_hz=None, response_noise=0.02, frequency_noise=0.01,
        damping_noise=0.1, rigid_cables=false, pose=None, lengths_m=None, static_model="catenary",
        hold_lengths_of_pose=false, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None, wind_m_s=None,
        cable_load_n_per_m=None, tension_rule=None, target_tension_n=None, min_tension_n=None, max_tension_n=None,
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn identify<'py>(
        &self,
        py: Python<'py>,
        fit: Bound<'py, PyAny>,
        experiments: Bound<'py, PyAny>,
        starts: usize,
        from_hz: Option<f64>,
        to_hz: Option<f64>,
        response_noise: f64,
        frequency_noise: f64,
        damping_noise: f64,
        rigid_cables: bool,
        pose: Option<Bound<'py, PyAny>>,
        lengths_m: Option<Bound<'py, PyAny>>,
        static_model: &str,
        hold_lengths_of_pose: bool,
        mass_kg: Option<f64>,
        force_n: Option<Bound<'py, PyAny>>,
        moment_n_m: Option<Bound<'py, PyAny>>,
        load_point_m: Option<Bound<'py, PyAny>>,
        wind_m_s: Option<Bound<'py, PyAny>>,
        cable_load_n_per_m: Option<Bound<'py, PyAny>>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Bound<'py, PyAny>>,
        min_tension_n: Option<f64>,
        max_tension_n: Option<f64>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<IdentifiedObject> {
        let keywords = PyDict::new(py);
        keywords.set_item("starts", starts)?;
        keywords.set_item("from_hz", from_hz)?;
        keywords.set_item("to_hz", to_hz)?;
        keywords.set_item("response_noise", response_noise)?;
        keywords.set_item("frequency_noise", frequency_noise)?;
        keywords.set_item("damping_noise", damping_noise)?;
        keywords.set_item("rigid_cables", rigid_cables)?;
        keywords.set_item("pose", pose)?;
        keywords.set_item("lengths_m", lengths_m)?;
        keywords.set_item("static_model", static_model)?;
        keywords.set_item("hold_lengths_of_pose", hold_lengths_of_pose)?;
        keywords.set_item("mass_kg", mass_kg)?;
        keywords.set_item("force_n", force_n)?;
        keywords.set_item("moment_n_m", moment_n_m)?;
        keywords.set_item("load_point_m", load_point_m)?;
        keywords.set_item("wind_m_s", wind_m_s)?;
        keywords.set_item("cable_load_n_per_m", cable_load_n_per_m)?;
        keywords.set_item("tension_rule", tension_rule)?;
        keywords.set_item("target_tension_n", target_tension_n)?;
        keywords.set_item("min_tension_n", min_tension_n)?;
        keywords.set_item("max_tension_n", max_tension_n)?;
        keywords.set_item("cable_model", cable_model)?;
        keywords.set_item("assembly", assembly)?;
        keywords.set_item("in_plane_only", in_plane_only)?;
        keywords.set_item("winches", winches)?;

        let robot = robot_text::to_json(&self.source)?;
        let module = py.import("funicular._identify")?;
        let request = module.call_method1("identify_request", (robot, fit, experiments, keywords))?;
        Ok(IdentifiedObject(module.call_method1("identified", (request,))?.unbind()))
    }

    /// Makes the request of a command of the program for this robot, as `funicular COMMAND --print-request` prints it.
    ///
    /// `funicular.run` runs the request.
    ///
    /// Parameters
    /// ----------
    /// command
    ///     Name of the command, such as `statics`.
    /// keywords
    ///     Options of the command by their names with _ in place of -, such as `tension_rule="middle"`.
    #[pyo3(signature = (command: "str", **keywords: "object"))]
    fn request<'py>(
        &self,
        py: Python<'py>,
        command: &str,
        keywords: Option<TextKeyed<'py>>,
    ) -> PyResult<TextKeyed<'py>> {
        let robot = robot_text::to_json(&self.source)?;
        let keywords = keywords.map_or_else(|| PyDict::new(py), |TextKeyed(keywords)| keywords);
        let made = py.import("funicular._study")?.call_method1("request", (command, robot, keywords))?;
        Ok(TextKeyed(made.cast_into()?))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.robot == other.robot
    }

    fn __hash__(&self) -> u64 {
        let bytes = self.robot.name.bytes().chain(self.robot.platform.mass.to_bits().to_le_bytes());
        bytes.fold(self.robot.cables.len() as u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    fn __repr__(&self) -> String {
        let Robot { name, platform, cables, .. } = &*self.robot;
        format!("<Robot {name:?}: {} cables, {} kg, {}>", cables.len(), platform.mass, platform.motion.name())
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("funicular._show")?.call_method1("html", (slf,))
    }

    // The text before `with_` and its changes are kept: `hold_lengths_of_pose` refers to that text.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<PickleParts<'py, (String,)>> {
        let rebuild = slf.py().import("funicular._funicular")?.getattr("robot_of_source")?;
        Ok((rebuild, (robot_text::to_json(&slf.get().source)?,)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}

/// Robot of the text and the changes that a pickle contains, as JSON.
#[pyfunction]
pub(crate) fn robot_of_source(py: Python<'_>, source: &str) -> PyResult<Py<PyRobot>> {
    PyRobot::read(py, robot_text::of_json(source)?)
}
