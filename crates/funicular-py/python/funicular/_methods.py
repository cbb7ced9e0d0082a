"""Methods of `Robot` and `Equilibrium` that compute. Their keywords are the declared keys of the commands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import Any, SupportsIndex

from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray

from funicular import _results
from funicular._declared import REST, STATE, Given, declared
from funicular._design import Designed, designed
from funicular._funicular import Analyses, Equilibrium, Robot
from funicular._identify import Identified, identified
from funicular._live import Live, live as live_page
from funicular._pages import Page, page
from funicular._reading import keywords, with_state
from funicular._results import Equilibria, Modes, ReducedModel, Results, StateSpaceModel
from funicular._sweeps import Sweep
from funicular._uncertainty import Uncertainty, uncertainty as deviations_of

File = str | PathLike[str]

_AS_REST = "The other parameters are those of `Robot.equilibrium`."
_AS_MODES = "The other parameters are those of `Equilibrium.stiffness`."
_AS_BOTH = "The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`."

# Keys of the program for frequencies, which Python gives as an array `hz`.
_RANGE = ("from_hz", "to_hz", "points", "log")


@declared(Robot, "statics", positional=("pose", "lengths_m", "static_model", "tension_rule"), without=("all", "friction_interval"))
def equilibrium(of: Any, given: Given) -> Equilibrium:
    """Computes the static equilibrium for a pose or for unstrained lengths.

    Without `pose` and `lengths_m` the state is that of the robot file.

    Parameters
    ----------
    pose
        A `Pose`, or x, y, z [m], or x, y, z, roll, pitch, yaw [m, degrees], or x, y, z and a quaternion w, x, y, z.
        The lengths follow. With fewer cables than degrees of freedom: the nearest pose that the cables can hold.
    hold_lengths_of_pose
        Hold the unstrained lengths with which the robot, as it was read and before `with_`, rests at the pose. All
        changes, those of `with_` and those of this call, then act at these lengths and move the platform.

    Raises
    ------
    StaticsError
        There is no such equilibrium; `code` gives the reason as one word.
    InputError
        An argument is wrong; the message says which and what to give.
    """
    found: Equilibrium = of._equilibrium(given)
    return found


@declared(
    Robot,
    "statics",
    positional=("poses", "lengths_m", "static_model", "tension_rule"),
    without=("all", "friction_interval", "pose"),
    others=_AS_REST,
)
def equilibria(
    of: Any, given: Given, poses: ArrayLike | None = None, lengths_m: ArrayLike | None = None, threads: SupportsIndex | None = None
) -> Equilibria:
    """Computes the equilibria of many states in parallel, without Python's lock.

    A state without equilibrium is a row with its reason, never an exception. Each row has, bit for bit, the numbers
    of `equilibrium`.

    Parameters
    ----------
    poses
        (n, 3), (n, 6) or (n, 7): x, y, z [m], then roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
    lengths_m
        (n, m): unstrained lengths [m] of m cables.
    threads
        Number of threads; one per processor if not given.
    """
    found: Equilibria = of._equilibria(poses, lengths_m, threads, given)
    return found


@declared(Robot, "payload", positional=("pose", "lengths_m", "static_model", "tension_rule"), others=_AS_REST)
def payload(of: Any, given: Given) -> Results:
    """Computes the minimum and the maximum payload at a pose, with the cables whose tension limits bind.

    The payload is held by any tensions within the limits, not only by those of a tension rule. The pose need not be
    held without a payload.

    Returns
    -------
    The keys of the program's JSON: `minimum` and `maximum` with `payload_kg` and `cables`; without `maximum` if no
    maximum tension limits the payload.

    Raises
    ------
    StaticsError
        No payload is held at this pose.
    """
    return _results.results(of._answer("payload", given))


@declared(Robot, "loads", positional=("pose", "static_model"), others=_AS_REST)
def loads(of: Any, given: Given) -> Results:
    """Compares the loads that the cables hold at a pose with the required ones: verdict, load factor, what binds, margins.

    All tensions within the limits count, not only those of a tension rule.

    Returns
    -------
    The keys of the program's JSON: `closure`, `tension_factor`, `dead_load_held`, `capacity_margin_n`,
    `acceleration_max_m_s2`, and `required` with `held`, `load_factor`, its bounds, the load that binds, and `cables`;
    without `required` if nothing is required or the dead load is not held.

    Raises
    ------
    StaticsError
        The robot has no such pose, or no load factor was found.
    """
    return _results.results(of._answer("loads", given))


@declared(Robot, "clearance", positional=("pose", "static_model"), others=_AS_REST)
def clearance(of: Any, given: Given) -> Results:
    """Computes the distances between the sagging cables, the platform and obstacles: what is nearest, where, and what is
    too near.

    Returns
    -------
    The keys of the program's JSON: `free`, and `pairs` with `kind`, `first`, `second`, `distance_m`, `required_m`,
    `margin_m` and `points_m`, the pair with the least margin first.

    Raises
    ------
    StaticsError
        The robot has no such equilibrium.
    """
    return _results.results(of._answer("clearance", given))


@declared(
    Robot,
    "workspace",
    positional=("at_least", "at_most", "grid"),
    without=("lengths_m", "hold_lengths_of_pose", "compare"),
    others=_AS_BOTH,
)
def workspace(
    of: Any,
    given: Given,
    compare: Robot | None = None,
    surface: File | Sequence[File] = (),
    page: File | None = None,
    threads: SupportsIndex | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Results:
    """Finds all positions at which quantities keep their limits: surface, volume, parts and holes.

    Without a limit the positions are those at which tensions within their limits hold the platform, with the required
    loads if there are any.

    Parameters
    ----------
    at_least, at_most
        Least and greatest values: a mapping from quantities of `map`, or their columns, to numbers.
    grid
        Axes of the grid: a mapping from x, y, z [m] to (first, last, number of values), and from roll, pitch, yaw
        [degrees] to such ranges or to lists of angles.
    section
        Sections: a mapping from x, y or z to a list of coordinates [m].
    compare
        Robot whose set is compared with this one on the same grid.
    surface
        Files of the closed surface, .stl, .ply or .vtp.
    page
        HTML file of a page with the surface, the volumes and the sections.
    threads
        Number of threads of this process; one per processor if not given.
    progress
        Function that is called with the number of positions that are done, and of those known to be needed.

    Returns
    -------
    The keys of the program's JSON: `volumes` with the steps or the number of rays of each, `parts`, `holes`,
    `touches`, `bounds_m`, `inner_box`, `sections`, `rays`, `compared`; `vertices_m` (n, 3) and `triangles` (m, 3) of the closed
    surface, whose first `triangles_of_surface` lie on the set and the others on the box of the grid.

    Raises
    ------
    InputError
        A quantity, an axis or another argument is wrong; the message says which and what to give.
    NoSolutionError
        No position of the grid meets the conditions.

    References
    ----------
    docs/theory.md, section 10b.
    """
    if compare is not None:
        given = {**given, "compare": {"text": compare.to_toml()}}
    files = [surface] if isinstance(surface, (str, PathLike)) else list(surface)
    return _results.results(of._workspace(given, files, page, threads, progress))


@declared(Robot, "pose-error", positional=("mass_kg",), others=_AS_REST)
def pose_error(of: Any, given: Given) -> Results:
    """Computes the distance of the poses of spring and catenary cables from those of ideal cables, over the platform
    mass.

    Parameters
    ----------
    mass_kg
        First mass [kg], last mass [kg] and number of masses.

    Returns
    -------
    The keys of the program's JSON: `points` with one entry for each mass.
    """
    return _results.results(of._answer("pose-error", given))


@declared(Robot, "identify", positional=("fit", "experiments"), state=True, others=_AS_BOTH)
def identify(of: Any, given: Given) -> Identified:
    """Finds the values of the robot file that fit measurements best, with their deviations.

    The keywords of the state belong to every experiment that does not give them itself.

    Parameters
    ----------
    fit
        Values to identify: a list of paths, or a mapping from paths to None, to bounds (minimum, maximum), or to a
        mapping with `minimum`, `maximum`, `prior` and `prior_std`. A vector without a component stands for all its
        numbers, and * for every name, as in `materials.*.mass_kg_per_m`.
    experiments
        One mapping per state of the robot, or a single one: `responses` and `frequencies` as
        `funicular.read_measurements` returns them, `measured_pose`, `measured_tensions_n`, `measured_lengths_m`
        with their deviations, `cables` with the names of those that were mounted, and the keys of the state.
    profile
        Paths of fitted values whose interval of 95 % is also found by holding the value and fitting the others
        again; `details["values"]` has it under `profile`. * stands for any key.

    Raises
    ------
    InputError
        A value, a path or a measurement is wrong.
    StaticsError
        The robot has no equilibrium at any start.
    """
    state = {key: given.pop(key) for key in list(given) if key in STATE}
    given["experiments"] = with_state(given["experiments"], keywords("identify", state, of.cable_names))
    return identified(of.request("identify", **given))


@declared(Robot, "design", positional=("change",), without=("lengths_m", "hold_lengths_of_pose"), others=_AS_BOTH)
def design(of: Any, given: Given) -> Designed:
    """Chooses values of the robot file with which the robot is best at several poses.

    The poses are held, and the tensions of more cables than degrees of freedom follow `tension_rule`. The values
    move within their bounds until the goal improves no further.

    Parameters
    ----------
    change
        Values to choose: a mapping from paths to the largest change to both sides, or to bounds (minimum, maximum).
        A vector without a component stands for all its numbers, and * for every name, as in
        `cables.*.attachment_m`.
    poses
        Poses (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees]; the worst one counts. If not given: `pose`,
        or the pose of the robot file.
    avoid_hz
        Band (first, last) without natural frequencies at every pose [Hz].

    Returns
    -------
    Result with `x`, `fun`, `success`, `message`, `nit` as those of `scipy.optimize`, with the values per pose, and
    with `robot`.

    Raises
    ------
    InputError
        A value, a path or a bound is wrong.
    StaticsError
        A pose has no equilibrium, or no values within the bounds meet all demands; the message says what was
        reached.

    References
    ----------
    docs/theory.md, equations (60r) to (60t) and (95a) to (95c).
    """
    return designed(of.request("design", **given))


@declared(Robot, "uncertainty", positional=("deviations", "tolerances", "of"), others=_AS_BOTH)
def uncertainty(
    of: Any,
    given: Given,
    samples_file: File | None = None,
    resume: bool = False,
    discard: bool = False,
    threads: SupportsIndex | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Uncertainty:
    """Computes the deviations of results from deviations or tolerances of numbers of the robot file.

    Results are linear in the deviations where no cable may become slack and no frequencies may cross; elsewhere
    robots are sampled, on all processors. docs/uncertainty.md explains the result. Theory, section "Uncertainty".

    Parameters
    ----------
    deviations
        Standard deviations of normally distributed numbers: a mapping from paths to values in the unit of the
        number, or to percentages such as "1%"; or a list of texts such as "platform.mass_kg=1%". In a path * stands
        for any key. Each entry is a group with a share of its own.
    tolerances
        Tolerances of numbers that are anywhere within ± their tolerance, in the same form.
    poses
        Several poses, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
    at_hz
        Frequencies of the response [Hz], one or several. Results are its magnitudes in decibels of its unit, and its
        phases in degrees.
    samples_file, resume, discard
        File of the sampled robots, .parquet or .csv: FILE.partial holds them until all are there, and `resume`
        continues with them.
    threads
        Number of threads of this process; one per processor if not given.
    progress
        Function that is called with the number of finished items and of all items.

    Raises
    ------
    InputError
        A path, a deviation or another argument is wrong; the message says which and what to give.
    StaticsError
        The robot has no equilibrium.
    FileError
        The file of the samples cannot be written, or belongs to other work.
    """
    return deviations_of(of._uncertainty(given, samples_file, resume, discard, threads, progress))


def _of_rows(command: str, text: str) -> Callable[..., Sweep]:
    """Function of `map` or `sweep`, whose rows are computed and written in the same way; `text` is its documentation."""

    def rows(
        of: Any,
        given: Given,
        file: File | None = None,
        resume: bool = False,
        discard: bool = False,
        part: str | None = None,
        threads: SupportsIndex | None = None,
        executor: Executor | Callable[[], Executor] | None = None,
        chunks_per_task: SupportsIndex | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Sweep:
        found: Sweep = of._rows(command, given, part, file, resume, discard, threads, executor, chunks_per_task, progress)
        return found

    rows.__name__, rows.__doc__ = command, text
    return rows


declared(Robot, "map", positional=("grid", "quantities"), others=_AS_BOTH)(
    _of_rows(
        "map",
        """Computes quantities over poses, one row per pose.

        The rows are those of the program's `map`, bit for bit, with any number of threads or workers. A pose without
        equilibrium is a row with its reason, never an exception.

        Parameters
        ----------
        grid
            Axes of a grid of poses: x, y, z [m], roll, pitch, yaw [degrees], as in `{"x": (-4, 4, 81), "z": [0.5, 1,
            2]}`. A tuple is the first value, the last value and their number; anything else is values. x varies
            fastest, then y.
        quantities
            What is computed at every point; docs/sweeps.md has the list; `tension-min` and `tension-max` if not given.
        poses
            Poses instead of a grid, (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
        file
            File of the rows: .parquet, .csv or .vti. It is written when all rows are there; until then FILE.partial
            holds them, also after a crash. The rows of a Parquet file are read into memory at their first use.
        resume, discard
            Continue with the rows of the same sweep in FILE.partial, or delete them.
        part
            Part k of n, as in "3/8"; each part has its own Parquet `file`, and `funicular.merge` joins them.
        threads
            Number of threads of this process; one per processor if not given.
        executor
            Executor whose workers compute (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
            `MPIPoolExecutor`), or a function that makes an executor and is called again when the executor breaks.
        chunks_per_task
            Number of chunks of rows that a worker gets at once; chosen from measured times if not given.
        progress
            Function that is called with the number of finished rows and the number of all rows.

        Raises
        ------
        InputError
            An argument is wrong; the message says which and what to give.
        FileError
            The file cannot be written, or belongs to another sweep.
        ExecutorError
            The executor's workers died; `resume` of the exception continues.

        Warns
        -----
        RobotWarning
            The robot has a value that no usual robot has; once per call, before the rows are computed.
        """,
    )
)

declared(Robot, "sweep", positional=("vary", "quantities"), others="The other parameters are those of `map`.")(
    _of_rows(
        "sweep",
        """Computes quantities over values of the robot file, one row per combination, as the program's `sweep`.

        Parameters
        ----------
        vary
            Values of the robot file that vary, by their paths as in `with_`: `{"platform.mass_kg": (10, 90, 81)}`. A
            tuple is the first value, the last value and their number; anything else is values. The first path varies
            fastest. `*` for any key moves all numbers that match together: `{"cables.*.anchor_m.z": (5, 6, 3)}`.
        """,
    )
)


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


@declared(Analyses, "settle", positional=("release_n",), headings=REST, others=_AS_MODES)
def settle(of: Any, given: Given) -> Results:
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
    return _results.results(of._results("settle", given))


@declared(Analyses, "gust", positional=("output",), headings=REST, others=_AS_MODES)
def gust(of: Any, given: Given) -> Results:
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
    return _results.results(of._results("gust", given))


@declared(Analyses, "compare", positional=("below_hz",), headings=REST, others=_AS_MODES)
def compare(of: Any, given: Given) -> Results:
    """Compares every cable model with the catenary-dynamic model: frequencies found, missed and wrong, and the
    recommended model.

    Returns
    -------
    The keys of the program's JSON; lists of numbers are arrays.
    """
    return _results.results(of._results("compare", given))


@declared(Analyses, "gradient", positional=("of",), headings=REST, others=_AS_MODES)
def gradient(of: Any, given: Given) -> Results:
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
    return _results.results(of._results("gradient", given))


@declared(Analyses, "cable", positional=("name", "hz"), headings=REST, without=_RANGE, others=_AS_MODES)
def cable(of: Any, given: Given, name: str, hz: ArrayLike) -> Results:
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
    found: Results = of._cable(name, hz, given)
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
    return _results.state_space(*of._reduced({**given, "form": "state-space"}))


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
    return live_page(of._live(given), path)


@declared(Analyses, "report", positional=("path",), headings=REST, others=_AS_MODES)
def report(of: Any, given: Given, path: File | None = None) -> Page:
    """Makes a page in HTML about the equilibrium and its vibration, which notebooks show.

    Parameters
    ----------
    path
        File to which the page is also written.
    """
    html, warnings = of._report(given)
    return page(html, warnings, path)
