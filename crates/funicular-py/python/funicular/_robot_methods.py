"""Methods of `Robot` that compute. Their keywords are the declared keys of the commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from typing import Any, SupportsIndex

from numpy import asarray, ceil, linspace
from numpy.typing import ArrayLike

from funicular import _results
from funicular._declared import STATE, Given, declared
from funicular._design import Designed, designed
from funicular._errors import InputError
from funicular._funicular import Equilibrium, Robot, number, numbers
from funicular._identify import Identified, identified
from funicular._reading import File, keywords, with_state
from funicular._results import Equilibria
from funicular._sweeps import Sweep
from funicular._uncertainty import Uncertainty, uncertainty as deviations_of
from funicular.results import (
    CalibrateResults,
    ClearanceResults,
    EstimateResults,
    LoadsResults,
    ObservabilityResults,
    PayloadResults,
    PoseErrorResults,
    ProveResults,
    SimulateResults,
    SpeedsResults,
    TrajectoryResults,
    WinchesResults,
    WorkspaceResults,
)

_AS_REST = "The other parameters are those of `Robot.equilibrium`."
_AS_BOTH = "The other parameters are those of `Robot.equilibrium` and of `Equilibrium.stiffness`."


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
def payload(of: Any, given: Given) -> PayloadResults:
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
    return _results.of_answered(PayloadResults, of._answer("payload", given))


@declared(Robot, "loads", positional=("pose", "static_model"), others=_AS_REST)
def loads(of: Any, given: Given) -> LoadsResults:
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
    return _results.of_answered(LoadsResults, of._answer("loads", given))


@declared(Robot, "speeds", positional=("pose", "static_model"), others=_AS_REST)
def speeds(of: Any, given: Given) -> SpeedsResults:
    """Computes what the winches do while the platform moves, and how fast their limits let it be.

    Returns
    -------
    The keys of the program's JSON: `every_direction` and `directions` with the largest speeds and what limits them,
    `cables` with rates, torques, largest speeds and used parts of the limits, and `required` with `speed_factor` and the
    powers of all motors; without `required` if no velocity is required.

    Raises
    ------
    StaticsError
        The robot has no such equilibrium, or its lengths have no rates there.
    """
    return _results.of_answered(SpeedsResults, of._answer("speeds", given))


@declared(Robot, "winches", positional=("grid", "pose"), others=_AS_REST)
def winches(of: Any, given: Given) -> WinchesResults:
    """Computes the winches that a robot needs over its poses, for everything that is required there.

    Returns
    -------
    The keys of the program's JSON: `winches` with the numbers of one winch that serves every cable and of each cable,
    `asked` with what asks for each number of the first, `poses`, `held`, `not_held`, and `offers` with the comparison.

    Raises
    ------
    StaticsError
        No pose holds every required load.
    """
    return _results.of_answered(WinchesResults, of._answer("winches", given))


@declared(Robot, "trajectory", positional=("path", "move_to", "pose"), without=("path",), others=_AS_REST, files=True)
def trajectory(
    of: Any, given: Given, path: File | Mapping[str, ArrayLike] | Callable[[float], ArrayLike] | None = None
) -> TrajectoryResults:
    """Computes the motion along a path: lengths with their rates, tensions with the inertia, winches, and what limits them.

    Parameters
    ----------
    path
        Path over time: columns `t_s`, `x_m`, `y_m`, `z_m` and, where the platform turns, `roll_deg`, `pitch_deg`,
        `yaw_deg`, as a mapping, a data frame or a CSV file; or a function of the time [s] that returns x, y, z [m] or
        x, y, z, roll, pitch, yaw [m, degrees]. A function needs `duration_s` and `sample_time_s`. A spline of the
        fifth degree passes the rows.

    Returns
    -------
    The keys of the program's JSON: `within_limits`, `most_used`, `extremes`, `stations`, `limit_changes`, and `rows` with
    a number or a list with a number per cable at every time.

    Raises
    ------
    StaticsError
        The cables do not hold the platform at some time of the path.
    """
    if callable(path):
        path = _sampled(path, given)
    if path is not None:
        given["path"] = path
    return _results.of_answered(TrajectoryResults, of._answer("trajectory", given))


# Maximum number of rows of a function of the time.
_MAX_ROWS = 1_000_000


def _sampled(path: Callable[[float], ArrayLike], given: Given) -> dict[str, ArrayLike]:
    """Columns of a path that is a function of the time."""
    if given.get("duration_s") is None or given.get("sample_time_s") is None:
        raise InputError("a path that is a function needs its `duration_s` and the `sample_time_s` of its rows")
    duration, step = number("duration_s", given.pop("duration_s")), number("sample_time_s", given["sample_time_s"])
    if not duration > 0 or not step > 0 or duration / step > _MAX_ROWS:
        raise InputError(
            f"a path that is a function has the `duration_s` {duration:g} s and the `sample_time_s` {step:g} s: give both "
            f"above zero, with at most {_MAX_ROWS} rows"
        )
    times = linspace(0.0, duration, max(int(ceil(duration / step)), 1) + 1)
    called = f"path: {getattr(path, '__name__', 'the function')}"
    rows: list[list[float]] = []
    for time in times:
        row = numbers(f"{called}({time:g})", path(float(time)))
        if len(row) not in (3, 6) or (rows and len(row) != len(rows[0])):
            raise InputError(
                f"`{called}({time:g})` has {len(row)} numbers: the function of a path has to return x, y, z [m] or x, y, z, "
                "roll, pitch, yaw [m, degrees], the same at all times"
            )
        rows.append(row)
    count = len(rows[0])
    names = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")[:count]
    return {"t_s": times, **dict(zip(names, asarray(rows).T, strict=True))}


@declared(Robot, "simulate", positional=("scenario", "duration_s"), files=True)
def simulate(
    of: Any,
    given: Given,
    progress: Callable[[int, int], object] | None = None,
) -> SimulateResults:
    """Simulates large motion in time of platform and sagging ropes.

    Parameters
    ----------
    scenario
        What happens: a mapping from `release`, `pick`, `lengths`, `tension`, `stop`, `push`, `anchor` and `cut` to lists
        of events, each a mapping with the keys of docs/simulation.md. The `table` of an event of `lengths` or `anchor` may be a function of the
        time [s] from its beginning on, which returns a mapping from the columns of such a table to numbers; the event then
        needs its `duration_s`.
    point
        Points of the platform whose motion is a part of the result: a mapping from names to places x, y, z in the platform
        frame [m].
    progress
        Function that is called with the number of rows that are done, and of all rows; first for the run, then for the
        finer one that shows the error.

    Returns
    -------
    The keys of the program's JSON: `rows` with pose, velocities, tensions, lengths and energies at every time, `errors`
    with the difference of each column from a finer run, `peaks`, `slack`, `cuts` and `steps`.

    Raises
    ------
    InputError
        An event cannot happen, or the robot has a part that is not simulated.
    NoSolutionError
        The start is not a stable equilibrium.
    KeyboardInterrupt
        Ctrl-C stopped the run; any exception that another handler of signals raises arrives as well. Its attribute
        `partial_results` has the `Results` until then.

    References
    ----------
    docs/theory.md, equations (97a) to (97k).
    """
    if "scenario" in given:
        given["scenario"] = _tabled(given["scenario"])
    return _results.of_answered(SimulateResults, of._answer("simulate", given, progress=progress))


# Time between the rows of a function [s], and least number of its parts. Between the rows lies a cubic spline: it is right
# to (2πf·0.01 s)⁴/384, which is 4e-4 of the amplitude at 10 Hz.
_TABLE_STEP_S = 0.01
_MIN_PARTS = 100

# Maximum duration of a function [s]: its table has then a million rows.
_MAX_TABLE_S = 10_000


def _tabled(scenario: Any) -> Any:
    """The scenario with tables in the place of functions of the time."""
    if not isinstance(scenario, Mapping):
        return scenario

    def event(kind: str, place: int, of: Any) -> Any:
        if not isinstance(of, Mapping) or not callable(of.get("table")):
            return of
        function = of["table"]
        name = f"scenario.{kind}[{place}]"
        rest = {key: value for key, value in of.items() if key not in ("table", "duration_s")}
        if of.get("duration_s") is None:
            raise InputError(f"`{name}`: a table that is a function needs `duration_s`")
        duration = number(f"{name}.duration_s", of["duration_s"])
        if not 0 < duration <= _MAX_TABLE_S:
            raise InputError(f"`{name}.duration_s` is {duration:g} s: give more than 0, at most {_MAX_TABLE_S} s")

        times = linspace(0.0, duration, max(int(ceil(duration / _TABLE_STEP_S)), _MIN_PARTS) + 1)
        called = f"{name}.table: {getattr(function, '__name__', 'the function')}"
        columns: dict[str, list[float]] = {}
        for time in times:
            row = function(float(time))
            if not isinstance(row, Mapping) or not all(isinstance(key, str) for key in row):
                raise InputError(
                    f"`{called}({time:g})` is of type {type(row).__name__}: it has to return a mapping from columns to "
                    "numbers, such as x_m, y_m and z_m"
                )
            if columns and row.keys() != columns.keys():
                raise InputError(
                    f"`{called}({time:g})` has the columns {', '.join(row)}, and before it had {', '.join(columns)}: it has "
                    "to return the same columns at all times"
                )
            for key, value in row.items():
                columns.setdefault(key, []).append(number(f'{called}({time:g})["{key}"]', value))
        return {**rest, "table": {"t_s": times, **columns}}

    tabled = {
        kind: [event(kind, k, of) for k, of in enumerate(scenario[kind])]
        for kind in ("lengths", "anchor")
        if isinstance(scenario.get(kind), (list, tuple))
    }
    return {**scenario, **tabled}


@declared(Robot, "clearance", positional=("pose", "static_model"), others=_AS_REST)
def clearance(of: Any, given: Given) -> ClearanceResults:
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
    return _results.of_answered(ClearanceResults, of._answer("clearance", given))


@declared(
    Robot,
    "workspace",
    positional=("at_least", "at_most", "grid"),
    without=("lengths_m", "hold_lengths_of_pose", "compare"),
    others=_AS_BOTH,
    files=True,
)
def workspace(
    of: Any,
    given: Given,
    compare: Robot | None = None,
    threads: SupportsIndex | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> WorkspaceResults:
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
    threads
        Number of threads of this process; one per processor if not given.
    progress
        Function that is called with the number of positions that are done, and of those known to be needed.

    Returns
    -------
    The keys of the program's JSON: `volumes` with the steps or the number of rays of each, `parts`, `holes`,
    `touches`, `bounds_m`, `inner_box`, `sections`, `rays`, `compared`, `proof`; `vertices_m` (n, 3) and `triangles` (m, 3) of the closed
    surface, whose first `triangles_of_surface` lie on the set and the others on the box of the grid.

    Raises
    ------
    InputError
        A quantity, an axis or another argument is wrong; the message says which and what to give.
    NoSolutionError
        No position of the grid meets the conditions.
    KeyboardInterrupt
        Ctrl-C stopped the search; any exception that another handler of signals or `progress` raises arrives as well. Its
        attribute `partial_results` has the `Results` of the steps that were ready, if there is a surface.

    References
    ----------
    docs/theory.md, section 10b.
    """
    if compare is not None:
        given = {**given, "compare": {"text": compare.to_toml()}}
    return _results.of_answered(WorkspaceResults, of._answer("workspace", given, threads=threads, progress=progress))


