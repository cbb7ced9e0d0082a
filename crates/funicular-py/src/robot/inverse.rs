//! Methods that find values of the robot file.

use super::PyRobot;
use crate::robot_text;
use crate::written::{DesignedObject, IdentifiedObject};
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
    ///     `funicular.read_measurements` returns them, `measured_pose`, `measured_tensions_n`, `measured_lengths_m`
    ///     with their deviations, `cables` with the names of those that were mounted, and the keys of the state.
    /// starts
    ///     Number of starts of the search, 10 if not given; the first one that fits ends it.
    /// from_hz, to_hz
    ///     Range of the responses that counts [Hz].
    /// response_noise, frequency_noise, damping_noise
    ///     Relative deviations of measurements that have none; 0.02, 0.01 and 0.1 if not given.
    /// rigid_cables
    ///     Natural frequencies with cables that are rigid in length; with the static model `ideal`.
    /// profile
    ///     Paths of fitted values whose interval of 95 % is also found by holding the value and fitting the others
    ///     again; `details["values"]` has it under `profile`. * stands for any key.
    ///
    /// The other parameters are those of `equilibrium` and of `modes`; those of the state belong to every experiment
    /// that does not give them itself.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value, a path or a measurement is wrong.
    /// StaticsError
    ///     The robot has no equilibrium at any start.
    #[pyo3(signature = (
        fit, experiments, *, starts=None, from_hz=None, to_hz=None, response_noise=None, frequency_noise=None,
        damping_noise=None, rigid_cables=false, profile=None, pose=None, lengths_m=None, static_model="catenary",
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
        starts: Option<Bound<'py, PyAny>>,
        from_hz: Option<Bound<'py, PyAny>>,
        to_hz: Option<Bound<'py, PyAny>>,
        response_noise: Option<Bound<'py, PyAny>>,
        frequency_noise: Option<Bound<'py, PyAny>>,
        damping_noise: Option<Bound<'py, PyAny>>,
        rigid_cables: bool,
        profile: Option<Bound<'py, PyAny>>,
        pose: Option<Bound<'py, PyAny>>,
        lengths_m: Option<Bound<'py, PyAny>>,
        static_model: &str,
        hold_lengths_of_pose: bool,
        mass_kg: Option<Bound<'py, PyAny>>,
        force_n: Option<Bound<'py, PyAny>>,
        moment_n_m: Option<Bound<'py, PyAny>>,
        load_point_m: Option<Bound<'py, PyAny>>,
        wind_m_s: Option<Bound<'py, PyAny>>,
        cable_load_n_per_m: Option<Bound<'py, PyAny>>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Bound<'py, PyAny>>,
        min_tension_n: Option<Bound<'py, PyAny>>,
        max_tension_n: Option<Bound<'py, PyAny>>,
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
        keywords.set_item("profile", profile)?;
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
        keywords.set_item("fit", fit)?;
        let module = py.import("funicular._identify")?;
        let request = module.call_method1("identify_request", (robot, self.names(), experiments, keywords))?;
        Ok(IdentifiedObject(module.call_method1("identified", (request,))?.unbind()))
    }

    /// Chooses values of the robot file with which the robot is best at several poses.
    ///
    /// The poses are held, and the tensions of more cables than degrees of freedom follow `tension_rule`. The values
    /// move within their bounds until the goal improves no further.
    ///
    /// Parameters
    /// ----------
    /// change
    ///     Values to choose: a mapping from paths to the largest change to both sides, or to bounds (minimum, maximum).
    ///     A vector without a component stands for all its numbers, and * for every name, as in
    ///     `cables.*.attachment_m`.
    /// goal
    ///     `first` natural frequency, first natural frequency of the `platform` on the static stiffness of its cables,
    ///     minimum `stiffness`, `rope-mass` or `rope-length`.
    /// poses
    ///     Poses (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees]; the worst one counts. If not given: `pose`,
    ///     or the pose of the robot file.
    /// weights
    ///     Weights (n,) for the mean of the poses instead of the worst one.
    /// min_frequency_hz, min_stiffness_n_per_m
    ///     Demands on the first natural frequency [Hz] and on the minimum stiffness [N/m] at every pose.
    /// avoid_hz
    ///     Band (first, last) without natural frequencies at every pose [Hz].
    /// max_iterations
    ///     Maximum number of iterations; 50 if not given.
    ///
    /// The other parameters are those of `equilibrium` and of `modes`.
    ///
    /// Returns
    /// -------
    /// Result with `x`, `fun`, `success`, `message`, `nit` as those of `scipy.optimize`, with the values per pose, and
    /// with `robot`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A value, a path or a bound is wrong.
    /// StaticsError
    ///     A pose has no equilibrium, or no values within the bounds meet all demands; the message says what was
    ///     reached.
    ///
    /// References
    /// ----------
    /// docs/theory.md, equations (60r) to (60t) and (95a) to (95c).
    #[pyo3(signature = (
        change, *, goal="first", poses=None, weights=None, min_frequency_hz=None, min_stiffness_n_per_m=None, avoid_hz=None,
        max_iterations=None, pose=None, static_model="catenary", mass_kg=None, force_n=None, moment_n_m=None,
        load_point_m=None, wind_m_s=None, cable_load_n_per_m=None, tension_rule=None, target_tension_n=None,
        min_tension_n=None, max_tension_n=None, cable_model=None, assembly="consistent", in_plane_only=false,
        winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn design<'py>(
        &self,
        py: Python<'py>,
        change: Bound<'py, PyAny>,
        goal: &str,
        poses: Option<Bound<'py, PyAny>>,
        weights: Option<Bound<'py, PyAny>>,
        min_frequency_hz: Option<Bound<'py, PyAny>>,
        min_stiffness_n_per_m: Option<Bound<'py, PyAny>>,
        avoid_hz: Option<Bound<'py, PyAny>>,
        max_iterations: Option<Bound<'py, PyAny>>,
        pose: Option<Bound<'py, PyAny>>,
        static_model: &str,
        mass_kg: Option<Bound<'py, PyAny>>,
        force_n: Option<Bound<'py, PyAny>>,
        moment_n_m: Option<Bound<'py, PyAny>>,
        load_point_m: Option<Bound<'py, PyAny>>,
        wind_m_s: Option<Bound<'py, PyAny>>,
        cable_load_n_per_m: Option<Bound<'py, PyAny>>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Bound<'py, PyAny>>,
        min_tension_n: Option<Bound<'py, PyAny>>,
        max_tension_n: Option<Bound<'py, PyAny>>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<DesignedObject> {
        let keywords = PyDict::new(py);
        keywords.set_item("goal", goal)?;
        keywords.set_item("poses", poses)?;
        keywords.set_item("weights", weights)?;
        keywords.set_item("min_frequency_hz", min_frequency_hz)?;
        keywords.set_item("min_stiffness_n_per_m", min_stiffness_n_per_m)?;
        keywords.set_item("avoid_hz", avoid_hz)?;
        keywords.set_item("max_iterations", max_iterations)?;
        keywords.set_item("pose", pose)?;
        keywords.set_item("static_model", static_model)?;
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

        keywords.set_item("change", change)?;
        let robot = robot_text::to_json(&self.source)?;
        let request =
            py.import("funicular._study")?.call_method1("request", ("design", robot, self.names(), keywords))?;
        Ok(DesignedObject(py.import("funicular._design")?.call_method1("designed", (request,))?.unbind()))
    }
}
