"""Design: values of a robot file with which the robot is best at several poses."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from funicular._funicular import Answered, Robot
from funicular._pages import Answer


@dataclass(frozen=True, repr=False, eq=False)
class Designed(Answer):
    """Values chosen by `Robot.design`, in the manner of `scipy.optimize`."""

    names: tuple[str, ...]
    """Paths of the values in the robot file."""
    x: NDArray[np.float64]
    """Chosen values, in the units of the file."""
    start: NDArray[np.float64]
    """Values of the file."""
    bounds: NDArray[np.float64]
    """Minimum and maximum of each value, one row per value."""
    gains: NDArray[np.float64]
    """Improvement of `fun` per unit by which the bound of a value moves outwards; zero between the bounds."""
    fun: float
    """Value of the goal; its unit is `unit`."""
    fun_before: float
    """Value of the goal with the values of the file."""
    unit: str
    """Unit of the goal."""
    poses: NDArray[np.float64]
    """Poses, one row each: x, y, z [m], roll, pitch, yaw [degrees]."""
    before: NDArray[np.float64]
    """Value of the goal at every pose with the values of the file."""
    after: NDArray[np.float64]
    """Value of the goal at every pose with the chosen values."""
    shares: NDArray[np.float64]
    """Gain of the goal if a pose alone gains one; zero for poses that do not limit it."""
    message: str
    """Reason for the end of the search."""
    success: bool
    """True if no further step improves the goal."""
    nit: int
    """Number of iterations."""
    nfev: int
    """Number of robots that were computed at all poses."""
    warnings: tuple[str, ...]
    """Caveats."""
    details: dict[str, Any]
    """All keys of the program's JSON: `values`, `poses`, `demands`, `limits`, `history`, …"""
    _answered: Answered = field(compare=False)
    """Request and results in the compiled half, for `page` and `to_pandas`."""

    @property
    def limits(self) -> tuple[str, ...]:
        """Sentences on what limits the result: poses, demands, and the gain of more room at bounds."""
        return tuple(self.details["limits"])

    @property
    def robot_file(self) -> str:
        """Text of the robot file with the values."""
        text: str = self.details["robot_file"]
        return text

    @property
    def robot(self) -> Robot:
        """Robot with the values."""
        return Robot.from_toml(self.robot_file)

    def __repr__(self) -> str:
        goal = f"{self.details['goal_means']} {self.fun_before:.5g} → {self.fun:.5g} {self.unit}"
        return f"<Designed: {goal}; {len(self.x)} values, {self.nit} iterations>"


def designed(request: Mapping[str, Any]) -> Designed:
    """Runs a request of `design`."""
    answered = Answered(json.dumps(request))
    found = json.loads(answered.json())
    rows, poses = found["values"], found["poses"]

    def of(key: str, table: list[dict[str, Any]]) -> NDArray[np.float64]:
        return np.array([row[key] for row in table], float)

    return Designed(
        names=tuple(row["path"] for row in rows),
        x=of("value", rows),
        start=of("start", rows),
        bounds=np.column_stack([of("minimum", rows), of("maximum", rows)]),
        gains=of("gain_per_unit", rows),
        fun=found["after"],
        fun_before=found["before"],
        unit=found["unit"],
        poses=np.array([[*row["position_m"], *row["roll_pitch_yaw_deg"]] for row in poses], float),
        before=of("before", poses),
        after=of("after", poses),
        shares=of("share", poses),
        message=found["ending"],
        success=found["converged"],
        nit=found["iterations"],
        nfev=found["evaluations"],
        warnings=tuple(found["warnings"]),
        details=found,
        _answered=answered,
    )