@declared(Robot, "prove", positional=("pose", "within_m", "within_deg"), others=_AS_REST, files=True)
def prove(
    of: Any,
    given: Given,
    threads: SupportsIndex | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> ProveResults:
    """Proves that required loads are held within the tension limits at every pose of a box, not only at samples of it.

    Parameters
    ----------
    threads
        Number of threads of this process; one per processor if not given.
    progress
        Function that is called with the number of boxes that are done, and of the most that are wanted.

    Returns
    -------
    The keys of the program's JSON: `verdict` with `margin_n` or `reason`, `inside`, `outside` and `undecided` in
    `volume_unit`, `undecided_share`, `tried`, `end`, `worst`, and `boxes` with their verdicts.

    Raises
    ------
    InputError
        An argument is wrong, or the robot has something for which no bound over a box is derived; the message says which.
    KeyboardInterrupt
        Ctrl-C stopped the division; its attribute `partial_results` has the `Results` of what was proved until then.

    References
    ----------
    docs/theory.md, section 10b.
    """
    return _results.of_answered(ProveResults, of._answer("prove", given, threads=threads, progress=progress))


@declared(Robot, "pose-error", positional=("mass_kg",), others=_AS_REST)
def pose_error(of: Any, given: Given) -> PoseErrorResults:
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
    return _results.of_answered(PoseErrorResults, of._answer("pose-error", given))


@declared(Robot, "identify", positional=("fit", "experiments"), state=True, others=_AS_BOTH, files=True)
def identify(of: Any, given: Given) -> Identified:
    """Finds the values of the robot file that fit measurements best, with their deviations.

    The keywords of the state belong to every experiment that does not give them itself.

    Parameters
    ----------
    fit
        Values to identify: a list of paths, or a mapping from paths to None, to bounds (minimum, maximum), or to a
        mapping with `minimum`, `maximum`, `prior` and `prior_std`. A vector without a component stands for all its
        numbers, and * for every name, as in `materials.*.mass_kg_per_m`. Without values, the natural frequencies of
        time histories are found alone: `details["histories"]`.
    experiments
        One mapping per state of the robot, or a single one: `responses`, `frequencies` and `histories` as
        `funicular.read_measurements` returns them, `measured_pose`, `measured_tensions_n`, `measured_lengths_m`
        with their deviations, `cables` with the names of those that were mounted, `payload_kg` with its
        `payload_center_m`, and the keys of the state.
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
    given["experiments"] = with_state(given.get("experiments", []), keywords("identify", state, of.cable_names))
    return identified(of.request("identify", **given))


@declared(Robot, "calibrate", positional=("readings", "unknowns"), files=True)
def calibrate(of: Any, given: Given) -> CalibrateResults:
    """Calibrates anchors, attachments, offsets and more from readings of lengths at poses that are not known.

    Parameters
    ----------
    readings
        One row per pose: columns `length_NAME_m` (or `_mm`, `_in`) of every cable, and optionally `x_m`, `y_m`, `z_m`,
        `roll_deg`, `pitch_deg`, `yaw_deg`, as a mapping, a data frame or a CSV file.
    prior
        Values known beforehand: a mapping from kinds of unknowns or paths of values to a standard deviation, or to a value
        and its deviation.
    poses
        Candidates of a proposal (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].

    Returns
    -------
    The keys of the program's JSON: `fit` and `determined` as sentences, `is_determined`, `values` with deviations and
    intervals, `anchors` with their covariance, `distances`, `rows`, `weak_combinations`, `walk`, `minima`, `proposals`, `robot_file`
    and `covariance`, which `Robot.uncertainty` takes.

    Raises
    ------
    InputError
        A column, a value or a name is wrong, or there are fewer readings than unknowns.
    StaticsError
        The readings fit at no start.

    References
    ----------
    docs/theory.md, equations (96a) to (96k).
    """
    if given.get("prior") is not None:
        given = {**given, **keywords("calibrate", {"prior": given["prior"]}, of.cable_names)}
    return _results.of_answered(CalibrateResults, of._answer("calibrate", given))


@declared(Robot, "estimate", positional=("log",), files=True)
def estimate(of: Any, given: Given) -> EstimateResults:
    """Estimates pose, velocity, payload and tensions over time from the log of a machine, each with its deviation, and alarms.

    Parameters
    ----------
    log
        One row per time: `t_s`, `length_NAME_m` of every cable, and optionally `tension_anchor_NAME_n`, `gyroscope_x_rad_s`,
        `accelerometer_x_m_s2`, `tracker_x_m` and more, as a mapping, a data frame or a CSV file.

    Returns
    -------
    The keys of the program's JSON: `fit` and `not_determined` as sentences, `alarms`, `sensors`, `cable_errors`, and `rows`
    over time.

    Raises
    ------
    InputError
        A column, a time or a value is wrong, or the lengths of a cable are missing.
    NoSolutionError
        The lengths have no equilibrium.

    References
    ----------
    docs/theory.md, equations (97r) to (97za).
    """
    return _results.of_answered(EstimateResults, of._answer("estimate", given))


@declared(Robot, "observability", positional=("sensors", "pose"), others=_AS_REST)
def observability(of: Any, given: Given) -> ObservabilityResults:
    """Computes which numbers sensors determine at poses at rest, before any reading, and what would add most.

    Parameters
    ----------
    sensors
        Sensors besides the encoders of all cables: `tensions`, `cable-angles`, `gyroscope`, `accelerometer`, `tracker`;
        `none` for the encoders alone.

    Returns
    -------
    The keys of the program's JSON: `numbers` with the deviation of each number with these sensors and with the encoders
    alone, `cases` with the deviations for each further sensor and pose, `best_addition`, and `not_determined` as
    sentences.

    Raises
    ------
    StaticsError
        The cables hold the platform at none of these poses.
    NoSolutionError
        The filter finds no balance at a pose.

    References
    ----------
    docs/theory.md, equation (97r).
    """
    return _results.of_answered(ObservabilityResults, of._answer("observability", given))


@declared(Robot, "design", positional=("change",), without=("lengths_m", "hold_lengths_of_pose"), others=_AS_BOTH, files=True)
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


@declared(Robot, "uncertainty", positional=("deviations", "tolerances", "of"), others=_AS_BOTH, files=True)
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
    covariance
        Numbers that deviate together: a list of mappings with `first`, `second` (paths) and `covariance`, as the key
        `covariance` of the results of `calibrate`.
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
    return deviations_of(of._answer("uncertainty", given, threads, progress, samples_file, resume, discard))


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
