//! The robot: a text, and what the core read in it.

use crate::answers::{self, CtrlC};
use crate::arrays::{Count, Keyed, Matrix, Number, Numbers, Reduced, Tensor, Vector};
use crate::batch;
use crate::edit;
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::pose::PoseLike;
use crate::request::{StateKeywords, TensionKeywords, model};
use crate::sweep::{self, Axes, Makes, PyPlan, Run, SweepObject, Told};
use crate::threads::Threads;
use crate::vibration::{self, ModesKeywords, ModesObject, Pair};
use crate::written::{self, PageKeywords, ReduceKeywords};
use funicular::robot::{Robot, State};
use funicular_study::analyses;
use funicular_study::request::{self as requests, EachPoint, MapRequest, Request, RobotText, SweepRequest, Tensions};
use funicular_study::robot_file::{self, MAX_BYTES, RobotFile};
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::fs;
use std::io::{self, Read};
use std::path::PathBuf;
use std::sync::Arc;

/// Quantities and options of every point, as Python gives them.
fn each_point(
    quantities: Option<Vec<String>>,
    up_to_hz: Number,
    state: StateKeywords<'_>,
    tensions: TensionKeywords<'_>,
    model: requests::Model,
) -> PyResult<EachPoint> {
    Ok(EachPoint {
        quantities: quantities.unwrap_or_else(EachPoint::default_quantities),
        up_to_hz: up_to_hz.value("up_to_hz")?,
        state: state.request()?,
        tensions: tensions.request()?,
        model,
    })
}

/// A cable-driven parallel robot, read from the text of a robot file (TOML); immutable.
///
/// Make one by `Robot.from_file`, `Robot.from_toml`, `Robot.from_dict` or `Robot.example`.
#[pyclass(frozen, name = "Robot", module = "funicular")]
pub(crate) struct PyRobot {
    /// As a request has it.
    pub(crate) source: RobotText,
    /// The text with its changes.
    pub(crate) text: String,
    pub(crate) robot: Arc<Robot>,
}

impl PyRobot {
    /// In the state of its file.
    fn at_rest(slf: Py<Self>, py: Python<'_>) -> PyResult<PyEquilibrium> {
        PyEquilibrium::of(py, slf, requests::State::default(), Tensions::default())
    }

    fn read(source: RobotText) -> PyResult<Self> {
        let RobotFile { robot, text, .. } = source.read().map_err(|error| errors::study(&error))?;
        Ok(Self { source, text, robot: Arc::new(robot) })
    }

    fn of_text(name: &str, text: String) -> PyResult<Self> {
        Self::read(RobotText { name: name.to_owned(), text, set: Vec::new() })
    }
}

#[pymethods]
impl PyRobot {
    /// Reads a robot file.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The file is no robot; the message shows its lines.
    /// OSError
    ///     The file cannot be read.
    #[classmethod]
    fn from_file(_cls: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        let name = path.display().to_string();
        let read = || {
            let mut bytes = Vec::new();
            fs::File::open(&path)?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        let bytes: Vec<u8> = read().map_err(|error: io::Error| {
            io::Error::new(error.kind(), format!("cannot read the robot file {name}: {error}"))
        })?;
        let text = robot_file::decode(&name, bytes).map_err(|error| errors::change(format!("{error:#}")))?;
        Self::of_text(&name, text)
    }

    /// Reads the text of a robot file.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The text is no robot; the message shows its lines.
    #[classmethod]
    fn from_toml(_cls: &Bound<'_, PyType>, text: String) -> PyResult<Self> {
        Self::of_text("<text>", text)
    }

    /// Reads a dictionary with the keys of a robot file, as `to_dict` gives it.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The dictionary is no robot; the message shows it as a file.
    #[classmethod]
    fn from_dict(_cls: &Bound<'_, PyType>, robot: Keyed<'_>) -> PyResult<Self> {
        Self::of_text("<dict>", dict_to_toml::of_dict(&robot.0)?)
    }

    /// The robot that the package carries: six cables of 4 mm (Yuan, Courteille and Deblaise 2014).
    #[classmethod]
    fn example(_cls: &Bound<'_, PyType>) -> PyResult<Self> {
        Self::read(RobotText::embedded())
    }

    /// The text of the robot file, with all changes that were made.
    fn to_toml(&self) -> &str {
        &self.text
    }

    /// The robot file as a dictionary.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Keyed<'py>> {
        let text = self.text.trim_start_matches('\u{feff}');
        Ok(Keyed(py.import("tomllib")?.call_method1("loads", (text,))?.cast_into()?))
    }

