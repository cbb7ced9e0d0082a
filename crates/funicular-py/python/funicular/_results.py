"""Results as NumPy arrays, made from the keys of the program's JSON."""

import copy
import dataclasses
import functools
import inspect
import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from funicular import _show
from funicular._errors import InputError, needs
from funicular._funicular import Answered, answer, matlab_file, suggested, write_unit
from funicular._reading import read


class Row(dict[str, Any]):
    """Part of results: a dictionary with the keys of the program's JSON, which are attributes as well.

    A key that the part does not have is None as an attribute. A key with the name of a method of dictionaries, such as
    `values`, is read as `row["values"]`.
    """

    _PARTS: ClassVar[dict[str, "type[Row]"]] = {}

    def __getattr__(self, name: str) -> Any:
        if name in self:
            return self[name]
        if name in _declared_keys(type(self)):
            return None
        known = [key for key in (*self, *_declared_keys(type(self))) if key.isidentifier()]
        hint = "" if name.startswith("_") else suggested(name, known)
        raise AttributeError(f"{type(self).__name__} has no key `{name}`{hint}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self, *_declared_keys(type(self))})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, dict) and _same(dict(self), dict(other))

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None


@functools.cache
def _declared_keys(of: type[Row]) -> frozenset[str]:
    """Keys of a class of results."""
    return frozenset(name for name in inspect.get_annotations(of) if not name.startswith("_"))


def with_arrays(found: Any, kind: type[Row] | None = None) -> Any:
    """Replaces lists of numbers by arrays, and pairs of `real` and `imag` by complex arrays.

    Dictionaries become rows of a kind, if there is one.
    """
    if isinstance(found, dict):
        if found.keys() == {"real", "imag"}:
            return np.array(found["real"]) + 1j * np.array(found["imag"])
        parts = {} if kind is None else kind._PARTS
        made = {key: with_arrays(value, parts.get(key)) for key, value in found.items()}
        return made if kind is None else kind(made)
    if isinstance(found, list):
        if found and _are_numbers(found):
            return np.array(found)
        return [with_arrays(value, kind) for value in found]
    return found


class Results(Row):
    """Results with the keys of the program's JSON, as a dictionary that notebooks show as tables.

    The keys are attributes as well: `found["rows"]` and `found.rows`. The classes of `funicular.results` have those of each
    command with their types, units and meanings.
    """

    __module__ = "funicular"

    def __repr__(self) -> str:
        command = self.get("command", "results")
        return f"<Results of {command}: {', '.join(key for key in self if key not in ('schema', 'command'))}>"

    def _repr_html_(self) -> str:
        return _show.html(self)

    _answered: Answered | None = None

    def to_dict(self) -> dict[str, Any]:
        """Returns a plain dictionary."""
        return dict(self)

    def to_pandas(self) -> Any:
        """Makes a table of pandas with the rows and columns of the program's CSV, and their units in `attrs`; pandas has
        to be installed.

        Results from a pickle are computed again for it.

        Raises
        ------
        InputError
            The results have no table in the program.
        """
        return _show.table(self)

    def to_latex(self) -> str:
        """Returns the rounded table of the results for LaTeX, with the rules of booktabs and the numbers of siunitx.

        Raises
        ------
        InputError
            The results have no table in the program.
        """
        return self._reading_table(latex=True)

    def to_markdown(self) -> str:
        """Returns the rounded table of the results for Markdown.

        Raises
        ------
        InputError
            The results have no table in the program.
        """
        return self._reading_table(latex=False)

    def _reading_table(self, *, latex: bool) -> str:
        if self._answered is None:
            raise InputError(f"the results of {self.get('command', 'this command')} have no table: read their keys")
        return self._answered.reading_table(latex)

    def to_xarray(self) -> Any:
        """Makes a dataset of xarray with every number of the results, and units as attributes; xarray has to be installed.

        Rows over time have the dimension `time`, those of all cables `cable`, and vectors `axis`, each with its labels.
        Responses have the dimension `frequency_hz`, several of them `response` too. Other lists of rows, such as `history`
        of `settle`, have a dimension of their own name. Complex numbers are two variables that end in `real` and `imag`,
        because NetCDF has no complex numbers. A value that a row does not have is NaN. Single values are attributes.
        Values that fit into no array, such as lists of different lengths, are left out, and a `UserWarning` names them.

        Raises
        ------
        InputError
            The results hold no rows.
        """
        return _show.dataset(self)


Kind = TypeVar("Kind", bound=Results)

# Class of the results of each command: `funicular.results`, whose classes are made of those here, fills it.
OF_COMMANDS: dict[str, type[Results]] = {}


def results(found: dict[str, Any]) -> Any:
    """Results with arrays in place of lists of numbers, of the class of their command."""
    return with_arrays(found, kind_of(found))


def kind_of(found: Mapping[str, Any]) -> type[Results]:
    """Class of the results of a command."""
    return OF_COMMANDS.get(found.get("command", ""), Results)


def of_answered(kind: type[Kind], answered: Answered) -> Kind:
    """Results with arrays, which the compiled half holds with their request: their table follows from it."""
    found: Kind = with_arrays(json.loads(answered.json()), kind)
    found._answered = answered
    return found


def of_stopped(answered: Answered) -> Results:
    """Results of work that was stopped, of the class of their command."""
    return of_answered(kind_of(json.loads(answered.json())), answered)


def _are_numbers(values: list[Any]) -> bool:
    """True for numbers, and for rows of numbers of one length."""
    if all(isinstance(value, list) for value in values):
        return len({len(value) for value in values}) == 1 and all(value and _are_numbers(value) for value in values)
    return all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values)


