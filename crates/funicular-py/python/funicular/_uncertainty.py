"""Uncertainty: deviations of results from deviations of numbers of the robot file."""

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from funicular._funicular import Answered
from funicular._pages import Answer


@dataclass(frozen=True, repr=False, eq=False)
class Uncertainty(Answer):
    """Results with their deviations. Arrays have one entry per result; with several poses one row per pose."""

    names: tuple[str, ...]
    """Names of the results."""
    units: tuple[str, ...]
    """Units of the results."""
    value: NDArray[np.float64]
    """Values of the undisturbed robot; NaN where a pose lacks the result."""
    deviation: NDArray[np.float64]
    """Standard deviations."""
    interval_95: NDArray[np.float64]
    """Intervals that hold 95 % of all robots, (…, 2)."""
    is_sampled: NDArray[np.bool_]
    """True for results from sampled robots, false for linear ones."""
    group_names: tuple[str, ...]
    """Names of the groups of numbers."""
    group_shares: NDArray[np.float64]
    """Shares of the groups in the variances, (…, groups); total shares of sampled results may add up to more than 1."""
    input_names: tuple[str, ...]
    """Paths of the numbers that deviate."""
    position_m: NDArray[np.float64]
    """Positions of the undisturbed robot [m]."""
    notes: tuple[str, ...]
    """Sentences on how much the numbers are worth."""
    warnings: tuple[str, ...]
    """Caveats about the robot."""
    details: dict[str, Any]
    """All keys of the program's JSON: `inputs`, `groups`, `poses`, …"""
    _answered: Answered = field(compare=False)
    """Request and results in the compiled half, for `page` and `to_pandas`."""

    def __getitem__(self, name: str) -> tuple[Any, Any]:
        """Value and deviation of the result with this name; arrays over the poses if there are several."""
        at = self.names.index(name)
        return self.value[..., at], self.deviation[..., at]

    def __repr__(self) -> str:
        poses = f" at {len(self.value)} poses" if self.value.ndim == 2 else ""
        sampled = int(self.is_sampled.sum())
        return f"<Uncertainty of {len(self.names)} results{poses} from {len(self.input_names)} numbers, {sampled} sampled>"


def uncertainty(answered: Answered) -> Uncertainty:
    """Arrays from results of the compiled half."""
    found = json.loads(answered.json())
    poses = found["poses"]
    units = {result["name"]: result["unit"] for pose in poses for result in pose["results"]}
    names = tuple(units)
    groups = tuple(group["name"] for group in found["groups"])
    shape = (len(poses), len(names))
    value, deviation = np.full(shape, np.nan), np.full(shape, np.nan)
    interval, shares = np.full((*shape, 2), np.nan), np.full((*shape, len(groups)), np.nan)
    is_sampled = np.zeros(shape, dtype=bool)
    position = np.full((len(poses), 3), np.nan)
    for i, pose in enumerate(poses):
        position[i] = pose.get("position_m", np.nan)
        for result in pose["results"]:
            at = (i, names.index(result["name"]))
            value[at] = result["value"]
            deviation[at] = result.get("deviation", np.nan)
            interval[at] = result.get("interval_95", np.nan)
            shares[at] = result.get("group_shares", np.nan)
            is_sampled[at] = result["method"] == "sampled"
    if len(poses) == 1:
        value, deviation, interval, shares = value[0], deviation[0], interval[0], shares[0]
        is_sampled, position = is_sampled[0], position[0]
    return Uncertainty(
        names=names,
        units=tuple(units.values()),
        value=value,
        deviation=deviation,
        interval_95=interval,
        is_sampled=is_sampled,
        group_names=groups,
        group_shares=shares,
        input_names=tuple(entry["path"] for entry in found["inputs"]),
        position_m=position,
        notes=tuple(found["notes"]),
        warnings=tuple(found["warnings"]),
        details=found,
        _answered=answered,
    )
