"""Methods of `Analyses` that compute, which equilibria and robots share. Their keywords are the declared keys of the commands."""

from __future__ import annotations

from typing import Any

from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray

from funicular import _results
from funicular._declared import REST, Given, declared
from funicular._funicular import Analyses, Robot
from funicular._live import Live, live as live_page
from funicular._pages import Page, page, try_page
from funicular._reading import File
from funicular._results import Modes, ReducedModel, StateSpaceModel
from funicular.results import (
    CableResults,
    CompareResults,
    GradientResults,
    GustResults,
    SettleResults,
)

_AS_MODES = "The other parameters are those of `Equilibrium.stiffness`."

# Keys of the program for frequencies, which Python gives as an array `hz`.
_RANGE = ("from_hz", "to_hz", "points", "log")


@declared(Analyses, "stiffness", positional=("at_hz",), headings=REST)
def stiffness(of: Any, given: Given, at_hz: ArrayLike | None = None) -> NDArray[Any]:
    """Computes the stiffness about the platform origin in world axes [N/m, N, N m].

    Parameters
    ----------
    at_hz
        Frequency [Hz], or a row of n frequencies; 0 if not given.
    cable_model
        How cables answer motion of the platform: `catenary-dynamic`, `shallow-dynamic`, `shallow-static`,
        `catenary-static`, `spring`. If not given: `catenary-dynamic` with catenary statics, else `shallow-dynamic`,
        and at 0 Hz the exact tangent of the static model. In wind this tangent is unsymmetric, because the drag
        turns with the cables (theory (49d)). A named model, or another frequency, gives the symmetric stiffness
        with constant drag.

    Returns
    -------
    (6, 6), real at 0 Hz and complex at another frequency; for a row of frequencies (n, 6, 6), complex.
    """
    matrices: NDArray[Any] = of._stiffness(at_hz, given)
    return matrices


@declared(Analyses, "modes", positional=("below_hz",), headings=REST, others=_AS_MODES)
def modes(of: Any, given: Given) -> Modes:
    """Computes all natural frequencies below a limit, and checks by an independent count that none is missing.

    Parameters
    ----------
    input, output
        Signals of a response, as in `frf`: every mode then has its residue and the height of its peak.
    stations
        Number of points along every cable, ends included, whose displacements are wanted.
    platform_share
        Minimum fraction of the kinetic energy in the platform for `first_platform_index`, the first mode of the
        platform; 0.5 if not given.
    damped
        Seek the damped partner of every mode. False is faster; damping ratios are then of first order in the
        damping, and there are no eigenvalues.
    rigid_cables
        Modes with cables that are straight, without mass and rigid in length, of the motions that they leave free.
        The equilibrium has the static model `ideal` or `spring`.
    """
    return _results.modes(*of._modes(given))


@declared(Analyses, "frf", positional=("hz", "input", "output"), headings=REST, without=(*_RANGE, "prominence_db"), others=_AS_MODES)
def frf(of: Any, given: Given, hz: ArrayLike | None = None) -> NDArray[complex128] | tuple[NDArray[float64], NDArray[complex128]]:
    """Computes frequency responses: complex, for e^{+iωt}, in units of output per input.

    Parameters
    ----------
    hz
        Frequencies [Hz], a row of n. With `adaptive` it may be left out: from 0 to above the 20 lowest natural
        frequencies and the first mode of the platform.
    input
        Input signal: force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a
        direction, in world axes; a force on a cable, as in `cable:3@0.5:fz`; the commanded length of a cable, a
        force of its motor or on its drum, as in `length:3`, `motor:3`, `drum:3`; or a motion of the base, `base-x`
        to `base-rz`, or of an anchor, as in `anchor:3:x`. A list names several; `fz` if not given.
    output
        Output signal: displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a`
        (acceleration) before it, or `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable, as in
        `cable:3@0.5:az`; or the motion of a drum or motor, or the tension of a cable at the platform or at its
        drum, as in `drum:3`, `motor:3`, `tension:3`, `drum-tension:3`. A list names several; `az` if not given.
    adaptive
        Add frequencies between those in `hz`, which ascend, until every peak has its height (to 0.1 %) and straight
        lines over the logarithm of the magnitude are accurate to 1 %. At undamped natural frequencies, where the
        response has no bound, there is a gap of 5e-5 of the frequency on either side.
    input_point_m, output_point_m
        Point where the forces act and point whose motion is measured, platform frame [m]; the origin if not given.

    Returns
    -------
    (n,) for one input and one output; (outputs, inputs, n) if `input` or `output` is a list. With `adaptive` a
    pair: the chosen frequencies [Hz] (n,), and the responses at them.

    Raises
    ------
    ResponseError
        One of the frequencies is an undamped natural frequency.

    Warns
    -----
    ResponseWarning
        At least ten frequencies ascend, and peaks between them are read more than 5 % too low.
    """
    found: NDArray[complex128] | tuple[NDArray[float64], NDArray[complex128]] = of._frf(hz, given)
    return found