class ArrayFields:
    """Base of dataclasses with arrays, which are read only: equal results have arrays with equal elements."""

    def __post_init__(self) -> None:
        for value in vars(self).values():
            _lock(value)

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Copies and pickles come here; a pickle of an array does not say that it was read only.
        vars(self).update(state)
        ArrayFields.__post_init__(self)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            _same(getattr(self, field.name), getattr(other, field.name))
            for field in dataclasses.fields(self)  # type: ignore[arg-type]
            if field.compare
        )

    __hash__ = None  # type: ignore[assignment]


def _lock(value: Any) -> None:
    """Makes arrays read only, also those in tuples."""
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, tuple):
        for item in value:
            _lock(item)


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return False
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(value, b[key]) for key, value in a.items())
    if isinstance(a, (list, tuple)) and type(a) is type(b):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModeGradients(ArrayFields):
    """Derivatives of natural modes by numbers of the robot file, made by `Modes.gradient`."""

    paths: tuple[str, ...]
    """Paths of the numbers."""
    units: tuple[str, ...]
    """Units of the numbers, those of the robot file."""
    values: NDArray[np.float64]
    """Values of the numbers."""
    tolerances: NDArray[np.float64]
    """Tolerances of the numbers."""
    frequency_hz: NDArray[np.float64]
    """Derivatives of the natural frequencies [Hz per step], (modes, numbers); NaN for modes that share a frequency."""
    damping_ratio: NDArray[np.float64] | None
    """Derivatives of the damping ratios [1 per step], (modes, numbers); None for modes with `damped=False`."""
    blocks: tuple[tuple[tuple[int, ...], NDArray[np.float64]], ...]
    """Modes that share a frequency: their indices, and their block (modes, modes, numbers) [Hz per step].

    Along a change of the numbers the derivatives of their frequencies are the eigenvalues of the block."""
    per: str
    """Step: `unit`, `percent` or `tolerance`."""
    held_means: str
    """Sentence that says what is held."""
    found: dict[str, Any]
    """Results with the keys of the program's JSON."""

    def __repr__(self) -> str:
        return f"<ModeGradients of {len(self.frequency_hz)} modes by {len(self.paths)} numbers, per {self.per}>"

    def to_dict(self) -> dict[str, Any]:
        """Returns a dictionary with the keys of the program's JSON."""
        return copy.deepcopy(self.found)


