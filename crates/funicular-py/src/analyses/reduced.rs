//! Models for control design.

use super::PyAnalyses;
use crate::arrays::{Count, Number, Numbers};
use crate::texts::Texts;
use crate::written::{self, ReduceKeywords};
use pyo3::prelude::*;

#[pymethods]
impl PyAnalyses {
    /// Computes a state space A, B, C, D for control design: the modes that inputs and outputs see.
    ///
    /// Parameters
    /// ----------
    /// input, output
    ///     Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
    ///     displacements and rotations.
    /// below_hz
    ///     Highest frequency for which the model is made [Hz].
    /// order
    ///     Maximum number of states, instead of a tolerance.
    /// tolerance
    ///     Maximum of |G_r − G| up to the limit relative to the peak of |G|, for each response. The model has as few
    ///     states as it allows. 0.01 if neither is given.
    /// input_point_m, output_point_m
    ///     Points of the platform, as in `frf`.
    /// damping_at_hz
    ///     Frequency at which constant damping ratios are right when made viscous [Hz]; at every natural frequency if
    ///     not given.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    ///
    /// Raises
    /// ------
    /// funicular.NoSolutionError
    ///     No choice of modes keeps the tolerance, a mode has no damping, or the equilibrium is unstable.
    #[pyo3(signature = (
        input=None, output=None, *, below_hz, order=None, tolerance=None, input_point_m=None, output_point_m=None,
        damping_at_hz=None, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn state_space(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        input: Option<Texts>,
        output: Option<Texts>,
        below_hz: Number,
        order: Option<Count>,
        tolerance: Option<Number>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        damping_at_hz: Option<Number>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<written::StateSpaceObject> {
        let keywords = ReduceKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            order,
            tolerance,
            damping_at_hz,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| written::state_space(py, rest, keywords))
    }

    /// Computes a second-order model M x'' + C x' + K x = B f, y = L x, and its state space with all clamped modes.
    ///
    /// `state_space` gives far fewer states.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Highest frequency for which the model is made [Hz].
    /// input, output
    ///     Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
    ///     displacements and rotations.
    /// input_point_m, output_point_m
    ///     Points of the platform, as in `frf`.
    /// tolerance
    ///     Maximum relative error of the responses by modes left out; 1e-3 if not given.
    /// damping_at_hz
    ///     Frequency at which constant damping ratios are right when made viscous [Hz]; at every natural frequency if
    ///     not given.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    #[pyo3(signature = (
        below_hz, input=None, output=None, *, input_point_m=None, output_point_m=None, tolerance=None,
        damping_at_hz=None, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn reduce(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        below_hz: Number,
        input: Option<Texts>,
        output: Option<Texts>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        tolerance: Option<Number>,
        damping_at_hz: Option<Number>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<written::ReducedObject> {
        let keywords = ReduceKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            order: None,
            tolerance,
            damping_at_hz,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| written::reduce(py, rest, keywords))
    }
}
