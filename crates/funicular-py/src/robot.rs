//! The robot: a text, and what the core read in it.

use crate::arrays::{Count, Keyed, Matrix, Number, Numbers, Reduced, Tensor, Vector};
use crate::batch;
use crate::edit;
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::pose::PoseLike;
use crate::request::{Asked, Given, Options};
use crate::sweep::{self, Axes, Makes, PointsAsked, PyPlan, Run, Settings, SweepObject, Told};
use crate::threads::Threads;
use crate::vibration::{self, ModesObject, Pair};
use funicular::robot::{Robot, State};
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::fs;
use std::io::{self, Read};
use std::path::PathBuf;
use std::sync::Arc;

/// The robot that the package carries.
const EXAMPLE: &str = include_str!("../../../robots/yuan2014-4mm.toml");
/// Largest robot file [bytes], as in the program: a cable takes some 200, so this is another file given by mistake.
const LARGEST: u64 = 16 << 20;

/// A cable-driven parallel robot, read from the text of a robot file (TOML); immutable.
///
/// Make one by `Robot.from_file`, `Robot.from_toml`, `Robot.from_dict` or `Robot.example`.
#[pyclass(frozen, name = "Robot", module = "funicular")]
pub(crate) struct PyRobot {
    pub(crate) text: String,
    pub(crate) robot: Arc<Robot>,
}

impl PyRobot {
    /// In the state of its file.
    fn at_rest(slf: Py<Self>, py: Python<'_>) -> PyResult<PyEquilibrium> {
        PyEquilibrium::of(py, slf, Asked::OfFile, Options::default())
    }

