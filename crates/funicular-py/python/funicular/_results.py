"""Results that are columns: plain NumPy arrays with one row a mode or a state."""

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


class _Columns:
    """Equality of arrays, where a dataclass would compare their elements."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            _same(getattr(self, field.name), getattr(other, field.name))
            for field in dataclasses.fields(self)  # type: ignore[arg-type]
        )

    __hash__ = None  # type: ignore[assignment]


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    return bool(a == b)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Modes(_Columns):
    """Natural modes below a limit; arrays have one row a mode, ascending in frequency."""

    frequency_hz: NDArray[np.float64]
    """Natural frequency, undamped [Hz]; as often as its multiplicity says."""
    multiplicity: NDArray[np.int64]
    """How many modes share the frequency."""
    damping_ratio: NDArray[np.float64]
    """Of the damped partner; to first order in the damping where `damped=False` was asked for."""
    eigenvalue_per_s: NDArray[np.complex128] | None
    """λ = −ζω + iω√(1 − ζ²) of the damped partner; None where `damped=False` was asked for."""
    kind: NDArray[np.str_]
    """Whose vibration it is, by kinetic energy: platform, cable or mixed."""
    platform_energy_fraction: NDArray[np.float64]
    """Kinetic energy of the platform over that of the robot."""
    cable_energy_fractions: NDArray[np.float64]
    """Kinetic energy of each cable over that of the robot, (modes, cables)."""
    shape: NDArray[np.float64]
    """Motion of the platform, translation and rotation about its origin, world axes, (modes, 6); its largest component is
    1, rotations times the platform's length. Zero if the platform is at rest."""
    modal_mass_kg: NDArray[np.float64]
    """Mass that moves with `shape`."""
    residual: NDArray[np.float64]
    """Twice the relative change of the frequency that another step of its search would make."""
    below_hz: float
    """The limit [Hz]."""
    count_below: int
    """How many there are, by the Wittrick–Williams count."""
    certified: bool
    """The list has as many modes as the count, and every one is accurate."""
    unstable_directions: int
    """Directions without a frequency, in which the equilibrium is unstable; they are in the count."""
    damped_certified: bool | None
    """Whether every mode has its damped partner, counted; None where `damped=False` was asked for."""
    cable_names: tuple[str, ...]
    robot: str
    static_model: str
    cable_model: str
    assembly: str
    in_plane_only: bool
    warnings: tuple[str, ...]
    """What to know before trusting the result."""

    def __len__(self) -> int:
        return len(self.frequency_hz)

    def __repr__(self) -> str:
        listed = f"{len(self)} mode{'' if len(self) == 1 else 's'}"
        return f"<Modes: {listed} below {self.below_hz:g} Hz, {'' if self.certified else 'NOT '}certified>"

    def _repr_html_(self) -> str:
        from funicular import _html

        return _html.modes(self)

    def to_dict(self) -> dict[str, Any]:
        """The result with the keys of the program's JSON."""
        from funicular import _tables

        return _tables.modes(self)

    def to_pandas(self) -> Any:
        """One row a mode, as a table of pandas, which has to be installed."""
        from funicular import _tables

        return _tables.modes_table(self)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Equilibria(_Columns):
    """Equilibria of many states; arrays have one row a state, NaN where there is no equilibrium."""

    status: NDArray[np.str_]
    """`ok`, or the code of the reason, as `StaticsError.code`; `input` for numbers that are no state."""
    reason: tuple[str, ...]
    """Why there is no equilibrium; empty where there is one."""
    position_m: NDArray[np.float64]
    """Origin of the platform frame [m], (states, 3)."""
    quaternion_wxyz: NDArray[np.float64]
    roll_pitch_yaw_deg: NDArray[np.float64]
    lengths: NDArray[np.float64]
    """Unstrained lengths [m], (states, cables)."""
    tensions: NDArray[np.float64]
    """Tensions at the platform [N], (states, cables)."""
    anchor_tensions: NDArray[np.float64]
    """Tensions at the anchors [N], (states, cables)."""
    sag_ratio: NDArray[np.float64]
    """Sags over chords, (states, cables); NaN for a cable without tension."""
    residual: NDArray[np.float64]
    """What is left of the wrench on the platform, over the sum of all forces."""
    stable: NDArray[np.bool_]
    """Whether every small motion is opposed; false for ideal cables, which are rigid."""
    least_stiffness_n_per_m: NDArray[np.float64]
    """Least eigenvalue of the scaled static stiffness, in wind of its symmetric part [N/m]; NaN for ideal cables."""
    nearest_pose_distance_m: NDArray[np.float64]
    """Distance from the pose asked [m] where fewer cables than freedoms hold only the nearest; else NaN."""
    model: str

    @property
    def ok(self) -> NDArray[np.bool_]:
        """Which states have an equilibrium."""
        return np.asarray(self.status == "ok")

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        return f"<Equilibria: {int(self.ok.sum())} of {len(self)} states, {self.model} cables>"

    def _repr_html_(self) -> str:
        from funicular import _html

        return _html.equilibria(self)

    def to_dict(self) -> dict[str, Any]:
        """Its arrays by their names."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def to_pandas(self) -> Any:
        """One row a state, as a table of pandas, which has to be installed."""
        from funicular import _tables

        return _tables.equilibria_table(self)
