//! `funicular.Estimator`: the state of a robot from its sensors, inside a loop.

use crate::answers;
use crate::arrays::{Number, Numbers, ResultsObject, TextKeyed, finite};
use crate::errors;
use crate::pose::PoseLike;
use crate::request::Keywords;
use crate::robot::PyRobot;
use crate::simulation::PerCable;
use funicular::control_loop::MAX_CABLES;
use funicular::estimation::SensorReadings;
use funicular_study::analyses::estimate::LoopEstimator;
use funicular_study::request::EstimateRequest;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Estimator of pose, velocity, payload, tensions and errors of the sensors, inside a loop.
///
/// The filter of `Robot.estimate`, which gets readings as they come. The platform rests at the first ones. What raises
/// an exception leaves the estimator as it was.
///
/// Parameters
/// ----------
/// robot
///     Robot.
/// lengths_m
///     Unstrained lengths of all cables by their encoders [m].
/// tensions_n
///     Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
/// azimuths_rad
///     Azimuths at which cables leave their anchors, about z from x [rad].
/// elevations_rad
///     Elevations of the cables at their anchors above the xy plane [rad].
/// gyroscope_rad_s
///     Angular velocity, platform axes [rad/s].
/// accelerometer_m_s2
///     Specific force, platform axes [m/s²]; at rest minus gravity.
/// tracker_m
///     Position of the tracked point in the world [m].
/// options
///     Noise, places of the sensors and prior knowledge as in `Robot.estimate`, `false_alarms_per_hour` and
///     `near_pose`.
///
/// Raises
/// ------
/// InputError
///     A reading or an option is wrong, or a length is missing.
/// NoSolutionError
///     The lengths have no equilibrium.
#[pyclass(frozen, name = "Estimator", module = "funicular")]
pub(crate) struct PyEstimator {
    names: Vec<String>,
    state: Mutex<LoopEstimator>,
}

/// Readings as Python gives them.
struct GivenReadings<'py> {
    lengths: Option<PerCable<'py>>,
    tensions: Option<PerCable<'py>>,
    azimuths: Option<PerCable<'py>>,
    elevations: Option<PerCable<'py>>,
    gyroscope: Option<Numbers>,
    accelerometer: Option<Numbers>,
    tracker: Option<Numbers>,
}

impl GivenReadings<'_> {
    /// Readings of the filter; those that are left out are not there.
    fn of(self, names: &[String]) -> PyResult<SensorReadings> {
        let row = |what: &str, given: Option<PerCable<'_>>| -> PyResult<[f64; MAX_CABLES]> {
            let mut found = [f64::NAN; MAX_CABLES];
            let given = given.map_or_else(|| Ok(Vec::new()), |given| given.of(what, names))?;
            for (found, value) in found.iter_mut().zip(given) {
                if let Some(value) = value {
                    *found = finite(what, value)?;
                }
            }
            Ok(found)
        };
        let three = |what: &str, given: Option<Numbers>| -> PyResult<[f64; 3]> {
            let Some(given) = given else { return Ok([f64::NAN; 3]) };
            let found = given.three(what)?;
            found.iter().try_for_each(|value| finite(what, *value).map(drop))?;
            Ok(found)
        };
        let lengths = row("lengths_m", self.lengths)?;
        if let Some(length) = lengths.iter().find(|length| **length <= 0.0) {
            return Err(errors::input(format!("`lengths_m` has {length}: give unstrained lengths above zero")));
        }
        let [azimuths, elevations] = [row("azimuths_rad", self.azimuths)?, row("elevations_rad", self.elevations)?];
        Ok(SensorReadings {
            lengths,
            tensions: row("tensions_n", self.tensions)?,
            angles: std::array::from_fn(|i| [azimuths[i], elevations[i]]),
            gyroscope: three("gyroscope_rad_s", self.gyroscope)?,
            accelerometer: three("accelerometer_m_s2", self.accelerometer)?,
            tracker: three("tracker_m", self.tracker)?,
        })
    }
}

impl PyEstimator {
    /// Filter, if no other thread is in it.
    fn state(&self) -> PyResult<MutexGuard<'_, LoopEstimator>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                Err(errors::input("another thread is in this estimator: give each thread one of its own".to_owned()))
            }
        }
    }
}