    fn read(text: String, name: &str) -> PyResult<Self> {
        match Robot::from_toml(&text) {
            Ok(robot) => Ok(Self { text, robot: Arc::new(robot) }),
            Err(error) => Err(errors::robot_file(&error, name, &text)),
        }
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
            fs::File::open(&path)?.take(LARGEST + 1).read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        let bytes: Vec<u8> = read().map_err(|error: io::Error| {
            io::Error::new(error.kind(), format!("cannot read the robot file {name}: {error}"))
        })?;
        if bytes.len() as u64 > LARGEST {
            return Err(errors::change(format!("{name} is larger than {} MiB: it is no robot file", LARGEST >> 20)));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to() + 1;
            errors::change(format!("{name} is no text: byte {at} is not UTF-8; a robot file is TOML in UTF-8"))
        })?;
        Self::read(text, &name)
    }

    /// Reads the text of a robot file.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The text is no robot; the message shows its lines.
    #[classmethod]
    fn from_toml(_cls: &Bound<'_, PyType>, text: String) -> PyResult<Self> {
        Self::read(text, "<text>")
    }

    /// Reads a dictionary with the keys of a robot file, as `to_dict` gives it.
    ///
    /// Raises
    /// ------
    /// RobotFileError
    ///     The dictionary is no robot; the message shows it as a file.
    #[classmethod]
    fn from_dict(_cls: &Bound<'_, PyType>, robot: Keyed<'_>) -> PyResult<Self> {
        Self::read(edit::of_dict(&robot.0)?, "<dict>")
    }

    /// The robot that the package carries: six cables of 4 mm (Yuan, Courteille and Deblaise 2014).
    #[classmethod]
    fn example(_cls: &Bound<'_, PyType>) -> PyResult<Self> {
        Self::read(EXAMPLE.to_owned(), "yuan2014-4mm.toml")
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
        Self::read(edit::with_values(&self.text, &all)?, "<changed robot>")
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
    fn freedoms(&self) -> &'static str {
        self.robot.platform.freedoms.name()
    }

    /// Names of the cables, in file order: the order of every array with one entry a cable.
    #[getter]
    fn cable_names(&self) -> Vec<&str> {
        self.robot.cables.iter().map(|cable| cable.name.as_str()).collect()
    }

    /// Anchors in the world [m], one row a cable.
    #[getter]
    fn anchors_m(&self) -> Matrix {
        Matrix::of_rows(self.robot.cables.iter().flat_map(|cable| cable.anchor_w.iter().copied()).collect(), 3)
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
    ///     lengths follow; of fewer cables than freedoms the nearest pose that they hold.
    /// lengths
    ///     Unstrained lengths [m], one a cable, in file order. The pose follows.
    ///     Without pose and lengths: the state of the robot file.
    /// model
    ///     How cables carry their load: `ideal`, `spring` or `catenary`.
    /// tension_rule
    ///     Which of the tensions that hold a pose, where more cables than freedoms leave a choice: `lowest` (the default),
    ///     `closest` (to `wanted_tension_n`), `middle` or `stiffest`.
    /// wanted_tension_n
    ///     Tensions for the rule `closest` [N], one for all or one a cable.
    /// min_tension_n, max_tension_n
    ///     Limits of the tension anywhere in a cable [N], instead of those of the robot file.
    /// force_n, moment_n_m, load_point_m
    ///     A dead load on the platform instead of that of the robot file: force and moment in world axes [N, N m], and the
    ///     point where the force acts, in the platform frame [m].
    ///
    /// Raises
    /// ------
    /// StaticsError
    ///     There is no such equilibrium; its `code` says in a word why not.
    /// InputError
    ///     An argument means nothing.
    #[pyo3(signature = (
        pose=None, lengths=None, model="catenary", tension_rule=None, *, wanted_tension_n=None, min_tension_n=None,
        max_tension_n=None, force_n=None, moment_n_m=None, load_point_m=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn equilibrium(
        slf: Py<Self>,
        py: Python<'_>,
        pose: Option<PoseLike>,
        lengths: Option<Numbers>,
        model: &str,
        tension_rule: Option<&str>,
        wanted_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
    ) -> PyResult<PyEquilibrium> {
        let options = Options::read(Given {
            model,
            tension_rule,
            wanted_tension_n,
            min_tension_n,
            max_tension_n,
            force_n,
            moment_n_m,
            load_point_m,
        })?;
        PyEquilibrium::of(py, slf, Asked::read(pose.map(|pose| pose.0), lengths)?, options)
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
    /// lengths
    ///     (n, m): unstrained lengths [m] of m cables.
    /// threads
    ///     How many threads compute; all processors if not given.
    ///
    /// The other parameters are those of `equilibrium`.
    #[pyo3(signature = (
        poses=None, lengths=None, model="catenary", tension_rule=None, *, wanted_tension_n=None, min_tension_n=None,
        max_tension_n=None, force_n=None, moment_n_m=None, load_point_m=None, threads=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn equilibria(
        &self,
        py: Python<'_>,
        poses: Option<Numbers>,
        lengths: Option<Numbers>,
        model: &str,
        tension_rule: Option<&str>,
        wanted_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        threads: Option<Threads>,
    ) -> PyResult<batch::Equilibria> {
        let options = Options::read(Given {
            model,
            tension_rule,
            wanted_tension_n,
            min_tension_n,
            max_tension_n,
            force_n,
            moment_n_m,
            load_point_m,
        })?;
        let states = batch::States::read(poses, lengths)?;
        batch::equilibria(py, &self.robot, states, &options, threads)
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
    /// pose, lengths
    ///     Where axes stay that the grid does not have: x, y, z [m] and roll, pitch, yaw [degrees], or unstrained lengths
    ///     [m]. As the robot file says if not given.
    /// up_to_hz
    ///     Where the search for natural frequencies ends [Hz].
    /// file
    ///     Write the rows to .parquet, .csv or .vti, as a whole; until then they are in FILE.partial and survive whatever
    ///     ends the program. Of a Parquet file nothing is in memory before it is asked for.
    /// resume, force
    ///     Go on with what FILE.partial holds of the same sweep, or forget it.
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
        grid=None, quantities=None, *, poses=None, pose=None, lengths=None, model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, up_to_hz=Number::of(funicular::sweep::HIGHEST_HZ), tension_rule=None,
        wanted_tension_n=None, min_tension_n=None, max_tension_n=None, force_n=None, moment_n_m=None, load_point_m=None,
        file=None, resume=false, force=false, threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn map(
        slf: Py<Self>,
        py: Python<'_>,
        grid: Option<Axes>,
        quantities: Option<Vec<String>>,
        poses: Option<Numbers>,
        pose: Option<Numbers>,
        lengths: Option<Numbers>,
        model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        up_to_hz: Number,
        tension_rule: Option<&str>,
        wanted_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        file: Option<PathBuf>,
        resume: bool,
        force: bool,
        threads: Option<Threads>,
        executor: Option<Makes>,
        chunks_per_task: Option<Count>,
        progress: Option<Told>,
    ) -> PyResult<SweepObject> {
        let points = match (grid, poses) {
            (Some(Axes(grid)), None) => PointsAsked::Grid(grid),
            (None, Some(poses)) => PointsAsked::Poses(sweep::poses(poses)?),
            _ => return Err(errors::input("give `grid` or `poses`, one of them".to_owned())),
        };
        let settings = Settings {
            quantities,
            statics: Given {
                model,
                tension_rule,
                wanted_tension_n,
                min_tension_n,
                max_tension_n,
                force_n,
                moment_n_m,
                load_point_m,
            },
            cable_model,
            assembly,
            in_plane_only,
            up_to_hz,
            pose,
            lengths,
        };
        let plan = PyPlan::of(slf, settings.request(points)?)?;
        Run { file, resume, force, threads, executor, chunks_per_task, progress }.rows(py, plan)
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
        vary, quantities=None, *, pose=None, lengths=None, model="catenary", cable_model=None,
        assembly="consistent", in_plane_only=false, up_to_hz=Number::of(funicular::sweep::HIGHEST_HZ), tension_rule=None,
        wanted_tension_n=None, min_tension_n=None, max_tension_n=None, force_n=None, moment_n_m=None, load_point_m=None,
        file=None, resume=false, force=false, threads=None, executor=None, chunks_per_task=None, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn sweep(
        slf: Py<Self>,
        py: Python<'_>,
        vary: Axes,
        quantities: Option<Vec<String>>,
        pose: Option<Numbers>,
        lengths: Option<Numbers>,
        model: &str,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        up_to_hz: Number,
        tension_rule: Option<&str>,
        wanted_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        force_n: Option<Numbers>,
        moment_n_m: Option<Numbers>,
        load_point_m: Option<Numbers>,
        file: Option<PathBuf>,
        resume: bool,
        force: bool,
        threads: Option<Threads>,
        executor: Option<Makes>,
        chunks_per_task: Option<Count>,
        progress: Option<Told>,
    ) -> PyResult<SweepObject> {
        let points = PointsAsked::Vary(vary.0);
        let settings = Settings {
            quantities,
            statics: Given {
                model,
                tension_rule,
                wanted_tension_n,
                min_tension_n,
                max_tension_n,
                force_n,
                moment_n_m,
                load_point_m,
            },
            cable_model,
            assembly,
            in_plane_only,
            up_to_hz,
            pose,
            lengths,
        };
        let plan = PyPlan::of(slf, settings.request(points)?)?;
        Run { file, resume, force, threads, executor, chunks_per_task, progress }.rows(py, plan)
    }

    /// `Equilibrium.stiffness` in the state of the robot file.
    #[pyo3(signature = (hz=None, *, cable_model=None, assembly="consistent", in_plane_only=false))]
    fn stiffness(
        slf: Py<Self>,
        py: Python<'_>,
        hz: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
    ) -> PyResult<vibration::Stiffness> {
        vibration::stiffness(py, &Self::at_rest(slf, py)?, hz, cable_model, assembly, in_plane_only)
    }

    /// `Equilibrium.modes` in the state of the robot file.
    #[pyo3(signature = (below_hz, *, cable_model=None, assembly="consistent", in_plane_only=false, damped=true))]
    fn modes(
        slf: Py<Self>,
        py: Python<'_>,
        below_hz: Number,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        damped: bool,
    ) -> PyResult<ModesObject> {
        vibration::modes(py, &Self::at_rest(slf, py)?, below_hz, cable_model, assembly, in_plane_only, damped)
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

    fn __eq__(&self, other: &Self) -> bool {
        self.robot == other.robot
    }

    fn __hash__(&self) -> u64 {
        let bytes = self.robot.name.bytes().chain(self.robot.platform.mass.to_bits().to_le_bytes());
        bytes.fold(self.robot.cables.len() as u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    fn __repr__(&self) -> String {
        let Robot { name, platform, cables, .. } = &*self.robot;
        format!("<Robot {name:?}: {} cables, {} kg, {}>", cables.len(), platform.mass, platform.freedoms.name())
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
