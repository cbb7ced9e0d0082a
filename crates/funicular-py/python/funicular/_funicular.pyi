"""
The compiled half of `funicular`; import `funicular` instead.
"""

from _typeshed import SupportsGetItem
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from funicular._pages import Page
from funicular._results import Equilibria, Modes, ReducedModel
from funicular._sweeps import Sweep
from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray
from os import PathLike
from pathlib import Path
from typing import Any, Final, SupportsFloat, SupportsIndex, final

__all__ = ["__version__", "Catenary", "Equilibrium", "Pose", "Robot", "SweepPlan", "SweepTable", "SweepWork", "answer", "complete_request", "complex_numbers", "imported", "merge_parts", "peaks", "plot_page", "real_numbers", "source_file", "text_of", "write_file"]

__version__: Final[str]

@final
class Catenary:
    """
    An elastic cable that hangs in its plane under its own weight; immutable.

    Parameters
    ----------
    span_m, rise_m
        Horizontal and vertical distance from the start to the end [m]; the rise may be negative.
    unstrained_length_m
        Unstrained length [m].
    weight_n_per_m
        Weight per unstrained length [N/m]; zero is a straight cable.
    axial_stiffness_n
        Axial stiffness EA [N].
    """
    def __copy__(self, /) -> Catenary: ...
    def __deepcopy__(self, /, memo: Any) -> Catenary: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, span_m: SupportsFloat | SupportsIndex, rise_m: SupportsFloat | SupportsIndex, *, unstrained_length_m: SupportsFloat | SupportsIndex, weight_n_per_m: SupportsFloat | SupportsIndex, axial_stiffness_n: SupportsFloat | SupportsIndex) -> Catenary: ...
    def __reduce__(self, /) -> tuple[Any, tuple[float, float, float, float, float]]: ...
    def __repr__(self, /) -> str: ...
    @property
    def horizontal_force_n(self, /) -> float:
        """
        Horizontal force at both ends [N].
        """
    def points_m(self, /, arc_length_m: ArrayLike) -> NDArray[float64]:
        """
        Points at unstrained arc lengths from the start [m]: horizontal and vertical distance from it, one row a point.
        """
    @property
    def tangent_n_per_m(self, /) -> NDArray[float64]:
        """
        Static stiffness of the start, end held, in plane: horizontal and vertical, 2×2 [N/m].
        """
    @property
    def tension_end_n(self, /) -> float:
        """
        Tension at the end [N].
        """
    @property
    def tension_start_n(self, /) -> float:
        """
        Tension at the start [N].
        """

