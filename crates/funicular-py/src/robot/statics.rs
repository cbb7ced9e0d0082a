//! Methods about equilibria and payloads.

use super::PyRobot;
use crate::answers::{self, CtrlC};
use crate::arrays::{FirstLastCount, Number, Numbers, ResultsObject};
use crate::batch;
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::pose::PoseLike;
use crate::request::{StateKeywords, TensionKeywords, lengths};
use crate::threads::Threads;
use funicular_study::analyses;
use funicular_study::request as requests;
use pyo3::prelude::*;

#[pymethods]
impl PyRobot {
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
        let cables = slf.get().names();
        PyEquilibrium::of(py, slf, state.request(&cables)?, tensions.request(&cables)?)?.into_object(py)
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
        let cables = self.names();
        let states = batch::States::read(poses, lengths_m, &cables)?;
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
        batch::equilibria(py, self, states, &state.request(&cables)?, &tensions.request(&cables)?, threads)
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
    ) -> PyResult<ResultsObject<'py>> {
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

        let cables = self.names();
        let request = requests::PayloadRequest {
            robot: self.source.clone(),
            payload_center_m: payload_center_m.map(|center| center.three("payload_center_m")).transpose()?,
            state: state.request(&cables)?,
            tensions: TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n }
                .request(&cables)?,
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
    ///     Pose instead of lengths: the lengths are those with which the robot, as it was read and before `with_`,
    ///     rests there. A robot file with a pose gives it if it is not given here.
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
        mass_kg: FirstLastCount,
        lengths_m: Option<Numbers>,
        pose: Option<PoseLike>,
        tension_rule: Option<&str>,
        target_tension_n: Option<Numbers>,
        min_tension_n: Option<Number>,
        max_tension_n: Option<Number>,
        tolerance_mm: Option<Number>,
    ) -> PyResult<ResultsObject<'py>> {
        let cables = self.names();
        let request = requests::PoseErrorRequest {
            robot: self.source.clone(),
            mass_kg: mass_kg.masses("mass_kg", analyses::pose_error::MAX_MASSES)?,
            lengths_m: lengths(lengths_m, &cables)?,
            pose: pose.map(|pose| pose.0),
            tensions: TensionKeywords { tension_rule, target_tension_n, min_tension_n, max_tension_n }
                .request(&cables)?,
            tolerance_mm: tolerance_mm.map(|tolerance| tolerance.value("tolerance_mm")).transpose()?,
        };

        let found = py.detach(|| {
            let mut watch = CtrlC::new();
            analyses::pose_error::run(&self.robot, &request, &mut watch).map_err(|error| watch.or(&error))
        })?;
        answers::with_arrays(py, &found)
    }
}