/// Dictionary of a state with the alarms since the last one.
fn dictionary<'py>(py: Python<'py>, state: &mut LoopEstimator) -> PyResult<ResultsObject<'py>> {
    let row = serde_json::to_value(state.row()).and_then(|mut row| {
        row["alarms"] = serde_json::to_value(state.new_alarms())?;
        Ok(row)
    });
    of_value(py, &row.map_err(|error| errors::input(error.to_string()))?)
}

/// Dictionary with arrays.
fn of_value<'py>(py: Python<'py>, row: &Value) -> PyResult<ResultsObject<'py>> {
    let plain = answers::loaded(py, row.to_string().as_bytes())?;
    Ok(ResultsObject(py.import("funicular._results")?.call_method1("results", (plain.0,))?.cast_into()?))
}

#[pymethods]
impl PyEstimator {
    #[new]
    #[pyo3(signature = (robot, lengths_m, *, tensions_n=None, azimuths_rad=None, elevations_rad=None,
        gyroscope_rad_s=None, accelerometer_m_s2=None, tracker_m=None, **options))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        py: Python<'_>,
        robot: &Bound<'_, PyRobot>,
        lengths_m: PerCable<'_>,
        tensions_n: Option<PerCable<'_>>,
        azimuths_rad: Option<PerCable<'_>>,
        elevations_rad: Option<PerCable<'_>>,
        gyroscope_rad_s: Option<Numbers>,
        accelerometer_m_s2: Option<Numbers>,
        tracker_m: Option<Numbers>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let robot = robot.get();
        let names = robot.names();
        let none = PyDict::new(py);
        let options = options.unwrap_or(&none);
        for key in ["log", "every_s"] {
            if options.contains(key)? {
                return Err(errors::input(format!(
                    "`{key}` is of `Robot.estimate`: an estimator gets its readings one by one"
                )));
            }
        }
        let request: EstimateRequest = Keywords::read("estimate", options, &names)?.part()?;
        let given = GivenReadings {
            lengths: Some(lengths_m),
            tensions: tensions_n,
            azimuths: azimuths_rad,
            elevations: elevations_rad,
            gyroscope: gyroscope_rad_s,
            accelerometer: accelerometer_m_s2,
            tracker: tracker_m,
        };
        let readings = given.of(&names)?;
        let begun = py.detach(|| {
            let near = request.near_pose.map(funicular_study::request::Pose::to_robot).transpose()?;
            LoopEstimator::start(&robot.robot, &request, &readings, near.as_ref())
        });
        let state = Mutex::new(begun.map_err(|error| errors::study(&error))?);
        Ok(Self { names, state })
    }

    /// Moves the estimate by a time step and takes the readings at its end. A reading that is left out was not there.
    ///
    /// Parameters
    /// ----------
    /// dt_s
    ///     Time step [s], above 0 and at most 1.
    /// lengths_m
    ///     Unstrained lengths by the encoders [m]: one per cable, or a dictionary by names.
    /// tensions_n
    ///     Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
    /// azimuths_rad
    ///     Azimuths at which cables leave their anchors, about z from x [rad].
    /// elevations_rad
    ///     Elevations of the cables at their anchors above the xy plane [rad].
    /// gyroscope_rad_s
    ///     Angular velocity, platform axes [rad/s].
    /// accelerometer_m_s2
    ///     Specific force, platform axes [m/s²]; at rest minus gravity.
    /// tracker_m
    ///     Position of the tracked point in the world [m], at this time.
    ///
    /// Returns
    /// -------
    /// The keys of a row of `Robot.estimate`, with the time since the start, and `alarms` since the last call.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The step or a reading is wrong; the estimator is as it was.
    /// NoSolutionError
    ///     No length has been read for 0.2 s, or the readings lead nowhere: call `restart`. The estimator is as it was.
    #[pyo3(signature = (dt_s, *, lengths_m=None, tensions_n=None, azimuths_rad=None, elevations_rad=None,
        gyroscope_rad_s=None, accelerometer_m_s2=None, tracker_m=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn update<'py>(
        &self,
        py: Python<'py>,
        dt_s: Number,
        lengths_m: Option<PerCable<'_>>,
        tensions_n: Option<PerCable<'_>>,
        azimuths_rad: Option<PerCable<'_>>,
        elevations_rad: Option<PerCable<'_>>,
        gyroscope_rad_s: Option<Numbers>,
        accelerometer_m_s2: Option<Numbers>,
        tracker_m: Option<Numbers>,
    ) -> PyResult<ResultsObject<'py>> {
        let step = dt_s.positive("dt_s")?;
        let given = GivenReadings {
            lengths: lengths_m,
            tensions: tensions_n,
            azimuths: azimuths_rad,
            elevations: elevations_rad,
            gyroscope: gyroscope_rad_s,
            accelerometer: accelerometer_m_s2,
            tracker: tracker_m,
        };
        let readings = given.of(&self.names)?;
        let mut guard = self.state()?;
        let state = &mut *guard;
        py.detach(|| state.update(&readings, step)).map_err(|error| errors::study(&error))?;
        dictionary(py, state)
    }

    /// Begins anew at rest with the lengths of all cables.
    ///
    /// Parameters
    /// ----------
    /// lengths_m
    ///     Unstrained lengths of all cables by their encoders [m].
    /// tensions_n
    ///     Tensions at anchors or drums [N]: one per cable, or a dictionary by names.
    /// gyroscope_rad_s
    ///     Angular velocity, platform axes [rad/s].
    /// accelerometer_m_s2
    ///     Specific force, platform axes [m/s²]; at rest minus gravity.
    /// tracker_m
    ///     Position of the tracked point in the world [m].
    /// near_pose
    ///     Pose near which the platform is; the last one if not given.
    /// forget
    ///     Begin with what was known before the first reading; otherwise payload and errors of the sensors stay as they
    ///     are known.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A reading is wrong or a length is missing; the estimator is as it was.
    /// NoSolutionError
    ///     The lengths have no equilibrium; the estimator is as it was.
    #[pyo3(signature = (lengths_m, *, tensions_n=None, gyroscope_rad_s=None, accelerometer_m_s2=None, tracker_m=None,
        near_pose=None, forget=false))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn restart(
        &self,
        py: Python<'_>,
        lengths_m: PerCable<'_>,
        tensions_n: Option<PerCable<'_>>,
        gyroscope_rad_s: Option<Numbers>,
        accelerometer_m_s2: Option<Numbers>,
        tracker_m: Option<Numbers>,
        near_pose: Option<PoseLike>,
        forget: bool,
    ) -> PyResult<()> {
        let near = near_pose.map(|pose| pose.0.to_robot()).transpose().map_err(|error| errors::study(&error))?;
        let given = GivenReadings {
            lengths: Some(lengths_m),
            tensions: tensions_n,
            azimuths: None,
            elevations: None,
            gyroscope: gyroscope_rad_s,
            accelerometer: accelerometer_m_s2,
            tracker: tracker_m,
        };
        let readings = given.of(&self.names)?;
        let mut guard = self.state()?;
        let state = &mut *guard;
        py.detach(|| state.restart(&readings, near.as_ref(), forget)).map_err(|error| errors::study(&error))
    }

    /// Names of the cables, in the order of the file.
    #[getter]
    fn cable_names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// Present state with the keys of a row of `Robot.estimate`.
    #[getter]
    fn now<'py>(&self, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        let row = serde_json::to_value(self.state()?.row()).map_err(|error| errors::input(error.to_string()))?;
        of_value(py, &row)
    }

    /// All alarms so far, as in the results of `Robot.estimate`.
    #[getter]
    fn alarms<'py>(&self, py: Python<'py>) -> PyResult<Vec<TextKeyed<'py>>> {
        let state = self.state()?;
        let dictionaries = state.alarms().iter().map(|alarm| {
            let bytes = serde_json::to_vec(alarm).map_err(|error| errors::input(error.to_string()))?;
            answers::loaded(py, &bytes)
        });
        dictionaries.collect()
    }

    fn __repr__(&self) -> PyResult<String> {
        Ok(format!("<Estimator of {} cables at {} s>", self.names.len(), self.state()?.row().t_s))
    }
}