def _mode_gradients(found: dict[str, Any], count: int) -> ModeGradients:
    """Makes `ModeGradients` of `count` modes from the results of `gradient`."""
    numbers = found["parameters"]
    frequency = np.full((count, len(numbers)), np.nan)
    damping = np.full((count, len(numbers)), np.nan)
    has_damping = False
    blocks: dict[tuple[int, ...], NDArray[np.float64]] = {}
    for result in found["results"]:
        measure, derivatives = result["measure"], result["derivatives"]
        match measure["kind"]:
            case "shared-frequency":
                first, last = measure["modes"]
                modes = tuple(range(first - 1, last))
                block = blocks.setdefault(modes, np.zeros((len(modes), len(modes), len(numbers))))
                i, j = (number - first for number in measure["entry"])
                block[i, j] = block[j, i] = derivatives
            case "frequency":
                frequency[measure["mode"] - 1] = derivatives
            case "damping":
                has_damping = True
                damping[measure["mode"] - 1] = derivatives
    return ModeGradients(
        paths=tuple(number["path"] for number in numbers),
        units=tuple(number["unit"] for number in numbers),
        values=np.array([number["value"] for number in numbers]),
        tolerances=np.array([number["tolerance"] for number in numbers]),
        frequency_hz=frequency,
        damping_ratio=damping if has_damping else None,
        blocks=tuple(blocks.items()),
        per=found["per"],
        held_means=found["held_means"],
        found=found,
    )


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Modes(ArrayFields):
    """Natural modes below a limit; arrays have one row per mode, ascending in frequency."""

    frequency_hz: NDArray[np.float64]
    """Undamped natural frequency [Hz]; a multiple frequency stands once per mode."""
    multiplicity: NDArray[np.int64]
    """Number of modes that share the frequency."""
    damping_ratio: NDArray[np.float64]
    """Damping ratio ζ of the damped partner; with `damped=False` to first order in the damping."""
    decay_time_s: NDArray[np.float64]
    """Time in which the amplitude falls to `decay_percent` [s]; NaN for a mode that does not decay."""
    eigenvalue_per_s: NDArray[np.complex128] | None
    """λ = −ζω + iω√(1 − ζ²) of the damped partner [1/s]; None with `damped=False`."""
    kind: NDArray[np.str_]
    """Vibration of the `platform`, of a `cable`, of a `drive`, or `mixed`, by kinetic energy."""
    platform_energy_fraction: NDArray[np.float64]
    """Kinetic energy of the platform over that of the robot."""
    cable_energy_fractions: NDArray[np.float64]
    """Kinetic energy of each cable over that of the robot, (modes, cables)."""
    drive_energy_fractions: NDArray[np.float64]
    """Kinetic energy of the drive of each cable over that of the robot, (modes, cables); zero without inertia."""
    support_energy_fractions: NDArray[np.float64]
    """Kinetic energy of each flexible support over that of the robot, (modes, supports)."""
    stretching_share: NDArray[np.float64] | None
    """Share of the stretch of each cable in the energy of deformation, (modes, cables).

    A loss factor η of the rope adds η/2 times it to the damping ratio. None for shallow-dynamic cables without loss of
    their stretch, and for rigid ones."""
    shape: NDArray[np.float64]
    """Motion of the platform, translation and rotation about its origin, world axes, (modes, 6).

    Its maximum component is 1, with rotations times the platform's length. Zero if the platform does not move."""
    modal_mass_kg: NDArray[np.float64]
    """Modal mass in the scale of `shape` [kg]."""
    residual: NDArray[np.float64]
    """Twice the relative change of the frequency in one more step of its search."""
    below_hz: float
    """Limit of the frequencies [Hz]."""
    count_below: int
    """Number of modes below the limit, by the Wittrick–Williams count."""
    certified: bool
    """True if the list has as many modes as the count and every mode is accurate."""
    unstable_directions: int
    """Number of directions in which the equilibrium is unstable; they have no frequency, but are in the count."""
    decay_percent: float | None
    """Percentage of the amplitude in `decay_time_s`; None with rigid cables."""
    platform_share: float
    """Minimum fraction of the kinetic energy in the platform for `first_platform_index`."""
    first_platform_index: int | None
    """Index of the first mode of the platform; None if none lies below the limit."""
    damped_certified: bool | None
    """True if every mode has its damped partner, by a count; None with `damped=False`."""
    cable_names: tuple[str, ...]
    """Names of the cables, in the order of the file."""
    support_names: tuple[str, ...]
    """Names of the flexible supports; empty on a rigid frame."""
    robot: str
    """Name of the robot."""
    static_model: str
    """How cables carry their static load."""
    cable_model: str
    """How cables answer motion of the platform."""
    assembly: str
    """Terms of the stiffness."""
    in_plane_only: bool
    """True if the stiffness of cables out of their planes is left out."""
    input: str | None
    """Input signal of the response in which the modes take part; None if none was given."""
    output: str | None
    """Output signal of that response; None if none was given."""
    residue_per_kg: NDArray[np.float64] | None
    """Residue of every mode in that response [1/kg]."""
    peak: NDArray[np.float64] | None
    """Height of the peak of every mode, in `peak_unit`; NaN for a mode without damping."""
    peak_unit: str | None
    """Unit of `peak`."""
    station_arc_length_m: NDArray[np.float64] | None
    """Unstrained arc lengths of the stations [m], (cables, stations); None without `stations`."""
    station_position_m: NDArray[np.float64] | None
    """Positions of the stations at the equilibrium, world axes [m], (cables, stations, 3)."""
    cable_axes: NDArray[np.float64] | None
    """Unit vectors along the chord, in plane and out of plane of every cable, world axes, (cables, 3, 3)."""
    cable_shapes: NDArray[np.float64] | None
    """Displacements of the stations along `cable_axes` in the scale of `shape`, (modes, cables, stations, 3)."""
    warnings: tuple[str, ...]
    """Caveats of the result."""
    found: dict[str, Any]
    """Results with the keys of the program's JSON."""
    _request: str | None = None

    def gradient(
        self,
        by: str | Sequence[str] | None = None,
        *,
        hold: str = "lengths",
        per: str = "unit",
        tolerances: Mapping[str, object] | Sequence[str] | None = None,
    ) -> ModeGradients:
        """Derivatives of the frequencies and of the damping ratios by numbers of the robot file.

        Parameters
        ----------
        by
            Paths of the numbers, as `Robot.parameters` lists them; `*` stands for any key, and a path to a table or vector
            for all numbers in it. All numbers if not given.
        hold
            Held while a number changes: the unstrained `lengths`, so that the pose follows, or the `pose`.
        per
            Unit of the derivatives: `unit` of the number, `percent` of its value, or its `tolerance`.
        tolerances
            Tolerances: a mapping from paths to values or percentages, or texts such as `platform.mass_kg=1%`.

        Raises
        ------
        InputError
            Modes without gradients (rigid cables, cable models, terms, drives), or a path that no number has.
        NoSolutionError
            A cable is slack, or the equilibrium indifferent: it has no derivatives.
        """
        if self._request is None:
            raise InputError("these modes have no gradients: their cables are rigid, or they were not made by `modes`")
        request = json.loads(self._request)
        request["of"] = ["frequencies"] if self.damped_certified is None else ["frequencies", "damping"]
        given = {"by": by, "hold": hold, "per": per, "tolerances": tolerances}
        request |= {key: read("gradient", key, value) for key, value in given.items() if value is not None}
        return _mode_gradients(json.loads(answer(json.dumps(request))), len(self))

    def __len__(self) -> int:
        return len(self.frequency_hz)

    def __repr__(self) -> str:
        listed = f"{len(self)} mode{'' if len(self) == 1 else 's'}"
        return f"<Modes: {listed} below {self.below_hz:g} Hz, {'' if self.certified else 'NOT '}certified>"

    def _repr_html_(self) -> str:
        return _show.html(self)

    def to_dict(self) -> dict[str, Any]:
        """Returns a dictionary with the keys of the program's JSON."""
        return copy.deepcopy(self.found)

    def to_pandas(self) -> Any:
        """Makes a table of pandas with one row per mode; pandas has to be installed."""
        return _show.table(self)

    def to_xarray(self) -> Any:
        """Makes a dataset of xarray with the dimensions `mode`, `cable`, `motion` and, with `stations`, `station`.

        Units are attributes. NetCDF has no complex numbers, so `eigenvalue_per_s` becomes two variables. xarray has to
        be installed.
        """
        return _show.dataset(self)


