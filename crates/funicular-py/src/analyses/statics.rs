//! Methods about the robot at rest.

use super::PyAnalyses;
use crate::answers;
use crate::arrays::{Numbers, ResultsObject};
use crate::errors;
use crate::interrupt::interruptible;
use crate::vibration;
use funicular_study::analyses;
use funicular_study::analyses::statics::Extras;
use pyo3::prelude::*;
use std::sync::Arc;

#[pymethods]
impl PyAnalyses {
    /// Computes the stiffness about the platform origin in world axes [N/m, N, N m].
    ///
    /// Parameters
    /// ----------
    /// at_hz
    ///     Frequency [Hz], or a row of n frequencies; 0 if not given.
    /// cable_model
    ///     How cables answer motion of the platform: `catenary-dynamic`, `shallow-dynamic`, `shallow-static`,
    ///     `catenary-static`, `spring`. If not given: `catenary-dynamic` with catenary statics, else `shallow-dynamic`,
    ///     and at 0 Hz the exact tangent of the static model. In wind this tangent is unsymmetric, because the drag
    ///     turns with the cables (theory (49d)). A named model, or another frequency, gives the symmetric stiffness
    ///     with constant drag.
    /// assembly
    ///     Terms of the stiffness: `consistent`, or `without-geometric-stiffness` for the end stiffness of the cables
    ///     alone, as in Yuan et al. 2014.
    /// in_plane_only
    ///     Leave out the stiffness of cables out of their planes, as in Yuan et al. 2014.
    /// winches
    ///     Winches in vibration, for cables that run to one: `as-given`, motors `clamped`, at constant `torque`, or
    ///     cables `stuck` on their pulleys.
    ///
    /// Returns
    /// -------
    /// (6, 6), real at 0 Hz and complex at another frequency; for a row of frequencies (n, 6, 6), complex.
    #[pyo3(signature = (at_hz=None, *, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"))]
    fn stiffness(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        at_hz: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<vibration::Stiffness> {
        Self::at(slf, |rest| vibration::stiffness(py, rest, at_hz, cable_model, assembly, in_plane_only, winches))
    }

    /// Searches for all equilibria of the unstrained lengths of the equilibrium.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `equilibria` lists the solutions, the lowest first, each with `pose`, `stable`,
    /// `energy_j`, `distance_m` and `tensions_platform_n`; `search` describes the search. Lists of numbers are arrays.
    fn all_equilibria<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let found =
            interruptible(py, move || analyses::statics::about(&at_rest, Extras { all: true, ..Extras::default() }))?;
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Computes the interval in which friction of pulleys leaves pose and tensions.
    ///
    /// Every cable may have run last towards the platform or towards its drum. If the lengths are given or held, pose
    /// and tensions vary; if the pose is given, the tensions at the drums and the lengths vary.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `friction_interval` has `held`, which is `lengths` or `pose`; with lengths held
    /// `translation_m` (3, 2) and `rotation_deg` (3, 2), the rotation vector, both in world axes; and `cables`, each
    /// with `friction_exponent`, `excess_length_m`, `tension_platform_n`, `tension_anchor_n` and `tension_drum_n`.
    /// Pairs are minimum and maximum. Theory (71) to (74).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     No cable runs over a pulley with friction.
    /// NoSolutionError
    ///     The equilibrium is indifferent.
    fn friction_interval<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<ResultsObject<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let extras = Extras { friction_interval: true, ..Extras::default() };
        let found = py.detach(|| analyses::statics::about(&at_rest, extras));
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }
}
