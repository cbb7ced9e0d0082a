//! Methods about vibration.

use super::PyAnalyses;
use crate::arrays::{Count, Number, Numbers, ResultsObject, Tensor};
use crate::texts::Texts;
use crate::vibration::{self, CompareKeywords, ModesKeywords, ModesObject, PairKeywords, Responses, SettleKeywords};
use numpy::Complex64;
use pyo3::prelude::*;

#[pymethods]
impl PyAnalyses {
    /// Computes all natural frequencies below a limit, and checks by an independent count that none is missing.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Limit of the frequencies [Hz]; if not given, slightly above the 20 lowest, or with `rigid_cables` above all.
    /// input, output
    ///     Signals of a response, as in `frf`: every mode then has its residue and the height of its peak.
    /// input_point_m, output_point_m
    ///     Points of the platform, as in `frf`.
    /// stations
    ///     Number of points along every cable, ends included, whose displacements are wanted.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for `first_platform_index`, the first mode of the
    ///     platform; 0.5 if not given.
    /// decay_percent
    ///     Percentage of its amplitude to which a mode decays in `decay_time_s`; 5 if not given.
    /// damped
    ///     Seek the damped partner of every mode. False is faster; damping ratios are then of first order in the
    ///     damping, and there are no eigenvalues.
    /// rigid_cables
    ///     Modes with cables that are straight, without mass and rigid in length, of the motions that they leave free.
    ///     The equilibrium has the static model `ideal` or `spring`.
    #[pyo3(signature = (
        below_hz=None, *, input=None, output=None, input_point_m=None, output_point_m=None, stations=None, cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given", platform_share=None, decay_percent=None,
        damped=true, rigid_cables=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn modes(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        below_hz: Option<Number>,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        stations: Option<Count>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        platform_share: Option<Number>,
        decay_percent: Option<Number>,
        damped: bool,
        rigid_cables: bool,
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
            winches,
            platform_share,
            decay_percent,
            damped,
            rigid_cables,
        };
        Self::at(slf, |rest| vibration::modes(py, rest, keywords))
    }

    /// Computes frequency responses: complex, for e^{+iωt}, in units of output per input.
    ///
    /// Parameters
    /// ----------
    /// hz
    ///     Frequencies [Hz], a row of n. With `adaptive` it may be left out: from 0 to above the 20 lowest natural
    ///     frequencies and the first mode of the platform.
    /// input
    ///     Input signal: force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a
    ///     direction, in world axes; a force on a cable, as in `cable:3@0.5:fz`; the commanded length of a cable, a
    ///     force of its motor or on its drum, as in `length:3`, `motor:3`, `drum:3`; or a motion of the base, `base-x`
    ///     to `base-rz`, or of an anchor, as in `anchor:3:x`. A list names several; `fz` if not
    ///     given.
    /// output
    ///     Output signal: displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a`
    ///     (acceleration) before it, or `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable, as in
    ///     `cable:3@0.5:az`; or the motion of a drum or motor, or the tension of a cable at the platform or at its
    ///     drum, as in `drum:3`, `motor:3`, `tension:3`, `drum-tension:3`. A list names several; `az` if not given.
    /// adaptive
    ///     Add frequencies between those in `hz`, which ascend, until every peak has its height (to 0.1 %) and straight
    ///     lines over the logarithm of the magnitude are accurate to 1 %. At undamped natural frequencies, where the
    ///     response has no bound, there is a gap of 5e-5 of the frequency on either side.
    /// input_point_m, output_point_m
    ///     Point where the forces act and point whose motion is measured, platform frame [m]; the origin if not given.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// (n,) for one input and one output; (outputs, inputs, n) if `input` or `output` is a list. With `adaptive` a
    /// pair: the chosen frequencies [Hz] (n,), and the responses at them.
    ///
    /// Raises
    /// ------
    /// ResponseError
    ///     One of the frequencies is an undamped natural frequency.
    ///
    /// Warns
    /// -----
    /// ResponseWarning
    ///     At least ten frequencies ascend, and peaks between them are read more than 5 % too low.
    #[pyo3(signature = (
        hz=None, input=None, output=None, *, adaptive=false, input_point_m=None, output_point_m=None, cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn frf(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        hz: Option<Numbers>,
        input: Option<Texts>,
        output: Option<Texts>,
        adaptive: bool,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<Responses> {
        let keywords = PairKeywords {
            input,
            output,
            adaptive,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| vibration::frf(py, rest, hz, keywords))
    }

    /// Computes the receptance of all six motions to all six wrench components about the platform origin: (n, 6, 6),
    /// world axes.
    ///
    /// The parameters are those of `frf`.
    #[pyo3(signature = (hz, *, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"))]
    fn receptance(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        hz: Numbers,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<Tensor<Complex64>> {
        Self::at(slf, |rest| vibration::receptance(py, rest, hz, cable_model, assembly, in_plane_only, winches))
    }

    /// Computes how a point of the platform swings after a force or moment on it is released, and when it has settled.
    ///
    /// The motion is linear about the equilibrium without the force, in closed form over the damped modes.
    ///
    /// Parameters
    /// ----------
    /// release_n, release_n_m
    ///     Force [N] and moment [N m] on the platform that are released, world axes.
    /// input_point_m, output_point_m
    ///     Point of the force and point whose motion is wanted, platform frame [m]; the origin if not given.
    /// tolerance_m
    ///     Distance from its rest within which the point has settled [m]; 0.001 if not given.
    /// below_hz
    ///     Limit of the frequencies of the modes that take part [Hz].
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON; lists of numbers are arrays.
    #[pyo3(signature = (
        release_n=None, *, release_n_m=None, input_point_m=None, output_point_m=None, tolerance_m=None, below_hz=None,
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn settle<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        release_n: Option<Numbers>,
        release_n_m: Option<Numbers>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        tolerance_m: Option<Number>,
        below_hz: Option<Number>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<ResultsObject<'py>> {
        let keywords = SettleKeywords {
            release_n,
            release_n_m,
            input_point_m,
            output_point_m,
            tolerance_m,
            below_hz,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| vibration::settle(py, rest, keywords))
    }

    /// Compares every cable model with the catenary-dynamic model: frequencies found, missed and wrong, and the
    /// recommended model.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Limit of the frequencies [Hz].
    /// platform
    ///     Compare the modes of the platform alone.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for a mode of the platform; 0.5 if not given.
    /// tolerance
    ///     Maximum relative difference of frequency for a model that is good enough; 0.01 if not given.
    /// assembly, in_plane_only, winches
    ///     Terms of the stiffness, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON; lists of numbers are arrays.
    #[pyo3(signature = (
        below_hz, *, platform=false, platform_share=None, tolerance=None, assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn compare<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        below_hz: Number,
        platform: bool,
        platform_share: Option<Number>,
        tolerance: Option<Number>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<ResultsObject<'py>> {
        let keywords =
            CompareKeywords { below_hz, platform, platform_share, tolerance, assembly, in_plane_only, winches };
        Self::at(slf, |rest| vibration::compare(py, rest, keywords))
    }

    /// Computes the dynamic stiffness of the platform end of one cable with a fixed anchor.
    ///
    /// Parameters
    /// ----------
    /// name
    ///     Name of a cable.
    /// hz
    ///     Frequencies [Hz], a row of n.
    /// cable_model, in_plane_only, winches
    ///     Model, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `local` has `k_a`, `k_b`, `k_c`, `k_o` (n, complex): along the chord, coupling,
    /// normal in plane, out of plane [N/m]. `world` is (n, 3, 3), complex, in world axes. `clamped_frequencies_hz` are
    /// the natural frequencies of the cable with both ends fixed.
    #[pyo3(signature = (name, hz, *, cable_model=None, in_plane_only=false, winches="as-given"))]
    fn cable<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        name: &str,
        hz: Numbers,
        cable_model: Option<&str>,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<ResultsObject<'py>> {
        Self::at(slf, |rest| vibration::cable(py, rest, name, hz, cable_model, in_plane_only, winches))
    }
}