def _drive_energies(rows: list[dict[str, Any]], cables: int) -> NDArray[np.float64]:
    """Energy fractions of the drives, zero where no drive has inertia."""
    none = [0.0] * cables
    energies = [row.get("drive_energy_fractions", none) for row in rows]
    return np.array(energies, dtype=float).reshape(len(rows), cables)


def _support_energies(rows: list[dict[str, Any]], supports: int) -> NDArray[np.float64]:
    """Energy fractions of the flexible supports."""
    energies = [row.get("support_energy_fractions", [0.0] * supports) for row in rows]
    return np.array(energies, dtype=float).reshape(len(rows), supports)


def modes(found: dict[str, Any], request: str | None = None) -> Modes:
    """Makes `Modes` from the results of the program; `request` is that of their derivatives, in JSON."""
    rows, stations = found["modes"], found.get("stations")
    cables = found["cable_names"]

    def column(key: str) -> NDArray[np.float64]:
        return np.array([row.get(key, np.nan) for row in rows], dtype=float)

    def table(key: str, width: int) -> NDArray[np.float64]:
        return np.array([row[key] for row in rows], dtype=float).reshape(len(rows), width)

    def of_stations(key: str) -> NDArray[np.float64] | None:
        return np.array([of[key] for of in stations], dtype=float) if stations else None

    eigenvalues, shapes, axes = None, None, None
    if "damped_certified" in found:
        pairs = table("eigenvalue_per_s", 2)
        eigenvalues = np.empty(len(rows), dtype=complex)
        eigenvalues.real, eigenvalues.imag = pairs[:, 0], pairs[:, 1]
    if stations:
        count = len(stations[0]["arc_length_m"])
        shapes = np.array([row["cable_shapes"] for row in rows], dtype=float).reshape(len(rows), len(cables), count, 3)
        axes = np.array([[of["axes"][axis] for axis in "enb"] for of in stations], dtype=float)
    takes_part = "peak_unit" in found
    return Modes(
        frequency_hz=column("frequency_hz"),
        multiplicity=np.array([row["multiplicity"] for row in rows], dtype=np.int64),
        damping_ratio=column("damping_ratio"),
        decay_time_s=column("decay_time_s"),
        eigenvalue_per_s=eigenvalues,
        kind=np.array([row["kind"] for row in rows], dtype="U8"),
        platform_energy_fraction=column("platform_energy_fraction"),
        cable_energy_fractions=table("cable_energy_fractions", len(cables)),
        drive_energy_fractions=_drive_energies(rows, len(cables)),
        support_energy_fractions=_support_energies(rows, len(found.get("support_names", []))),
        stretching_share=table("stretching_share", len(cables)) if rows and "stretching_share" in rows[0] else None,
        shape=table("shape", 6),
        modal_mass_kg=column("modal_mass_kg"),
        residual=column("residual"),
        decay_percent=found.get("decay_percent"),
        first_platform_index=found.get("first_platform_mode", {}).get("index"),
        damped_certified=found.get("damped_certified"),
        cable_names=tuple(cables),
        support_names=tuple(found.get("support_names", [])),
        input=found.get("input"),
        output=found.get("output"),
        residue_per_kg=column("residue_per_kg") if takes_part else None,
        peak=column("peak") if takes_part else None,
        peak_unit=found.get("peak_unit"),
        station_arc_length_m=of_stations("arc_length_m"),
        station_position_m=of_stations("position_m"),
        cable_axes=axes,
        cable_shapes=shapes,
        warnings=tuple(found["warnings"]),
        found=found,
        _request=request,
        **{key: found[key] for key in _COMMON_KEYS},
    )