    /// This robot with other values.
    ///
    /// Parameters
    /// ----------
    /// changes
    ///     New values by their paths in the robot file, as of the program's `--set`, cables by their names:
    ///     `{"materials.rope-4mm.diameter_m": 0.008, "cables.3.unstrained_length_m": 6.7}`.
    /// mass_kg
    ///     Mass of the platform [kg]; inertia and centre of mass stay.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     There is no such place in the file, or the value is not one for it.
    #[pyo3(signature = (changes=None, *, mass_kg=None))]
    fn with_(&self, py: Python<'_>, changes: Option<Keyed<'_>>, mass_kg: Option<Number>) -> PyResult<Self> {
        let all = PyDict::new(py);
        if let Some(Keyed(changes)) = changes {
            all.update(changes.as_mapping())?;
        }
        if let Some(mass) = mass_kg {
            all.set_item("platform.mass_kg", mass.positive("mass_kg")?)?;
        }
        let mut source = self.source.clone();
        source.set.extend(dict_to_toml::changes(&all)?);
        Self::read(source)
    }

    /// What the robot is called.
    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    /// Where its numbers come from.
    #[getter]
    fn source(&self) -> &str {
        &self.robot.source
    }

    /// Mass of the platform [kg].
    #[getter]
    fn mass_kg(&self) -> f64 {
        self.robot.platform.mass
    }