@declared(
    Analyses,
    "frf",
    positional=("hz",),
    headings=REST,
    without=(*_RANGE, "prominence_db", "adaptive", "input", "output", "input_point_m", "output_point_m"),
    others=_AS_MODES,
)
def receptance(of: Any, given: Given, hz: ArrayLike) -> NDArray[complex128]:
    """Computes the receptance of all six motions to all six wrench components about the platform origin: (n, 6, 6),
    world axes.

    Parameters
    ----------
    hz
        Frequencies [Hz], a row of n.
    """
    matrices: NDArray[complex128] = of._receptance(hz, given)
    return matrices


@declared(Analyses, "settle", positional=("release_n",), headings=REST, others=_AS_MODES, files=True)
def settle(of: Any, given: Given) -> SettleResults:
    """Computes how a point of the platform swings after a release, a stop, a move or a trajectory, and when it has settled.

    The motion is linear about the equilibrium at the end, in closed form over the damped modes. A stop, a move and a
    trajectory are commanded by the lengths; an input shaper splits them so that their vibrations cancel.

    Returns
    -------
    The keys of the program's JSON; lists of numbers are arrays.

    References
    ----------
    docs/theory.md, equations (46f) to (46n).
    """
    return _results.of_answered(SettleResults, of._results("settle", given))


@declared(Analyses, "gust", positional=("output",), headings=REST, others=_AS_MODES, files=True)
def gust(of: Any, given: Given) -> GustResults:
    """Computes the response to turbulent wind: r.m.s. values and expected peaks of motions and tensions, with their
    spectra.

    The drag is linear about the mean wind of the equilibrium, and its damping is included. Motions are about that
    equilibrium.

    Returns
    -------
    The keys of the program's JSON; lists of numbers are arrays.

    References
    ----------
    docs/theory.md, equations (49f) to (49q).
    """
    return _results.of_answered(GustResults, of._results("gust", given))


@declared(Analyses, "compare", positional=("below_hz",), headings=REST, others=_AS_MODES, files=True)
def compare(of: Any, given: Given) -> CompareResults:
    """Compares every cable model with the catenary-dynamic model: frequencies found, missed and wrong, and the
    recommended model.

    Returns
    -------
    The keys of the program's JSON; lists of numbers are arrays.
    """
    return _results.of_answered(CompareResults, of._results("compare", given))


@declared(Analyses, "gradient", positional=("of",), headings=REST, others=_AS_MODES)
def gradient(of: Any, given: Given) -> GradientResults:
    """Computes derivatives of results by numbers of the robot file, without perturbing any.

    Parameters
    ----------
    by
        Paths of the numbers, as `Robot.parameters` lists them; `*` stands for any key, as in `cables.*.anchor_m`,
        and a path to a table or vector for all numbers in it. All numbers if not given.
    hold
        Held while a number changes: the unstrained `lengths`, so that the pose follows, or the `pose`, so that the
        lengths follow. Of more cables than degrees of freedom the tensions parallel to the chords then change
        least. `rule`: as `pose`, but the tensions go on to follow the rule that has chosen them (not `stiffest`).
    tolerances
        Tolerances: a mapping from paths to values or percentages, or texts such as `platform.mass_kg=1%` or
        `cables.*.anchor_m=0.002`. If not given: 1 mm for positions and lengths, 0.1° for angles, 1 % of other values.
    at_hz, input, output, input_point_m, output_point_m
        Frequency [Hz], signals and points of the `response`, as in `frf`; signals on the platform.

    Returns
    -------
    The keys of the program's JSON. `parameters` lists the numbers, each with `path`, `value`, `unit` and
    `tolerance`; `results` the results, each with `name`, `unit`, `value` and the array `derivatives` (parameters,).
    `held_means` says what is held. Modes that share a frequency have a block, `block_entry`. `refused` has the
    results without a gradient and the reasons. Theory, section 17.

    Raises
    ------
    InputError
        The robot has ideal cables, or a path that no number has.
    NoSolutionError
        A cable is slack, or the equilibrium indifferent: it has no derivatives.
    """
    return _results.of_answered(GradientResults, of._results("gradient", given))


@declared(Analyses, "cable", positional=("name", "hz"), headings=REST, without=_RANGE, others=_AS_MODES)
def cable(of: Any, given: Given, name: str, hz: ArrayLike) -> CableResults:
    """Computes the dynamic stiffness of the platform end of one cable with a fixed anchor.

    Parameters
    ----------
    name
        Name of a cable.
    hz
        Frequencies [Hz], a row of n.

    Returns
    -------
    The keys of the program's JSON. `local` has `k_a`, `k_b`, `k_c`, `k_o` (n, complex): along the chord, coupling,
    normal in plane, out of plane [N/m]. `world` is (n, 3, 3), complex, in world axes. `clamped_frequencies_hz` are
    the natural frequencies of the cable with both ends fixed.
    """
    found: CableResults = of._cable(name, hz, given)
    return found


