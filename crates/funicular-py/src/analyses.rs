//! `funicular.Analyses`: the methods that `Robot` and `Equilibrium` share, with their signatures.

use crate::answers;
use crate::arrays::{Count, Number, Numbers, Tensor, TextKeyed};
use crate::equilibrium::PyEquilibrium;
use crate::errors;
use crate::interrupt::interruptible;
use crate::robot::PyRobot;
use crate::vibration::{
    self, CompareKeywords, GradientKeywords, ModesKeywords, ModesObject, PairKeywords, Responses, SignalNames,
};
use crate::written::{self, PageKeywords, ReduceKeywords};
use funicular_study::analyses;
use funicular_study::analyses::statics::Extras;
use funicular_study::request::{State, Tensions};
use numpy::Complex64;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// Analyses of a robot at an equilibrium: the methods that `Equilibrium` and `Robot` share.
///
/// Those of `Robot` analyse the equilibrium in the state of the robot file, which every call computes again.
#[pyclass(frozen, subclass, name = "Analyses", module = "funicular")]
pub(crate) struct PyAnalyses;

impl PyAnalyses {
    /// Runs `analyse` on the equilibrium that a method is called on; for a robot on that of the state of its file.
    fn at<R>(slf: &Bound<'_, Self>, analyse: impl FnOnce(&PyEquilibrium) -> PyResult<R>) -> PyResult<R> {
        if let Ok(equilibrium) = slf.cast::<PyEquilibrium>() {
            return analyse(equilibrium.get());
        }
        let robot = slf.cast::<PyRobot>()?.clone().unbind();
        analyse(&PyEquilibrium::of(slf.py(), robot, State::default(), Tensions::default())?)
    }
}

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
    fn all_equilibria<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let found =
            interruptible(py, move || analyses::statics::about(&at_rest, Extras { all: true, ..Extras::default() }))?;
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Computes the interval in which friction of pulleys leaves pose and tensions.
    ///
    /// Every cable may have run last towards the platform or towards its drum. If the lengths are given or held, pose and
    /// tensions vary; if the pose is given, the tensions at the drums and the lengths vary.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `friction_interval` has `held`, which is `lengths` or `pose`; with lengths held
    /// `translation_m` (3, 2) and `rotation_deg` (3, 2), the rotation vector, both in world axes; and `cables`, each with
    /// `friction_exponent`, `excess_length_m`, `tension_platform_n`, `tension_anchor_n` and `tension_drum_n`. Pairs are
    /// minimum and maximum. Theory (71) to (74).
    ///
    /// Raises
    /// ------
    /// InputError
    ///     No cable runs over a pulley with friction.
    /// NoSolutionError
    ///     The equilibrium is indifferent.
    fn friction_interval<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<TextKeyed<'py>> {
        let at_rest = Self::at(slf, |rest| Ok(Arc::clone(&rest.at_rest)))?;
        let extras = Extras { friction_interval: true, ..Extras::default() };
        let found = py.detach(|| analyses::statics::about(&at_rest, extras));
        answers::with_arrays(py, &found.map_err(|error| errors::study(&error))?)
    }

    /// Computes all natural frequencies below a limit, and checks by an independent count that none is missing.
    ///
    /// Parameters
    /// ----------
    /// below_hz
    ///     Limit of the frequencies [Hz].
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
    /// damped
    ///     Seek the damped partner of every mode. False is faster; damping ratios are then of first order in the
    ///     damping, and there are no eigenvalues.
    /// rigid_cables
    ///     Modes with cables that are straight, without mass and rigid in length, of the motions that they leave free. The
    ///     equilibrium has the static model `ideal` or `spring`.
    #[pyo3(signature = (
        below_hz, *, input=None, output=None, input_point_m=None, output_point_m=None, stations=None, cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given", platform_share=None, damped=true,
        rigid_cables=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn modes(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        below_hz: Number,
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
            damped,
            rigid_cables,
        };
        Self::at(slf, |rest| vibration::modes(py, rest, keywords))
    }

    /// Computes derivatives of results by numbers of the robot file, without perturbing any.
    ///
    /// Parameters
    /// ----------
    /// of
    ///     Groups of results: `pose`, `lengths`, `tensions`, `stiffness-min`, `frequencies`, `damping`, `response`; the
    ///     frequencies if not given.
    /// by
    ///     Paths of the numbers, as `Robot.parameters` lists them; `*` stands for any key, as in `cables.*.anchor_m`, and a
    ///     path to a table or vector for all numbers in it. All numbers if not given.
    /// hold
    ///     Held while a number changes: the unstrained `lengths`, so that the pose follows, or the `pose`, so that the
    ///     lengths follow. Of more cables than degrees of freedom the tensions parallel to the chords then change least.
    /// per
    ///     Step that the derivatives are for: `unit` of the number, `percent` of its value, or its `tolerance`.
    /// tolerances
    ///     Tolerances, as `platform.mass_kg=1%` or `cables.*.anchor_m=0.002`. If not given: 1 mm for positions and lengths,
    ///     0.1° for angles, 1 % of other values.
    /// below_hz
    ///     Limit of the frequencies [Hz], for `frequencies` and `damping`.
    /// at_hz, input, output, input_point_m, output_point_m
    ///     Frequency [Hz], signals and points of the `response`, as in `frf`; signals on the platform.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `stiffness`.
    ///
    /// Returns
    /// -------
    /// The keys of the program's JSON. `parameters` lists the numbers, each with `path`, `value`, `unit` and `tolerance`;
    /// `results` the results, each with `name`, `unit`, `value` and the array `derivatives` (parameters,). `held_means` says
    /// what is held. Modes that share a frequency have a block, `block_entry`. `refused` has the results without a
    /// gradient and the reasons. Theory, section 17.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The robot has drives or ideal cables, or a path that no number has.
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
        of: Option<Vec<String>>,
        by: Option<Vec<String>>,
        hold: &str,
        per: &str,
        tolerances: Option<Vec<String>>,
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
    ) -> PyResult<TextKeyed<'py>> {
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

    /// Computes frequency responses: complex, for e^{+iωt}, in units of output per input.
    ///
    /// Parameters
    /// ----------
    /// hz
    ///     Frequencies [Hz], a row of n.
    /// input
    ///     Input signal: force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a
    ///     direction, in world axes; a force on a cable, as in `cable:3@0.5:fz`; the commanded length of a cable, a
    ///     force of its motor or on its drum, as in `length:3`, `motor:3`, `drum:3`; or a motion of the base, `base-x`
    ///     to `base-rz`, or of an anchor, as in `anchor:3:x`. A list names several.
    /// output
    ///     Output signal: displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a`
    ///     (acceleration) before it, or `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable, as in
    ///     `cable:3@0.5:az`; or the motion of a drum or motor, or the tension of a cable at the platform or at its drum, as
    ///     in `drum:3`, `motor:3`, `tension:3`, `drum-tension:3`. A list names several.
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
    /// (n,) for one input and one output; (outputs, inputs, n) if `input` or `output` is a list. With `adaptive` a pair:
    /// the chosen frequencies [Hz] (n,), and the responses at them.
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
        hz, input, output, *, adaptive=false, input_point_m=None, output_point_m=None, cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn frf(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        hz: Numbers,
        input: SignalNames,
        output: SignalNames,
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
    ) -> PyResult<TextKeyed<'py>> {
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
    ) -> PyResult<TextKeyed<'py>> {
        Self::at(slf, |rest| vibration::cable(py, rest, name, hz, cable_model, in_plane_only, winches))
    }

    /// Computes a state space A, B, C, D for control design: the modes that inputs and outputs see.
    ///
    /// Parameters
    /// ----------
    /// input, output
    ///     Lists of signals, as in `frf`; if not given, all forces and moments on the platform, and all its
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
        input: Option<Vec<String>>,
        output: Option<Vec<String>>,
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
    ///     Lists of signals, as in `frf`; if not given, all forces and moments on the platform, and all its
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
        input: Option<Vec<String>>,
        output: Option<Vec<String>>,
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

    /// Writes the equilibrium as a file of another program; returns the caveats of the file.
    ///
    /// Parameters
    /// ----------
    /// to
    ///     Program that the file is for: `opensees`, `moordyn` or `vtk`.
    /// path
    ///     Path of the file, which is complete or absent.
    /// segments
    ///     Number of elements per cable; 20 if not given.
    /// modes_below_hz
    ///     Limit of the modes in the file [Hz].
    ///
    /// Raises
    /// ------
    /// FileError
    ///     The file cannot be written.
    #[pyo3(signature = (to, path, *, segments=None, modes_below_hz=None))]
    fn export(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        to: &str,
        path: PathBuf,
        segments: Option<Count>,
        modes_below_hz: Option<Number>,
    ) -> PyResult<Vec<String>> {
        Self::at(slf, |rest| written::export(py, rest, to, path, segments, modes_below_hz))
    }

    /// Makes a page in HTML on which the platform can be dragged, which notebooks show.
    ///
    /// The page contains the program itself, as WebAssembly, and needs no network.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     File to which the page is also written.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The package was built without the page.
    #[pyo3(signature = (path=None, *, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"))]
    fn live(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: Option<PathBuf>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<written::PageObject> {
        let model = crate::request::model(cable_model, assembly, in_plane_only, winches)?;
        Self::at(slf, |rest| written::live(py, rest, path, model))
    }

    /// Makes a page in HTML about the equilibrium and its vibration, which notebooks show.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     File to which the page is also written.
    /// below_hz
    ///     Limit of the frequencies [Hz]; 20 if not given.
    /// input, output
    ///     Signals of the response on the page, as in `frf`; `fz` and `az` if not given, or `fx` and `ax` for a
    ///     platform that cannot move along z.
    /// input_point_m, output_point_m, cable_model, assembly, in_plane_only, winches
    ///     Points and models, as in `frf`.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for the first mode of the platform; 0.5 if not given.
    #[pyo3(signature = (
        path=None, *, below_hz=None, input=None, output=None, input_point_m=None, output_point_m=None,
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given", platform_share=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn report(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: Option<PathBuf>,
        below_hz: Option<Number>,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        platform_share: Option<Number>,
    ) -> PyResult<written::PageObject> {
        let keywords = PageKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
            winches,
            platform_share,
        };
        Self::at(slf, |rest| written::report(py, rest, path, keywords))
    }
}
