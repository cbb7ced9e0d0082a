//! Derivatives of results.

use super::PyAnalyses;
use crate::arrays::{Number, Numbers, ResultsObject};
use crate::texts::Texts;
use crate::vibration::{self, GradientKeywords};
use pyo3::prelude::*;

#[pymethods]
impl PyAnalyses {
    /// Computes derivatives of results by numbers of the robot file, without perturbing any.
    ///
    /// Parameters
    /// ----------
    /// of
    ///     Groups of results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`; the
    ///     frequencies if not given.
    /// by
    ///     Paths of the numbers, as `Robot.parameters` lists them; `*` stands for any key, as in `cables.*.anchor_m`,
    ///     and a path to a table or vector for all numbers in it. All numbers if not given.
    /// hold
    ///     Held while a number changes: the unstrained `lengths`, so that the pose follows, or the `pose`, so that the
    ///     lengths follow. Of more cables than degrees of freedom the tensions parallel to the chords then change
    ///     least. `rule`: as `pose`, but the tensions go on to follow the rule that has chosen them (not `stiffest`).
    /// per
    ///     Unit of the derivatives: `unit` of the number, `percent` of its value, or its `tolerance`.
    /// tolerances
    ///     Tolerances: a mapping from paths to values or percentages, or texts such as `platform.mass_kg=1%` or
    ///     `cables.*.anchor_m=0.002`. If not given: 1 mm for positions and lengths, 0.1° for angles, 1 % of other values.
    /// below_hz
    ///     Limit of the frequencies [Hz], for `frequencies` and `damping`.
    /// at_hz, input, output, input_point_m, output_point_m
    ///     Frequency [Hz], signals and points of the `response`, as in `frf`; signals on the platform.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `parameters` lists the numbers, each with `path`, `value`, `unit` and
    /// `tolerance`; `results` the results, each with `name`, `unit`, `value` and the array `derivatives` (parameters,).
    /// `held_means` says what is held. Modes that share a frequency have a block, `block_entry`. `refused` has the
    /// results without a gradient and the reasons. Theory, section 17.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The robot has ideal cables, or a path that no number has.
    /// NoSolutionError
    ///     A cable is slack, or the equilibrium indifferent: it has no derivatives.
    #[pyo3(signature = (
        of=None, *, by=None, hold="lengths", per="unit", tolerances=None, below_hz=None, at_hz=None, input=None, output=None,
        input_point_m=None, output_point_m=None, cable_model=None, assembly="consistent", in_plane_only=false,
        winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn gradient<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        of: Option<Texts>,
        by: Option<Texts>,
        hold: &str,
        per: &str,
        tolerances: Option<Bound<'py, PyAny>>,
        below_hz: Option<Number>,
        at_hz: Option<Number>,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<ResultsObject<'py>> {
        let keywords = GradientKeywords {
            of,
            by,
            hold,
            per,
            tolerances,
            below_hz,
            at_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| vibration::gradient(py, rest, keywords))
    }
}