# Keys of the results that become attributes of `Modes` without conversion.
_COMMON_KEYS = (
    *("below_hz", "count_below", "certified", "unstable_directions", "platform_share"),
    *("robot", "static_model", "cable_model", "assembly", "in_plane_only"),
)


_Matrices = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


def _to_scipy(matrices: _Matrices) -> Any:
    try:
        from scipy import signal
    except ImportError as error:
        raise needs("this model", "scipy") from error
    return signal.StateSpace(*matrices)


def _to_control(matrices: _Matrices, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Any:
    try:
        import control
    except ImportError as error:
        raise needs("this model", "control") from error
    return control.StateSpace(*matrices, inputs=list(inputs), outputs=list(outputs))


def _save(
    path: str | PathLike[str],
    matrices: dict[str, NDArray[np.float64]],
    inputs: tuple[str, ...],
    outputs: tuple[str, ...],
    found: dict[str, Any],
) -> None:
    """Writes matrices, names of inputs and outputs, and the description in the format of the ending."""
    ending = Path(path).suffix.lower()
    texts = {"inputs": list(inputs), "outputs": list(outputs), "description": [json.dumps(found)]}
    if ending == ".npz":
        np.savez(path, **matrices, **{name: np.array(column) for name, column in texts.items()})  # type: ignore[arg-type]
    elif ending == ".mat":
        columns = [(name, len(matrix), matrix.T.ravel().tolist()) for name, matrix in matrices.items()]
        Path(path).write_bytes(matlab_file(columns, list(texts.items())))
    else:
        raise InputError(f"`path` is {path}: it must end in .npz or .mat, that of a state space also in .fmu")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StateSpaceModel(ArrayFields):
    """State space x' = A x + B u, y = C x + D u of the modes that inputs and outputs see.

    Made by `Equilibrium.state_space`. Rows of `states`, and the arrays with one entry per mode, ascend in frequency."""

    A: NDArray[np.float64]
    """A, (n, n), one block [[0, ω], [−ω, −2ζω]] per mode."""
    B: NDArray[np.float64]
    """B, (n, inputs)."""
    C: NDArray[np.float64]
    """C, (outputs, n)."""
    D: NDArray[np.float64]
    """D, (outputs, inputs): the displacement by modes left out, and the direct part of an acceleration."""
    inputs: tuple[str, ...]
    """Names of the inputs."""
    outputs: tuple[str, ...]
    """Names of the outputs."""
    order: int
    """Number of states n."""
    below_hz: float
    """Highest frequency for which the model is made [Hz]."""
    error: float
    """Maximum of |G_r − G| up to the limit relative to the peak of |G|, over all responses; G is that of `frf`."""
    damping_error: float
    """Part of the error that is left with every mode, because no state space has constant damping ratios."""
    errors: NDArray[np.float64]
    """Error of each response relative to its peak, (outputs, inputs)."""
    peaks: NDArray[np.float64]
    """Maximum of |G| of each response up to the limit, (outputs, inputs)."""
    frequency_hz: NDArray[np.float64]
    """Natural frequency of each mode [Hz]."""
    damping_ratio: NDArray[np.float64]
    """Damping ratio of each mode."""
    kind: NDArray[np.str_]
    """`platform`, `cable` or `mixed`, by kinetic energy; `residual` for a motion in place of modes above the limit."""
    first: NDArray[np.int64]
    """Index of the first state of each mode."""
    contribution: NDArray[np.float64]
    """Maximum part of each mode in a response, relative to the peak of the response."""
    found: dict[str, Any]
    """Results with the keys of the program's JSON."""
    robot_file: str
    """Robot file (TOML) of the model."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Caveats of the model."""
        return tuple(self.found["warnings"])

    def to_scipy(self) -> Any:
        """Makes a `scipy.signal.StateSpace`; SciPy has to be installed."""
        return _to_scipy((self.A, self.B, self.C, self.D))

    def to_control(self) -> Any:
        """Makes a `control.StateSpace` with named inputs and outputs; python-control has to be installed."""
        return _to_control((self.A, self.B, self.C, self.D), self.inputs, self.outputs)

    def save(self, path: str | PathLike[str]) -> None:
        """Writes A, B, C, D: to a file `.npz` for NumPy, or `.mat` for MATLAB, or as a Functional Mock-up Unit `.fmu`.

        The unit is that of the program's `reduce --to fmu`: with C source, and compiled where a C compiler is.

        Warns
        -----
        UserWarning
            The unit has no library, because it was not compiled, or a name in it is not that of the model.
        """
        if Path(path).suffix.lower() == ".fmu":
            self._save_unit(Path(path))
            return
        _save(path, {"A": self.A, "B": self.B, "C": self.C, "D": self.D}, self.inputs, self.outputs, self.found)

    def _save_unit(self, path: Path) -> None:
        signals = [[(of["name"], of["unit"]) for of in self.found[key]] for key in ("inputs", "outputs")]
        matrices = [(len(matrix), matrix.T.ravel().tolist()) for matrix in (self.A, self.B, self.C, self.D)]
        limits = (self.below_hz, self.error)
        for caveat in write_unit(path, limits, signals, matrices, self.robot_file, json.dumps(self.found)):
            warnings.warn(caveat, stacklevel=3)

    def to_dict(self) -> dict[str, Any]:
        """Returns a dictionary with the keys of the program's JSON."""
        return copy.deepcopy(self.found)

    def __repr__(self) -> str:
        size = f"{self.order} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<StateSpaceModel: {size}, below {self.below_hz:g} Hz, error {self.error:.2g} of the peaks>"


def state_space(found: dict[str, Any], matrices: dict[str, NDArray[np.float64]], robot_file: str) -> StateSpaceModel:
    """Makes a state space from the results of the program and its matrices."""
    modes, responses = found["states"], found["responses"]
    shape = (len(found["inputs"]), len(found["outputs"]))

    def of_responses(key: str) -> NDArray[np.float64]:
        return np.array([row[key] for row in responses], dtype=float).reshape(shape).T.copy()

    def of_modes(key: str) -> NDArray[np.float64]:
        return np.array([row[key] for row in modes], dtype=float)

    return StateSpaceModel(
        inputs=tuple(of["name"] for of in found["inputs"]),
        outputs=tuple(of["name"] for of in found["outputs"]),
        order=found["order"],
        below_hz=found["below_hz"],
        error=found["error"],
        damping_error=found["damping_error"],
        errors=of_responses("error"),
        peaks=of_responses("peak"),
        frequency_hz=of_modes("frequency_hz"),
        damping_ratio=of_modes("damping_ratio"),
        kind=np.array([row["kind"] for row in modes], dtype="U8"),
        first=np.array([row["first"] for row in modes], dtype=np.int64),
        contribution=of_modes("contribution"),
        found=found,
        robot_file=robot_file,
        **matrices,
    )


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ReducedModel(ArrayFields):
    """Second-order model M x'' + C x' + K x = B f, y = L x, and its state space; made by `Equilibrium.reduce`.

    Signals of drives may act by their rates: M x'' + C x' + K x = B f + B₁ f' + B₂ f'' and
    y = L x + L₁ x' + L₂ x'' + D₀ f + D₁ f' + D₂ f''."""

    mass: NDArray[np.float64]
    """M, (n, n)."""
    damping: NDArray[np.float64]
    """C, (n, n)."""
    stiffness: NDArray[np.float64]
    """K, (n, n)."""
    input: NDArray[np.float64]
    """B, (n, inputs)."""
    output: NDArray[np.float64]
    """L, (outputs, n): displacements, rotations and tensions, also for outputs that measure velocities or
    accelerations."""
    input_rates: NDArray[np.float64]
    """B₁ and B₂, (2, n, inputs); zero except for commanded lengths."""
    output_rates: NDArray[np.float64]
    """L₁ and L₂, (2, outputs, n); zero except for tensions."""
    feedthrough: NDArray[np.float64]
    """D₀, D₁ and D₂, (3, outputs, inputs); zero except for signals of the drive of one cable."""
    a: NDArray[np.float64] | None
    """A of the state space x' = A x + B f, y = C x + D f, whose state is motion and velocity. None if an output
    contains the rate of an input, which no state space has; `warnings` then says which."""
    b: NDArray[np.float64] | None
    """B of the state space, or None."""
    c: NDArray[np.float64] | None
    """C of the state space, or None."""
    d: NDArray[np.float64] | None
    """D of the state space, or None."""
    inputs: tuple[str, ...]
    """Names of the inputs."""
    outputs: tuple[str, ...]
    """Names of the outputs."""
    below_hz: float
    """Highest frequency for which the model is made [Hz]."""
    frequency_error: float
    """Maximum relative error of a natural frequency below the limit."""
    truncation_error: float | None
    """Maximum relative error of the responses by modes left out; None for an undamped robot."""
    damping_error: float | None
    """Maximum relative error of the responses by viscous damping; None for an undamped robot."""
    found: dict[str, Any]
    """Description with the keys of the program's JSON: units, coordinates, models."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Caveats of the model."""
        return tuple(self.found["warnings"])

    def state_space(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Returns A, B, C, D of x' = A x + B f, y = C x + D f.

        Raises ValueError if there is no state space: an output contains the rate of an input."""
        if self.a is None or self.b is None or self.c is None or self.d is None:
            raise ValueError("; ".join(self.warnings))
        return self.a, self.b, self.c, self.d

    def to_scipy(self) -> Any:
        """Makes a `scipy.signal.StateSpace`; SciPy has to be installed."""
        return _to_scipy(self.state_space())

    def to_control(self) -> Any:
        """Makes a `control.StateSpace` with named inputs and outputs; python-control has to be installed."""
        return _to_control(self.state_space(), self.inputs, self.outputs)

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the matrices with the names of the program's `--matrices`: `.npz` for NumPy, `.mat` for MATLAB."""
        matrices = {"M": self.mass, "C": self.damping, "K": self.stiffness, "B": self.input, "L": self.output}
        of_drives = zip(
            ("B1", "B2", "L1", "L2", "D0", "D1", "D2"),
            (*self.input_rates, *self.output_rates, *self.feedthrough),
            strict=True,
        )
        matrices |= {name: matrix for name, matrix in of_drives if matrix.any()}
        if self.a is not None:
            matrices |= dict(zip(("ss_A", "ss_B", "ss_C", "ss_D"), self.state_space(), strict=True))
        _save(path, matrices, self.inputs, self.outputs, self.found)

    def to_dict(self) -> dict[str, Any]:
        """Returns the description with the keys of the program's JSON."""
        return copy.deepcopy(self.found)

    def __repr__(self) -> str:
        size = f"{len(self.mass)} coordinates, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<ReducedModel: {size}, below {self.below_hz:g} Hz>"


def reduced(found: dict[str, Any], matrices: dict[str, Any]) -> ReducedModel:
    """Makes a model from its description and its matrices."""
    for several in ("input_rates", "output_rates", "feedthrough"):
        matrices[several] = np.stack(matrices[several])
    return ReducedModel(
        inputs=tuple(of["name"] for of in found["inputs"]),
        outputs=tuple(of["name"] for of in found["outputs"]),
        below_hz=found["below_hz"],
        frequency_error=found["frequency_error"],
        truncation_error=found.get("truncation_error"),
        damping_error=found.get("damping_error"),
        found=found,
        **matrices,
    )


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Equilibria(ArrayFields):
    """Equilibria of many states; arrays have one row per state, NaN where there is no equilibrium."""

    status: NDArray[np.str_]
    """`ok`, or the code of the reason as in `StaticsError.code`, or `input` for numbers that are no state."""
    reason: tuple[str, ...]
    """Reason why there is no equilibrium; empty where there is one."""
    position_m: NDArray[np.float64]
    """Origin of the platform frame [m], (states, 3)."""
    quaternion_wxyz: NDArray[np.float64]
    """Orientation as w, x, y, z with w ≥ 0, (states, 4)."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll), (states, 3)."""
    unstrained_length_m: NDArray[np.float64]
    """Unstrained lengths [m], (states, cables)."""
    tension_platform_n: NDArray[np.float64]
    """Tensions at the platform ends [N], (states, cables)."""
    tension_anchor_n: NDArray[np.float64]
    """Tensions at the anchor ends [N], (states, cables)."""
    sag_ratio: NDArray[np.float64]
    """Sags over chords, (states, cables); NaN for a cable without tension."""
    residual: NDArray[np.float64]
    """Unbalanced wrench on the platform relative to the sum of all forces."""
    stable: NDArray[np.bool_] | None
    """True if every small motion is opposed, False where there is no equilibrium; None for ideal cables, which are rigid."""
    stiffness_min_n_per_m: NDArray[np.float64]
    """Minimum eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; NaN for ideal cables."""
    nearest_pose_distance_m: NDArray[np.float64]
    """Distance from the requested pose [m] with fewer cables than degrees of freedom; else NaN."""
    static_model: str
    """How cables carry their static load."""

    @property
    def ok(self) -> NDArray[np.bool_]:
        """True for states that have an equilibrium."""
        return np.asarray(self.status == "ok")

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        return f"<Equilibria: {int(self.ok.sum())} of {len(self)} states, {self.static_model} cables>"

    def _repr_html_(self) -> str:
        return _show.html(self)

    def to_dict(self) -> dict[str, Any]:
        """Returns a dictionary of the arrays by their names."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def to_pandas(self) -> Any:
        """Makes a table of pandas with one row per state; pandas has to be installed."""
        return _show.table(self)