@final
class Equilibrium:
    """
    A static equilibrium of a robot; immutable. Arrays with one entry a cable are in file order.

    Made by `Robot.equilibrium`.
    """
    def __copy__(self, /) -> Equilibrium: ...
    def __deepcopy__(self, /, memo: Any) -> Equilibrium: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, tuple[Robot, str]]: ...
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> Any: ...
    def all_equilibria(self, /) -> dict[str, Any]:
        """
        Every equilibrium that a search finds with the lengths of this one: the program's `statics --all`.

        Returns
        -------
        The keys of the program's JSON: `equilibria` has them, the lowest first, each with `pose`, `stable`, `energy_j`,
        `distance_m` and `tensions_platform_n`; `search` says what was searched. Lists of numbers are arrays.
        """
    @property
    def anchor_tensions(self, /) -> NDArray[float64]:
        """
        Tensions at the anchors [N].
        """
    def cable(self, /, name: str, hz: ArrayLike, *, cable_model: str | None = None, in_plane_only: bool = False) -> dict[str, Any]:
        """
        Dynamic stiffness of one cable's platform end, its anchor held, with the keys of the program's JSON.

        Parameters
        ----------
        name
            Name of the cable.
        hz
            Frequencies [Hz], a row of n.
        cable_model, in_plane_only
            As of `stiffness`.

        Returns
        -------
        `local` has `k_a`, `k_b`, `k_c`, `k_o` (n, complex): along the chord, coupling, normal in plane, out of plane [N/m];
        `world` is (n, 3, 3), complex, in world axes; `clamped_frequencies_hz` are those of the cable with both ends held.
        """
    def cable_points(self, /, points: SupportsIndex = ...) -> NDArray[float64]:
        """
        Points along every cable at rest, world axes [m]: (cables, points, 3), from the platform to the anchor, at equal
        parts of the unstrained length; 33 on each if `points` is not given.
        """
    @property
    def cables(self, /) -> list[dict[str, Any]]:
        """
        The cables one by one, with the keys of the program's JSON.
        """
    @property
    def chords(self, /) -> NDArray[float64]:
        """
        Chord lengths, attachment to anchor [m].
        """
    def compare(self, /, below_hz: SupportsFloat | SupportsIndex, *, assembly: str = "consistent", in_plane_only: bool = False) -> dict[str, Any]:
        """
        Every cable model side by side, each against the exact one: which frequencies it has, misses and gets wrong, and
        which model to take, with the keys of the program's JSON; lists of numbers are arrays.

        Parameters
        ----------
        below_hz
            Limit of the frequencies [Hz].
        assembly, in_plane_only
            As of `stiffness`.
        """
    def export(self, /, to: str, path: str | PathLike[str], *, segments: SupportsIndex = ..., modes_below_hz: SupportsFloat | SupportsIndex | None = None) -> list[str]:
        """
        Writes the robot at rest as a file of another program; returns what to know before trusting it.

        Parameters
        ----------
        to
            `opensees`, `moordyn` or `vtk`.
        path
            The file, written as a whole or not at all.
        segments
            Elements for each cable.
        modes_below_hz
            Limit of the modes in the file [Hz].

        Raises
        ------
        FileError
            The file cannot be written.
        """
    @property
    def forces(self, /) -> NDArray[float64]:
        """
        Forces of the cables on the platform, world axes [N], one row a cable.
        """
    def frf(self, /, hz: ArrayLike, input: str, output: str, *, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[complex128]:
        """
        Frequency response of one output to one input, complex, e^{+iωt}: [m/N] and so on by both.

        Parameters
        ----------
        hz
            Frequencies [Hz], a row of n.
        input
            Force `fx`, `fy`, `fz`, moment `mx`, `my`, `mz`, or `f:ux,uy,uz`, `m:ux,uy,uz` along a direction; world axes; a
            force on a cable as in `cable:3@0.5:fz`.
        output
            Displacement `x`, `y`, `z`, rotation `rx`, `ry`, `rz`, with `v` (velocity) or `a` (acceleration) before it, or
            `x:ux,uy,uz`, `v:…`, `a:…` along a direction; a point of a cable as in `cable:3@0.5:az`.
        input_point_m, output_point_m
            Where the force acts and the motion is measured, platform frame [m]; the origin if not given.
        cable_model, assembly, in_plane_only
            As of `stiffness`.

        Raises
        ------
        ResponseError
            An undamped natural frequency lies at one of the frequencies.
        """
    @property
    def iterations(self, /) -> int:
        """
        Iterations taken.
        """
    @property
    def lambda2(self, /) -> NDArray[float64]:
        """
        Irvine's λ² of the cables; NaN for a cable without tension.
        """
    @property
    def stiffness_min_n_per_m(self, /) -> float | None:
        """
        Least eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; None for ideal cables.
        """
    @property
    def lengths(self, /) -> NDArray[float64]:
        """
        Unstrained lengths [m].
        """
    @property
    def model(self, /) -> str:
        """
        How cables carry their load: `ideal`, `spring` or `catenary`.
        """
    def modes(self, /, below_hz: SupportsFloat | SupportsIndex, *, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, stations: SupportsIndex | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, damped: bool = True) -> Modes:
        """
        Every natural frequency below a limit, counted: none missed.

        Parameters
        ----------
        below_hz
            The limit [Hz].
        input, output
            Signals of a response, as of `frf`: every mode then has its residue and the height of its own peak.
        input_point_m, output_point_m
            As of `frf`.
        stations
            Number of points along every cable, ends included, whose displacements are wanted.
        cable_model, assembly, in_plane_only
            As of `stiffness`.
        damped
            Seek the damped partner of every mode, too, as the program does: damping ratios are then those of complex
            frequencies. False is faster; damping ratios are then of first order and there are no eigenvalues.
        """
    @property
    def nearest_pose_distance_m(self, /) -> float | None:
        """
        Distance from the pose asked [m], where fewer cables than degrees of freedom hold only the nearest; else None.
        """
    @property
    def pose(self, /) -> Pose:
        """
        Pose of the platform.
        """
    def receptance(self, /, hz: ArrayLike, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[complex128]:
        """
        Receptance of all six motions to all six wrench components about the platform origin, world axes: (n, 6, 6).

        The parameters are those of `frf`.
        """
    def reduce(self, /, below_hz: SupportsFloat | SupportsIndex, input: SupportsGetItem[int, str] | None = None, output: SupportsGetItem[int, str] | None = None, *, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, tolerance: SupportsFloat | SupportsIndex = ..., damping_at_hz: SupportsFloat | SupportsIndex | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> ReducedModel:
        """
        A second-order model M x'' + C x' + K x = B f, y = L x for control design, as `funicular.ReducedModel`.

        Parameters
        ----------
        below_hz
            Highest frequency that the model is for [Hz].
        input, output
            Lists of signals, as of `frf`; all forces and moments on the platform and all its displacements and rotations if
            not given.
        input_point_m, output_point_m
            As of `frf`.
        tolerance
            Maximum relative error of the responses by modes left out.
        damping_at_hz
            Frequency at which constant damping ratios are right when made viscous [Hz]; at every natural frequency if not
            given.
        cable_model, assembly, in_plane_only
            As of `stiffness`.
        """
    def report(self, /, path: str | PathLike[str] | None = None, *, below_hz: SupportsFloat | SupportsIndex = ..., input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> Page:
        """
        A page in HTML with everything about the robot at rest, as `funicular.Page`, which notebooks show.

        Parameters
        ----------
        path
            Write the page there, too.
        below_hz
            Limit of the frequencies [Hz].
        input, output
            Signals of the response on the page, as of `frf`; `fz` and `az` if not given, or `fx` and `ax` of a platform that
            cannot move along z.
        input_point_m, output_point_m, cable_model, assembly, in_plane_only
            As of `frf`.
        """
    @property
    def residual(self, /) -> float:
        """
        What is left of the wrench on the platform, over the sum of all forces.
        """
    @property
    def robot(self, /) -> Robot:
        """
        The robot that it is of.
        """
    @property
    def sag_ratio(self, /) -> NDArray[float64]:
        """
        Sags over chords; NaN for a cable without tension.
        """
    @property
    def stable(self, /) -> bool | None:
        """
        Whether every small motion is opposed; None for ideal cables, which are rigid.
        """
    def stiffness(self, /, at_hz: ArrayLike | None = None, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[Any]:
        """
        Stiffness about the platform origin, world axes [N/m, N, N m].

        Parameters
        ----------
        at_hz
            Frequency [Hz], or a row of n of them; 0 if not given.
        cable_model
            How cables answer motion: `catenary-dynamic`, `shallow-dynamic`, `shallow-static`, `catenary-static`, `spring`. If not given,
            `catenary-dynamic` for cables that hang, else `shallow-dynamic`; at 0 Hz the exact tangent of the static model, in wind
            with a drag that turns with the cables, which makes it unsymmetric (theory (49d)). A named model has the
            symmetric stiffness with the drag held, as have other frequencies.
        assembly
            `consistent`, or `paper`: the cables' end stiffness only, as Yuan et al. 2014.
        in_plane_only
            Leave out the stiffness of cables out of their planes, as Yuan et al. 2014.

        Returns
        -------
        (6, 6), real at 0 Hz and complex at another frequency; of a row of frequencies (n, 6, 6), complex.
        """
    @property
    def string_frequency_hz(self, /) -> NDArray[float64]:
        """
        First frequencies of the cables as taut strings [Hz]; NaN for one without tension or mass.
        """
    @property
    def tension_rule(self, /) -> str | None:
        """
        The rule that tensions were chosen by; None where there was no choice.
        """
    @property
    def tensions(self, /) -> NDArray[float64]:
        """
        Tensions at the platform [N].
        """
    def to_dict(self, /) -> dict[str, Any]:
        """
        The result with the keys of the program's JSON.
        """
    def to_pandas(self, /) -> Any:
        """
        The cables as a table of pandas, which has to be installed.
        """
    @property
    def warnings(self, /) -> list[str]:
        """
        What to know before trusting the result.
        """

@final
class Pose:
    """
    Position and orientation of the platform; immutable.

    Parameters
    ----------
    position_m
        Origin of the platform frame in the world [m], three numbers.
    roll_pitch_yaw_deg
        Angles [degrees], R = Rz(yaw) Ry(pitch) Rx(roll); zero if not given.
    quaternion_wxyz
        Instead of angles: w, x, y, z; normalised.
    """
    def __copy__(self, /) -> Pose: ...
    def __deepcopy__(self, /, memo: Any) -> Pose: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __new__(cls, /, position_m: ArrayLike, roll_pitch_yaw_deg: ArrayLike | None = None, *, quaternion_wxyz: ArrayLike | None = None) -> Pose: ...
    def __reduce__(self, /) -> tuple[Any, tuple[NDArray[float64], NDArray[float64]]]: ...
    def __repr__(self, /) -> str: ...
    @property
    def matrix(self, /) -> NDArray[float64]:
        """
        Homogeneous transformation from platform to world, 4×4.
        """
    @property
    def position_m(self, /) -> NDArray[float64]:
        """
        Origin of the platform frame in the world, x, y, z [m].
        """
    @property
    def quaternion_wxyz(self, /) -> NDArray[float64]:
        """
        Orientation as w, x, y, z with w ≥ 0.
        """
    @property
    def roll_pitch_yaw_deg(self, /) -> NDArray[float64]:
        """
        Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
        """
    @property
    def rotation(self, /) -> NDArray[float64]:
        """
        Rotation from platform to world axes, 3×3.
        """
    def to_array(self, /) -> NDArray[float64]:
        """
        Position and angles in one row, x, y, z, roll, pitch, yaw [m, degrees]: a row of `poses`.
        """

@final
class Robot:
    """
    A cable-driven parallel robot, read from the text of a robot file (TOML); immutable.

    Make one by `Robot.from_file`, `Robot.from_toml`, `Robot.from_dict` or `Robot.example`.
    """
    def __copy__(self, /) -> Robot: ...
    def __deepcopy__(self, /, memo: Any) -> Robot: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self, /) -> tuple[Any, tuple[str]]: ...
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> Any: ...
    def all_equilibria(self, /) -> dict[str, Any]:
        """
        `Equilibrium.all_equilibria` in the state of the robot file.
        """
    @property
    def anchors_m(self, /) -> NDArray[float64]:
        """
        Anchors in the world [m], one row a cable.
        """
    @property
    def attachments_m(self, /) -> NDArray[float64]:
        """
        Attachments in the platform frame [m], one row a cable.
        """
    def cable(self, /, name: str, hz: ArrayLike, *, cable_model: str | None = None, in_plane_only: bool = False) -> dict[str, Any]:
        """
        `Equilibrium.cable` in the state of the robot file.
        """
    @property
    def cable_names(self, /) -> list[str]:
        """
        Names of the cables, in file order: the order of every array with one entry a cable.
        """
    def check(self, /) -> dict[str, Any]:
        """
        The robot as it was read, with the keys of the program's `check`; lists of numbers are arrays.
        """
    def compare(self, /, below_hz: SupportsFloat | SupportsIndex, *, assembly: str = "consistent", in_plane_only: bool = False) -> dict[str, Any]:
        """
        `Equilibrium.compare` in the state of the robot file.
        """
    def equilibria(self, /, poses: ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: str = "catenary", tension_rule: str | None = None, *, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, threads: SupportsIndex | None = None) -> Equilibria:
        """
        The robot at rest in many states, computed side by side without Python's lock.

        A state without equilibrium is a row with its reason, never an exception. Each row is, bit for bit, what
        `equilibrium` gives.

        Parameters
        ----------
        poses
            (n, 3), (n, 6) or (n, 7): x, y, z [m], roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
        lengths_m
            (n, m): unstrained lengths [m] of m cables.
        threads
            How many threads compute; all processors if not given.

        The other parameters are those of `equilibrium`.
        """
    def equilibrium(self, /, pose: Pose | ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: str = "catenary", tension_rule: str | None = None, *, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None) -> Equilibrium:
        """
        The robot at rest.

        Parameters
        ----------
        pose
            A `Pose`, or x, y, z, or these and roll, pitch, yaw [m, degrees], or these and a quaternion w, x, y, z. The
            lengths follow; of fewer cables than degrees of freedom the nearest pose that they hold.
        lengths_m
            Unstrained lengths [m], one a cable, in file order. The pose follows.
            Without pose and lengths: the state of the robot file.
        static_model
            How cables carry their load: `ideal`, `spring` or `catenary`.
        tension_rule
            Which of the tensions that hold a pose, where more cables than degrees of freedom leave a choice: `lowest` (the default),
            `closest` (to `target_tension_n`), `middle` or `stiffest`.
        target_tension_n
            Tensions for the rule `closest` [N], one for all or one a cable.
        min_tension_n, max_tension_n
            Limits of the tension anywhere in a cable [N], instead of those of the robot file.
        mass_kg
            Mass of the platform [kg] instead of that of the robot file.
        force_n, moment_n_m, load_point_m
            A dead load on the platform instead of that of the robot file: force and moment in world axes [N, N m], and the
            point where the force acts, in the platform frame [m].
        wind_m_s
            Velocity of the wind instead of that of the robot file, world axes [m/s].
        cable_load_n_per_m
            Load per metre of every cable besides its weight, world axes [N/m].

        Raises
        ------
        StaticsError
            There is no such equilibrium; its `code` says in a word why not.
        InputError
            An argument means nothing.
        """
    @classmethod
    def example(cls, /) -> Robot:
        """
        The robot that the package carries: six cables of 4 mm (Yuan, Courteille and Deblaise 2014).
        """
    def export(self, /, to: str, path: str | PathLike[str], *, segments: SupportsIndex = ..., modes_below_hz: SupportsFloat | SupportsIndex | None = None) -> list[str]:
        """
        `Equilibrium.export` in the state of the robot file.
        """
    @property
    def motion(self, /) -> str:
        """
        Which motions the platform has: `rigid`, `point-mass` or a plane.
        """
    def frf(self, /, hz: ArrayLike, input: str, output: str, *, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[complex128]:
        """
        `Equilibrium.frf` in the state of the robot file.
        """
    @classmethod
    def from_dict(cls, /, robot: dict[str, Any]) -> Robot:
        """
        Reads a dictionary with the keys of a robot file, as `to_dict` gives it.

        Raises
        ------
        RobotFileError
            The dictionary is no robot; the message shows it as a file.
        """
    @classmethod
    def from_file(cls, /, path: str | PathLike[str]) -> Robot:
        """
        Reads a robot file.

        Raises
        ------
        RobotFileError
            The file is no robot; the message shows its lines.
        OSError
            The file cannot be read.
        """
    @classmethod
    def from_toml(cls, /, text: str) -> Robot:
        """
        Reads the text of a robot file.

        Raises
        ------
        RobotFileError
            The text is no robot; the message shows its lines.
        """
    @property
    def lengths(self, /) -> NDArray[float64] | None:
        """
        Unstrained lengths that the file gives [m], one a cable; None where it gives a pose or no state.
        """
    def map(self, /, grid: Mapping[str, ArrayLike] | None = None, quantities: SupportsGetItem[int, str] | None = None, *, poses: ArrayLike | None = None, pose: Pose | ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: str = "catenary", cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, up_to_hz: SupportsFloat | SupportsIndex = ..., tension_rule: str | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, part: str | None = None, threads: SupportsIndex | None = None, executor: Executor | Callable[[], Executor] | None = None, chunks_per_task: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None) -> Sweep:
        """
        Quantities over poses, one row a pose.

        The rows are those of the program's `map`, bit for bit, whatever computes them. A pose without equilibrium is a row
        with its reason, never an exception.

        Parameters
        ----------
        grid
            Values along axes x, y, z [m], roll, pitch, yaw [degrees]: `{"x": (-4, 4, 81), "z": [0.5, 1, 2]}`; a tuple is
            first, last and how many, anything else is values. x runs fastest, then y and so on.
        quantities
            What to compute, docs/sweeps.md has the list; tension-min and tension-max if not given.
        poses
            Instead of a grid (n, 3) or (n, 6): x, y, z [m], roll, pitch, yaw [degrees].
        pose, lengths_m
            Where axes stay that the grid does not have: x, y, z [m] and roll, pitch, yaw [degrees], or unstrained lengths
            [m]. As the robot file says if not given.
        up_to_hz
            Where the search for natural frequencies ends [Hz].
        file
            Write the rows to .parquet, .csv or .vti, as a whole; until then they are in FILE.partial and survive whatever
            ends the program. Of a Parquet file nothing is in memory before it is asked for.
        resume, discard
            Go on with what FILE.partial holds of the same sweep, or forget it.
        part
            The k-th of n parts, as "3/8", each with a Parquet `file` of its own; `funicular.merge` joins them.
        threads
            How many threads compute here; all processors if not given.
        executor
            Compute in the workers of an executor (`concurrent.futures`, Dask's `Client.get_executor()`, mpi4py's
            `MPIPoolExecutor`), or of a function that makes one, which is called again when it breaks.
        chunks_per_task
            Chunks of rows that a worker gets at once; by default what takes some seconds, as measured on the way.
        progress
            Is called now and then with the rows there are and all rows.

        The other parameters are those of `equilibrium` and `modes`.

        Raises
        ------
        InputError
            An argument means nothing.
        FileError
            The file cannot be written, or belongs to another sweep.
        ExecutorError
            The executor's workers died; its `resume` goes on.
        """
    @property
    def mass_kg(self, /) -> float:
        """
        Mass of the platform [kg].
        """
    def modes(self, /, below_hz: SupportsFloat | SupportsIndex, *, input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, stations: SupportsIndex | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, damped: bool = True) -> Modes:
        """
        `Equilibrium.modes` in the state of the robot file.
        """
    @property
    def name(self, /) -> str:
        """
        What the robot is called.
        """
    def parameters(self, /) -> dict[str, Any]:
        """
        Every number of the robot file, with the keys of the program's `parameters`: `path`, `value`, `unit`, `range`,
        `minimum`, `maximum`, `meaning` and `given`. The paths are those of `Robot.with_` and of `vary=`.
        """
    def pose_error(self, /, mass_kg: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsIndex], *, lengths_m: ArrayLike | None = None, tolerance_mm: SupportsFloat | SupportsIndex | None = None) -> dict[str, Any]:
        """
        How far the poses of spring and catenary cables are from those of ideal ones, over the mass of the platform.

        Parameters
        ----------
        mass_kg
            First mass, last mass [kg] and number of masses.
        lengths_m
            Unstrained lengths [m], which fix the comparison; those of the robot file if not given.
        tolerance_mm
            Distance between spring and catenary pose from which on the spring is good enough [mm]; `threshold` then says
            from which mass on.

        Returns
        -------
        The keys of the program's JSON: `points` with one entry for each mass.
        """
    def receptance(self, /, hz: ArrayLike, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[complex128]:
        """
        `Equilibrium.receptance` in the state of the robot file.
        """
    def reduce(self, /, below_hz: SupportsFloat | SupportsIndex, input: SupportsGetItem[int, str] | None = None, output: SupportsGetItem[int, str] | None = None, *, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, tolerance: SupportsFloat | SupportsIndex = ..., damping_at_hz: SupportsFloat | SupportsIndex | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> ReducedModel:
        """
        `Equilibrium.reduce` in the state of the robot file.
        """
    def report(self, /, path: str | PathLike[str] | None = None, *, below_hz: SupportsFloat | SupportsIndex = ..., input: str | None = None, output: str | None = None, input_point_m: ArrayLike | None = None, output_point_m: ArrayLike | None = None, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> Page:
        """
        `Equilibrium.report` in the state of the robot file.
        """
    def request(self, /, command: "str", **keywords: "object") -> dict[str, Any]:
        """
        The request of a command of the program for this robot: what `funicular COMMAND --print-request` prints, as
        `funicular.run` takes it.

        Parameters
        ----------
        command
            Name of the command, as `statics`.
        keywords
            The command's options by their names with _ for -, as `tension_rule="middle"`.
        """
    @property
    def source(self, /) -> str:
        """
        Where its numbers come from.
        """
    def stiffness(self, /, at_hz: ArrayLike | None = None, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[Any]:
        """
        `Equilibrium.stiffness` in the state of the robot file.
        """
    def sweep(self, /, vary: Mapping[str, ArrayLike], quantities: SupportsGetItem[int, str] | None = None, *, pose: Pose | ArrayLike | None = None, lengths_m: ArrayLike | None = None, static_model: str = "catenary", cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, up_to_hz: SupportsFloat | SupportsIndex = ..., tension_rule: str | None = None, target_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, mass_kg: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, wind_m_s: ArrayLike | None = None, cable_load_n_per_m: ArrayLike | None = None, file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False, part: str | None = None, threads: SupportsIndex | None = None, executor: Executor | Callable[[], Executor] | None = None, chunks_per_task: SupportsIndex | None = None, progress: Callable[[int, int], object] | None = None) -> Sweep:
        """
        Quantities over values of the robot file, one row a combination, as of the program's `sweep`.

        Parameters
        ----------
        vary
            Values by their paths in the robot file, as of `with_`: `{"platform.mass_kg": (10, 90, 81)}`; a tuple is first,
            last and how many, anything else is values. The first runs fastest.

        The other parameters are those of `map`.
        """
    def to_dict(self, /) -> dict[str, Any]:
        """
        The robot file as a dictionary.
        """
    def to_toml(self, /) -> str:
        """
        The text of the robot file, with all changes that were made.
        """
    def with_(self, /, changes: dict[str, Any] | None = None, *, mass_kg: SupportsFloat | SupportsIndex | None = None) -> Robot:
        """
        This robot with other values.

        Parameters
        ----------
        changes
            New values by their paths in the robot file, as of the program's `--set`, cables by their names:
            `{"materials.rope-4mm.diameter_m": 0.008, "cables.3.unstrained_length_m": 6.7}`.
        mass_kg
            Mass of the platform [kg]; inertia and centre of mass stay.

        Raises
        ------
        RobotFileError
            There is no such place in the file, or the value is not one for it.
        """

@final
class SweepPlan:
    """
    A map or sweep; a pickle of it is its request as JSON.
    """
    def __new__(cls, /, request: str, part: str | None = None) -> SweepPlan:
        """
        Of a request as JSON, or one of its parts, as "3/8".
        """
    def __reduce__(self, /) -> tuple[Any, tuple[str, str | None]]: ...
    def begin(self, /, file: str | PathLike[str] | None = None, resume: bool = False, discard: bool = False) -> SweepWork | None:
        """
        Begins to collect rows, in memory or in a file; None if the file has them all.
        """
    @property
    def chunk_rows(self, /) -> int:
        """
        Rows of every chunk but the last.
        """
    @property
    def chunks(self, /) -> int:
        """
        The chunk behind the last.
        """
    def compute(self, /, first: SupportsIndex, end: SupportsIndex, threads: SupportsIndex = ...) -> bytes:
        """
        Chunks from `first` to before `end`, as bytes that `SweepWork.add` takes.
        """
    @property
    def first_chunk(self, /) -> int:
        """
        The first chunk of rows; each is computed by itself.
        """
    @property
    def rows(self, /) -> int:
        """
        Number of rows.
        """

@final
class SweepTable:
    """
    The rows of a sweep, as columns in memory.
    """
    def __arrow_c_stream__(self, /, requested_schema: Any | None = None) -> Any:
        """
        The rows for any library that knows Arrow's C stream, without copies.
        """
    def column(self, /, index: SupportsIndex) -> Any:
        """
        One column: numbers (NaN where there is none), flags, or a list of texts and None.
        """
    @property
    def complete(self, /) -> bool:
        """
        Whether every row of the plan is there.
        """
    @property
    def fields(self, /) -> list[tuple[str, str, str]]:
        """
        Names, units and meanings of the columns.
        """
    @property
    def plan(self, /) -> str:
        """
        Points, quantities and options, as JSON.
        """
    @staticmethod
    def read(path: str | PathLike[str]) -> SweepTable:
        """
        Reads a Parquet file that a sweep has written.
        """
    @property
    def robot_file(self, /) -> str:
        """
        Text of the robot file.
        """
    @property
    def rows(self, /) -> int:
        """
        Number of rows.
        """
    def write(self, /, path: str | PathLike[str]) -> None:
        """
        Writes .parquet, .csv or .vti, as a whole or not at all.
        """

@final
class SweepWork:
    """
    Rows of a plan as they come, in order.
    """
    def add(self, /, chunks: bytes) -> None:
        """
        Takes chunks that `SweepPlan.compute` has made, the next ones.
        """
    @property
    def done(self, /) -> int:
        """
        Rows that are there.
        """
    def finish(self, /) -> SweepTable | None:
        """
        Ends it: writes the file, as a whole. The table of rows; None where that would be read from a Parquet file.
        """
    def interrupt(self, /) -> str | None:
        """
        Ends it early: what is safe, in a sentence; None in memory.
        """
    @property
    def journal(self, /) -> Path | None:
        """
        The file that holds the rows until the end; None in memory.
        """
    @property
    def next_chunk(self, /) -> int:
        """
        The first chunk that is missing.
        """
    def run(self, /, threads: SupportsIndex | None = None, progress: Any | None = None) -> None:
        """
        Computes all chunks that are missing here, side by side; `progress` is called with the rows there and all rows.
        """

def answer(request: str) -> str:
    """
    Results of a request, both as JSON; of any command that computes them from the request alone.
    """

def complete_request(request: str) -> str:
    """
    A request as JSON with every key that it has, defaults among them.
    """

def complex_numbers(name: str, values: ArrayLike) -> NDArray[complex128]:
    """
    Complex numbers of any shape as an array; `name` is what errors call them. For the package's own functions in Python.
    """

def imported(request: str) -> tuple[str, list[str], list[str]]:
    """
    Robot file, assumptions and losses of a request of `import`.
    """

def merge_parts(parts: SupportsGetItem[int, str | PathLike[str]], path: str | PathLike[str]) -> int:
    """
    Joins the parts of a map or sweep; the number of rows.
    """

def peaks(hz: ArrayLike, response: ArrayLike, *, prominence_db: SupportsFloat | SupportsIndex = ...) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
    """
    Peaks of a response: frequencies [Hz], heights above the valleys beside them [dB], magnitudes.

    Parameters
    ----------
    hz
        Frequencies [Hz], ascending.
    response
        What `frf` gives at them.
    prominence_db
        Least height of a peak above the valleys beside it [dB]; 1 if not given.
    """

def plot_page(path: str | PathLike[str], label: str, call: str) -> tuple[str, list[str]]:
    """
    Page and notes of the Parquet file of a map or sweep; `label` says where the rows are, `call` writes the page again.
    """

def real_numbers(name: str, values: ArrayLike) -> NDArray[float64]:
    """
    Real numbers of any shape as an array; `name` is what errors call them. For the package's own functions in Python.
    """

def source_file(path: str | PathLike[str]) -> str:
    """
    A file of another program as a request has it: path and text, and the encoding if it had to be guessed, as JSON.
    """

def text_of(request: str, call: str) -> tuple[str, list[str]]:
    """
    Text and warnings of a request of `report`, `paper` or `export`; `call` is what writes a page again.
    """

def write_file(path: str | PathLike[str], text: str) -> None:
    """
    Writes a file as a whole or not at all.
    """