    /// Which motions the platform has: `rigid`, `point-mass` or a plane.
    #[getter]
    fn motion(&self) -> &'static str {
        self.robot.platform.motion.name()
    }

    /// Names of the cables, in file order: the order of every array with one entry a cable.
    #[getter]
    fn cable_names(&self) -> Vec<&str> {
        self.robot.cables.iter().map(|cable| cable.name.as_str()).collect()
    }

    /// Anchors in the world [m], one row a cable.
    #[getter]
    fn anchors_m(&self) -> Matrix {
        Matrix::of_rows(
            self.robot.cables.iter().flat_map(|cable| <[f64; 3]>::from(cable.anchor.reference_w())).collect(),
            3,
        )
    }

    /// Attachments in the platform frame [m], one row a cable.
    #[getter]
    fn attachments_m(&self) -> Matrix {
        Matrix::of_rows(self.robot.cables.iter().flat_map(|cable| cable.attachment_p.iter().copied()).collect(), 3)
    }

    /// Unstrained lengths that the file gives [m], one a cable; None where it gives a pose or no state.
    #[getter]
    fn lengths(&self) -> Option<Vector> {
        match &self.robot.state {
            State::Lengths(lengths) => Some(lengths.iter().copied().collect()),
            State::Pose(_) | State::Unknown => None,
        }
    }

    /// The robot at rest.
    ///
    /// Parameters
    /// ----------
    /// pose
    ///     A `Pose`, or x, y, z, or these and roll, pitch, yaw [m, degrees], or these and a quaternion w, x, y, z. The
    ///     lengths follow; of fewer cables than degrees of freedom the nearest pose that they hold.
    /// lengths_m
    ///     Unstrained lengths [m], one a cable, in file order. The pose follows.
    ///     Without pose and lengths: the state of the robot file.
    /// static_model
    ///     How cables carry their load: `ideal`, `spring` or `catenary`.
    /// tension_rule
    ///     Which of the tensions that hold a pose, where more cables than degrees of freedom leave a choice: `lowest` (the default),
    ///     `closest` (to `target_tension_n`), `middle` or `stiffest`.
    /// target_tension_n
    ///     Tensions for the rule `closest` [N], one for all or one a cable.
    /// min_tension_n, max_tension_n
    ///     Limits of the tension anywhere in a cable [N], instead of those of the robot file.
    /// mass_kg
    ///     Mass of the platform [kg] instead of that of the robot file.
    /// force_n, moment_n_m, load_point_m
    ///     A dead load on the platform instead of that of the robot file: force and moment in world axes [N, N m], and the
    ///     point where the force acts, in the platform frame [m].
    /// wind_m_s
    ///     Velocity of the wind instead of that of the robot file, world axes [m/s].
    /// cable_load_n_per_m
    ///     Load per metre of every cable besides its weight, world axes [N/m].
    ///
    /// Raises
    /// ------
    /// StaticsError
    ///     There is no such equilibrium; its `code` says in a word why not.
    /// InputError
    ///     An argument means nothing.
    #[pyo3(signature = (
        pose=None, lengths_m=None, static_model="catenary", tension_rule=None, *, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None
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
    ) -> PyResult<PyEquilibrium> {
        let state = StateKeywords {
            pose,
            lengths_m,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        PyEquilibrium::of(py, slf, state.request()?, tensions.request()?)
    }

    /// The robot at rest in many states, computed side by side without Python's lock.
    ///
    /// A state without equilibrium is a row with its reason, never an exception. Each row is, bit for bit, what
    /// `equilibrium` gives.
    ///
    /// Parameters
    /// ----------
    /// poses
    ///     (n, 3), (n, 6) or (n, 7): x, y, z [m], roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
    /// lengths_m
    ///     (n, m): unstrained lengths [m] of m cables.
    /// threads
    ///     How many threads compute; all processors if not given.
    ///
    /// The other parameters are those of `equilibrium`.
    #[pyo3(signature = (
        poses=None, lengths_m=None, static_model="catenary", tension_rule=None, *, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None, load_point_m=None,
        wind_m_s=None, cable_load_n_per_m=None, threads=None
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
        threads: Option<Threads>,
    ) -> PyResult<batch::Equilibria> {
        let states = batch::States::read(poses, lengths_m)?;
        let state = StateKeywords {
            pose: None,
            lengths_m: None,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        batch::equilibria(py, &self.robot, states, &state.request()?, &tensions.request()?, threads)
    }

    /// Quantities over poses, one row a pose.
    ///
    /// The rows are those of the program's `map`, bit for bit, whatever computes them. A pose without equilibrium is a row
    /// with its reason, never an exception.
    ///
    /// Parameters
    /// ----------
    /// grid
    ///     Values along axes x, y, z [m], roll, pitch, yaw [degrees]: `{"x": (-4, 4, 81), "z": [0.5, 1, 2]}`; a tuple is
    ///     first, last and how many, anything else is values. x runs fastest, then y and so on.
    /// quantities
    ///     What to compute, docs/sweeps.md has the list; tension-min and tension-max if not given.
    /// poses
    ///     Instead of a grid (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
    /// pose, lengths_m
    ///     Where axes stay that the grid does not have: x, y, z [m] and roll, pitch, yaw [degrees], or unstrained lengths
    ///     [m]. As the robot file says if not given.
    /// up_to_hz
    ///     Where the search for natural frequencies ends [Hz].
    /// file
    ///     Write the rows to .parquet, .csv or .vti, as a whole; until then they are in FILE.partial and survive whatever
    ///     ends the program. Of a Parquet file nothing is in memory before it is asked for.
    /// resume, discard
    ///     Go on with what FILE.partial holds of the same sweep, or forget it.
    /// part
    ///     The k-th of n parts, as "3/8", each with a Parquet `file` of its own; `funicular.merge` joins them.
    /// threads
    ///     How many threads compute here; all processors if not given.
    /// executor
    ///     Compute in the workers of an executor (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
    ///     `MPIPoolExecutor`), or of a function that makes one, which is called again when it breaks.
    /// chunks_per_task
    ///     Chunks of rows that a worker gets at once; by default what takes some seconds, as measured on the way.
    /// progress
    ///     Is called now and then with the rows there are and all rows.
    ///
    /// The other parameters are those of `equilibrium` and `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An argument means nothing.
    /// FileError
    ///     The file cannot be written, or belongs to another sweep.
    /// ExecutorError
    ///     The executor's workers died; its `resume` goes on.
    #[pyo3(signature = (
        grid=None, quantities=None, *, poses=None, pose=None, lengths_m=None, static_model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, up_to_hz=Number::of(funicular_study::sweep::MAX_HZ), tension_rule=None,
        target_tension_n=None, min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None,
        load_point_m=None, wind_m_s=None, cable_load_n_per_m=None, file=None, resume=false, discard=false, part=None,
        threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
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
        up_to_hz: Number,
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
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<Makes>,
        chunks_per_task: Option<Count>,
        progress: Option<Told>,
    ) -> PyResult<SweepObject> {
        let state = StateKeywords {
            pose,
            lengths_m,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let point = each_point(quantities, up_to_hz, state, tensions, model(cable_model, assembly, in_plane_only)?)?;
        let grid = grid.map_or_else(Vec::new, |Axes(axes)| axes);
        let poses = poses.map(sweep::poses).transpose()?;
        let request = Request::Map(MapRequest { robot: self.source.clone(), grid, poses, point });
        let plan = PyPlan::of(py, request, part)?;
        Run { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// Quantities over values of the robot file, one row a combination, as of the program's `sweep`.
    ///
    /// Parameters
    /// ----------
    /// vary
    ///     Values by their paths in the robot file, as of `with_`: `{"platform.mass_kg": (10, 90, 81)}`; a tuple is first,
    ///     last and how many, anything else is values. The first runs fastest.
    ///
    /// The other parameters are those of `map`.
    #[pyo3(signature = (
        vary, quantities=None, *, pose=None, lengths_m=None, static_model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, up_to_hz=Number::of(funicular_study::sweep::MAX_HZ), tension_rule=None,
        target_tension_n=None, min_tension_n=None, max_tension_n=None, mass_kg=None, force_n=None, moment_n_m=None,
        load_point_m=None, wind_m_s=None, cable_load_n_per_m=None, file=None, resume=false, discard=false, part=None,
        threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
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
        up_to_hz: Number,
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
        file: Option<PathBuf>,
        resume: bool,
        discard: bool,
        part: Option<String>,
        threads: Option<Threads>,
        executor: Option<Makes>,
        chunks_per_task: Option<Count>,
        progress: Option<Told>,
    ) -> PyResult<SweepObject> {
        let state = StateKeywords {
            pose,
            lengths_m,
            mass_kg,
            static_model,
            force_n,
            moment_n_m,
            load_point_m,
            wind_m_s,
            cable_load_n_per_m,
        };
        let tensions = TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n };
        let point = each_point(quantities, up_to_hz, state, tensions, model(cable_model, assembly, in_plane_only)?)?;
        let request = Request::Sweep(SweepRequest { robot: self.source.clone(), vary: vary.0, point });
        let plan = PyPlan::of(py, request, part)?;
        Run { file, resume, discard, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// The robot as it was read, with the keys of the program's `check`; lists of numbers are arrays.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Keyed<'py>> {
        answers::with_arrays(py, &analyses::check::run((*self.robot).clone()))
    }

    /// Every number of the robot file, with the keys of the program's `parameters`: `path`, `value`, `unit`, `range`,
    /// `minimum`, `maximum`, `meaning` and `given`. The paths are those of `Robot.with_` and of `vary=`.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Keyed<'py>> {
        answers::plain(py, &analyses::parameters::run(&self.source).map_err(|error| errors::study(&error))?)
    }

    /// How far the poses of spring and catenary cables are from those of ideal ones, over the mass of the platform.
    ///
    /// Parameters
    /// ----------
    /// mass_kg
    ///     First mass, last mass [kg] and number of masses.
    /// lengths_m
    ///     Unstrained lengths [m], which fix the comparison; those of the robot file if not given.
    /// tolerance_mm
    ///     Distance between spring and catenary pose from which on the spring is good enough [mm]; `threshold` then says
    ///     from which mass on.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON: `points` with one entry for each mass.
    #[pyo3(signature = (mass_kg, *, lengths_m=None, tolerance_mm=None))]
    fn pose_error<'py>(
        &self,
        py: Python<'py>,
        mass_kg: (Number, Number, Count),
        lengths_m: Option<Numbers>,
        tolerance_mm: Option<Number>,
    ) -> PyResult<Keyed<'py>> {
        let (from, to, count) = mass_kg;
        let most = analyses::pose_error::MAX_MASSES;
        let rule = format!("the third is how many masses there are, from 2 to {most}");
        let request = requests::PoseErrorRequest {
            robot: self.source.clone(),
            mass_kg: (from.value("mass_kg[0]")?, to.value("mass_kg[1]")?, count.within("mass_kg[2]", 2..=most, &rule)?),
            lengths_m: lengths_m.map(|lengths| lengths.row("lengths_m")).transpose()?,
            tolerance_mm: tolerance_mm.map(|tolerance| tolerance.value("tolerance_mm")).transpose()?,
        };
        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            analyses::pose_error::run(&self.robot, &request, &mut watch).map_err(|error| watch.or(&error))
        })?;
        answers::with_arrays(py, &found)
    }

    /// The request of a command of the program for this robot: what `funicular COMMAND --print-request` prints, as
    /// `funicular.run` takes it.
    ///
    /// Parameters
    /// ----------
    /// command
    ///     Name of the command, as `statics`.
    /// keywords
    ///     The command's options by their names with _ for -, as `tension_rule="middle"`.
    #[pyo3(signature = (command: "str", **keywords: "object"))]
    fn request<'py>(&self, py: Python<'py>, command: &str, keywords: Option<Keyed<'py>>) -> PyResult<Keyed<'py>> {
        let robot = serde_json::to_string(&self.source).map_err(|error| errors::input(error.to_string()))?;
        let keywords = keywords.map_or_else(|| PyDict::new(py), |Keyed(keywords)| keywords);
        let made = py.import("funicular._study")?.call_method1("request", (command, robot, keywords))?;
        Ok(Keyed(made.cast_into()?))
    }

    /// `Equilibrium.stiffness` in the state of the robot file.
    #[pyo3(signature = (at_hz=None, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn stiffness(
        slf: Py<Self>,
        py: Python<'_>,
        at_hz: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<vibration::Stiffness> {
        vibration::stiffness(py, &Self::at_rest(slf, py)?, at_hz, cable_model, assembly, in_plane_only)
    }

    /// `Equilibrium.modes` in the state of the robot file.
    #[pyo3(signature = (
        below_hz, *, input=None, output=None, input_point_m=None, output_point_m=None, stations=None, cable_model=None,
        assembly="consistent", in_plane_only=false, damped=true
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn modes(
        slf: Py<Self>,
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
        vibration::modes(py, &Self::at_rest(slf, py)?, keywords)
    }

    /// `Equilibrium.frf` in the state of the robot file.
    #[pyo3(signature = (
        hz, input, output, *, input_point_m=None, output_point_m=None, cable_model=None, assembly="consistent",
        in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn frf(
        slf: Py<Self>,
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
        vibration::frf(py, &Self::at_rest(slf, py)?, hz, pair, cable_model, assembly, in_plane_only)
    }

    /// `Equilibrium.receptance` in the state of the robot file.
    #[pyo3(signature = (hz, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn receptance(
        slf: Py<Self>,
        py: Python<'_>,
        hz: Numbers,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<Tensor<Complex64>> {
        vibration::receptance(py, &Self::at_rest(slf, py)?, hz, cable_model, assembly, in_plane_only)
    }

    /// `Equilibrium.all_equilibria` in the state of the robot file.
    fn all_equilibria(slf: Py<Self>, py: Python<'_>) -> PyResult<Keyed<'_>> {
        Self::at_rest(slf, py)?.all_equilibria(py)
    }

    /// `Equilibrium.compare` in the state of the robot file.
    #[pyo3(signature = (below_hz, *, assembly="consistent", in_plane_only=false))]
    fn compare<'py>(
        slf: Py<Self>,
        py: Python<'py>,
        below_hz: Number,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<Keyed<'py>> {
        vibration::compare(py, &Self::at_rest(slf, py)?, below_hz, assembly, in_plane_only)
    }

    /// `Equilibrium.cable` in the state of the robot file.
    #[pyo3(signature = (name, hz, *, cable_model=None, in_plane_only=false))]
    fn cable<'py>(
        slf: Py<Self>,
        py: Python<'py>,
        name: &str,
        hz: Numbers,
        cable_model: Option<&str>,
        in_plane_only: bool,
    ) -> PyResult<Keyed<'py>> {
        vibration::cable(py, &Self::at_rest(slf, py)?, name, hz, cable_model, in_plane_only)
    }

    /// `Equilibrium.reduce` in the state of the robot file.
    #[pyo3(signature = (
        below_hz, input=None, output=None, *, input_point_m=None, output_point_m=None, tolerance=Number::of(1e-3),
        damping_at_hz=None, cable_model=None, assembly="consistent", in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn reduce(
        slf: Py<Self>,
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
        written::reduce(py, &Self::at_rest(slf, py)?, keywords)
    }

    /// `Equilibrium.export` in the state of the robot file.
    #[pyo3(signature = (to, path, *, segments=Count::of(20), modes_below_hz=None))]
    fn export(
        slf: Py<Self>,
        py: Python<'_>,
        to: &str,
        path: PathBuf,
        segments: Count,
        modes_below_hz: Option<Number>,
    ) -> PyResult<Vec<String>> {
        written::export(py, &Self::at_rest(slf, py)?, to, path, segments, modes_below_hz)
    }

    /// `Equilibrium.report` in the state of the robot file.
    #[pyo3(signature = (
        path=None, *, below_hz=Number::of(20.0), input=None, output=None, input_point_m=None, output_point_m=None,
        cable_model=None, assembly="consistent", in_plane_only=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn report(
        slf: Py<Self>,
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
        written::report(py, &Self::at_rest(slf, py)?, path, keywords)
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
        slf.py().import("funicular._html")?.call_method1("robot", (slf,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py, (String,)>> {
        let rebuild = slf.get_type().getattr("from_toml")?;
        Ok((rebuild, (slf.get().text.clone(),)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}