@declared(Analyses, "reduce", positional=("input", "output"), headings=REST, without=("form",), others=_AS_MODES)
def state_space(of: Any, given: Given) -> StateSpaceModel:
    """Computes a state space A, B, C, D for control design: the modes that inputs and outputs see.

    Parameters
    ----------
    input, output
        Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
        displacements and rotations.
    order
        Maximum number of states, instead of a tolerance.
    tolerance
        Maximum of |G_r − G| up to the limit relative to the peak of |G|, for each response. The model has as few
        states as it allows. 0.01 if neither is given.

    Raises
    ------
    funicular.NoSolutionError
        No choice of modes keeps the tolerance, a mode has no damping, or the equilibrium is unstable.
    """
    robot = of if isinstance(of, Robot) else of.robot
    found, matrices = of._reduced({**given, "form": "state-space"})
    return _results.state_space(found, matrices, robot.to_toml())


@declared(Analyses, "reduce", positional=("below_hz", "input", "output"), headings=REST, without=("form", "order"), others=_AS_MODES)
def reduce(of: Any, given: Given) -> ReducedModel:
    """Computes a second-order model M x'' + C x' + K x = B f, y = L x, and its state space with all clamped modes.

    `state_space` gives far fewer states.

    Parameters
    ----------
    input, output
        Signals, as in `frf`, one or a list; if not given, all forces and moments on the platform, and all its
        displacements and rotations.
    tolerance
        Maximum relative error of the responses by modes left out; 1e-3 if not given.
    """
    return _results.reduced(*of._reduced({**given, "form": "second-order"}))


@declared(Analyses, "export", positional=("to", "path"), headings=REST)
def export(of: Any, given: Given, path: File) -> list[str]:
    """Writes the equilibrium as a file of another program; returns the caveats of the file.

    Parameters
    ----------
    path
        Path of the file, which is complete or absent.
    scenario
        Events for MoorDyn, as `Robot.simulate` takes them: `release` from rest, `lengths`, `stop`, `cut`. The file is
        then a Python script that runs MoorDyn.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    caveats: list[str] = of._export(path, given)
    return caveats


@declared(
    Analyses,
    "frf",
    positional=("path", "hz", "input", "output"),
    headings=REST,
    without=(*_RANGE, "prominence_db"),
    others=_AS_MODES,
)
def write_frf(of: Any, given: Given, path: File, hz: ArrayLike) -> list[str]:
    """Writes frequency responses as a Universal File, as the program's `frf -o FILE.uff`; returns the caveats.

    Each response is a function of dataset 58, with its points in dataset 15.

    Parameters
    ----------
    path
        Path of the file, which is complete or absent.
    hz
        Frequencies [Hz], a row of n.
    input, output
        Signals, as in `frf`: motions of the platform and forces on it, along axes.

    Raises
    ------
    InputError
        A Universal File cannot hold one of the signals.
    FileError
        The file cannot be written.
    """
    caveats: list[str] = of._write_frf(path, hz, given)
    return caveats


@declared(
    Analyses,
    "modes",
    positional=("path", "below_hz"),
    headings=REST,
    without=("input", "output", "input_point_m", "output_point_m", "stations", "platform_share", "decay_percent", "damped"),
    others=_AS_MODES,
)
def write_modes(of: Any, given: Given, path: File) -> list[str]:
    """Writes all mode shapes below a limit as a Universal File, as the program's `modes -o FILE.uff`; returns the
    caveats.

    Each mode is a dataset 55 over the origin of the platform and the attachments, in platform axes.

    Parameters
    ----------
    path
        Path of the file, which is complete or absent.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    caveats: list[str] = of._write_modes(path, given)
    return caveats


@declared(Analyses, "live", positional=("path",), headings=REST, others=_AS_MODES)
def live(of: Any, given: Given, path: File | None = None) -> Live:
    """Makes a page in HTML on which the platform can be dragged, which notebooks show.

    The page contains the program itself, as WebAssembly, and needs no network. In a notebook, with the package
    `anywidget`, the pose and the values that a person changes come back: `state`, `pose`, `values` and
    `equilibrium()` of the result follow the page.

    Parameters
    ----------
    path
        File to which the page is also written.

    Raises
    ------
    InputError
        The package was built without the page.
    """
    try_page(path)
    return live_page(of._live(given), path)


@declared(Analyses, "report", positional=("path",), headings=REST, others=_AS_MODES)
def report(of: Any, given: Given, path: File | None = None) -> Page:
    """Makes a page in HTML about the equilibrium and its vibration, which notebooks show.

    Parameters
    ----------
    path
        File to which the page is also written.
    """
    try_page(path)
    html, warnings = of._report(given)
    return page(html, warnings, path)
