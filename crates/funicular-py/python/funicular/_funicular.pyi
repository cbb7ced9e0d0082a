"""
The compiled half of `funicular`; import `funicular` instead.
"""

from funicular._results import Equilibria, Modes
from numpy import complex128, float64
from numpy.typing import ArrayLike, NDArray
from os import PathLike
from typing import Any, Final, SupportsFloat, SupportsIndex, final

__all__ = ["__version__", "Catenary", "Equilibrium", "Pose", "Robot", "peaks"]

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
    def __reduce__(self, /) -> tuple[Any, tuple[Robot, dict[str, Any]]]: ...
    def __repr__(self, /) -> str: ...
    def _repr_html_(self, /) -> Any: ...
    @property
    def anchor_tensions(self, /) -> NDArray[float64]:
        """
        Tensions at the anchors [N].
        """
    def cable_points(self, /, points: SupportsIndex = 33) -> NDArray[float64]:
        """
        Points along every cable at rest, world axes [m]: (cables, points, 3), from the platform to the anchor, at equal
        parts of the unstrained length.
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
    def least_stiffness_n_per_m(self, /) -> float | None:
        """
        Least eigenvalue of the scaled static stiffness [N/m]; None for ideal cables.
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
    def modes(self, /, below_hz: SupportsFloat | SupportsIndex, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, damped: bool = False) -> Modes:
        """
        Every natural frequency below a limit, counted: none missed.

        Parameters
        ----------
        below_hz
            The limit [Hz].
        cable_model, assembly, in_plane_only
            As of `stiffness`.
        damped
            Seek the damped partner of every mode, too: damping ratios are then those of complex frequencies and not of
            first order.
        """
    @property
    def nearest_pose_distance_m(self, /) -> float | None:
        """
        Distance from the pose asked [m], where fewer cables than freedoms hold only the nearest; else None.
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
    def stiffness(self, /, hz: ArrayLike | None = None, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[Any]:
        """
        Stiffness about the platform origin, world axes [N/m, N, N m].

        Parameters
        ----------
        hz
            Frequency [Hz], or a row of n of them.
        cable_model
            How cables answer motion: `exact`, `closed-form`, `static-sag`, `catenary-tangent`, `spring`. If not given,
            `exact` for cables that hang, else `closed-form`; at 0 Hz the exact tangent of the static model.
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
    @property
    def cable_names(self, /) -> list[str]:
        """
        Names of the cables, in file order: the order of every array with one entry a cable.
        """
    def equilibria(self, /, poses: ArrayLike | None = None, lengths: ArrayLike | None = None, model: str = "catenary", tension_rule: str | None = None, *, wanted_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None, threads: SupportsIndex | None = None) -> Equilibria:
        """
        The robot at rest in many states, computed side by side without Python's lock.

        A state without equilibrium is a row with its reason, never an exception. Each row is, bit for bit, what
        `equilibrium` gives.

        Parameters
        ----------
        poses
            (n, 3), (n, 6) or (n, 7): x, y, z [m], roll, pitch, yaw [degrees] or a quaternion w, x, y, z.
        lengths
            (n, m): unstrained lengths [m] of m cables.
        threads
            How many threads compute; all processors if not given.

        The other parameters are those of `equilibrium`.
        """
    def equilibrium(self, /, pose: Pose | ArrayLike | None = None, lengths: ArrayLike | None = None, model: str = "catenary", tension_rule: str | None = None, *, wanted_tension_n: ArrayLike | None = None, min_tension_n: SupportsFloat | SupportsIndex | None = None, max_tension_n: SupportsFloat | SupportsIndex | None = None, force_n: ArrayLike | None = None, moment_n_m: ArrayLike | None = None, load_point_m: ArrayLike | None = None) -> Equilibrium:
        """
        The robot at rest.

        Parameters
        ----------
        pose
            A `Pose`, or x, y, z, or these and roll, pitch, yaw [m, degrees], or these and a quaternion w, x, y, z. The
            lengths follow; of fewer cables than freedoms the nearest pose that they hold.
        lengths
            Unstrained lengths [m], one a cable, in file order. The pose follows.
            Without pose and lengths: the state of the robot file.
        model
            How cables carry their load: `ideal`, `spring` or `catenary`.
        tension_rule
            Which of the tensions that hold a pose, where more cables than freedoms leave a choice: `lowest` (the default),
            `closest` (to `wanted_tension_n`), `middle` or `stiffest`.
        wanted_tension_n
            Tensions for the rule `closest` [N], one for all or one a cable.
        min_tension_n, max_tension_n
            Limits of the tension anywhere in a cable [N], instead of those of the robot file.
        force_n, moment_n_m, load_point_m
            A dead load on the platform instead of that of the robot file: force and moment in world axes [N, N m], and the
            point where the force acts, in the platform frame [m].

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
    @property
    def freedoms(self, /) -> str:
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
    @property
    def mass_kg(self, /) -> float:
        """
        Mass of the platform [kg].
        """
    def modes(self, /, below_hz: SupportsFloat | SupportsIndex, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False, damped: bool = False) -> Modes:
        """
        `Equilibrium.modes` in the state of the robot file.
        """
    @property
    def name(self, /) -> str:
        """
        What the robot is called.
        """
    def receptance(self, /, hz: ArrayLike, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[complex128]:
        """
        `Equilibrium.receptance` in the state of the robot file.
        """
    @property
    def source(self, /) -> str:
        """
        Where its numbers come from.
        """
    def stiffness(self, /, hz: ArrayLike | None = None, *, cable_model: str | None = None, assembly: str = "consistent", in_plane_only: bool = False) -> NDArray[Any]:
        """
        `Equilibrium.stiffness` in the state of the robot file.
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

def peaks(hz: ArrayLike, response: ArrayLike, *, prominence_db: SupportsFloat | SupportsIndex = 1.0) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
    """
    Peaks of a response: frequencies [Hz], heights above the valleys beside them [dB], magnitudes.

    Parameters
    ----------
    hz
        Frequencies [Hz], ascending.
    response
        What `frf` gives at them.
    prominence_db
        Least height of a peak above the valleys beside it [dB].
    """
