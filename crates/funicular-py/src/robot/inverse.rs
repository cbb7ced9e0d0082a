//! Methods that find values of the robot file.

use super::PyRobot;
use crate::robot_text;
use crate::written::IdentifiedObject;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyRobot {
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
}
