//! `funicular.Robot`: the text of a robot file and the robot that the core has read from it.

mod computed;

use crate::analyses::PyAnalyses;
use crate::answers;
use crate::arrays::{Matrix, Number, PickleParts, ResultsObject, TextKeyed, Vector};
use crate::dict_to_toml;
use crate::errors;
use crate::robot_text;
use funicular::robot::{Robot, State};
use funicular_study::analyses;
use funicular_study::request::RobotText;
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

    /// Names of the cables, in the order of the file.
    pub(crate) fn names(&self) -> Vec<String> {
        self.robot.cables.iter().map(|cable| cable.name.clone()).collect()
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

    /// Returns the robot as it was read, with the keys of the program's `check`; lists of numbers are arrays.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        answers::with_arrays(py, &analyses::check::run((*self.robot).clone()))
    }

    /// Returns every number of the robot file, with the keys of the program's `parameters`: `path`, `value`, `unit`,
    /// `range`, `minimum`, `maximum`, `meaning`, `label` (name in words with the unit) and `given`.
    /// `Robot.with_` and `vary=` use the same paths.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        answers::plain(py, &analyses::parameters::run(&self.source).map_err(|error| errors::study(&error))?)
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
        let made = py.import("funicular._study")?.call_method1("request", (command, robot, self.names(), keywords))?;
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

/// Returns the robots of the library: names, and texts of their files.
#[pyfunction]
pub(crate) fn library() -> Vec<(&'static str, &'static str)> {
    funicular_robots::ALL.to_vec()
}
