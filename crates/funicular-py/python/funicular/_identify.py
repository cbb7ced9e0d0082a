"""Identification: values of a robot file that fit measurements best."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from funicular._errors import InputError
from funicular._funicular import Answered, Robot, measurements_of_file
from funicular._hints import hinted
from funicular._pages import Answer
from funicular._reading import File, read


@dataclass(frozen=True, repr=False, eq=False)
class Identified(Answer):
    """Values that fit measurements best, in the manner of `scipy.optimize`."""

    names: tuple[str, ...]
    """Paths of the values in the robot file."""
    x: NDArray[np.float64]
    """Values, in the units of the file."""
    deviations: NDArray[np.float64]
    """Standard deviations; NaN for a value that the measurements do not determine, or that moves with such a value."""
    correlations: NDArray[np.float64]
    """Correlations of the values, one row per value."""
    chi2: float
    """Sum of the squares of the residuals."""
    chi2_per_degree: float
    """χ² per degree of freedom; 1 if the residuals are as large as the deviations of the measurements."""
    message: str
    """Sentence on χ²."""
    success: bool
    """True if the search has ended at a minimum."""
    warnings: tuple[str, ...]
    """Caveats, among them combinations of values that the measurements do not determine."""
    details: dict[str, Any]
    """All keys of the program's JSON: `values`, `starts`, `frequencies`, `responses`, `statics`, …"""
    _answered: Answered = field(compare=False)
    """Request and results in the compiled half, for `page` and `to_pandas`."""

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariances of the values; NaN where a value is not determined."""
        matrix: NDArray[np.float64] = self.correlations * np.outer(self.deviations, self.deviations)
        return matrix

    @property
    def determined(self) -> bool:
        """False if measured frequencies without a number may belong to other modes; `deviations` are then NaN."""
        assignment = self.assignment
        return True if assignment is None else bool(assignment["determined"])

    @property
    def assignment(self) -> dict[str, Any] | None:
        """Search over the modes of frequencies without a number: `determined`, `doubts`, `random_chi2_per_degree`, `second_best`, …

        The modes themselves are in `details["frequencies"]`, those of the second best fit in `second_best["numbers"]` with
        its `values`. None if every frequency has a number, or if responses were measured as well.
        """
        found: dict[str, Any] | None = self.details.get("assignment")
        return found

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
        if not self.names:
            return f"<Identified: {len(self.details['histories'])} time histories>"
        values = ", ".join(f"{name}={value:.6g}" for name, value in zip(self.names, self.x, strict=True))
        return f"<Identified: {values}; χ²/n = {self.chi2_per_degree:.3g}>"


def identified(request: Mapping[str, Any]) -> Identified:
    """Runs a request of `identify`."""
    answered = Answered(json.dumps(request))
    found = json.loads(answered.json())
    rows = found["values"]
    return Identified(
        names=tuple(row["path"] for row in rows),
        x=np.array([row["value"] for row in rows]),
        deviations=np.array([row.get("deviation", np.nan) for row in rows]),
        correlations=np.array(found["correlations"]),
        chi2=found["chi2"],
        chi2_per_degree=found["chi2_per_degree"],
        message=found["verdict"],
        success=found["converged"],
        warnings=tuple(found["warnings"]),
        details=found,
        _answered=answered,
    )


@hinted
def read_measurements(
    path: File,
    *,
    nodes: Mapping[int, ArrayLike] | None = None,
    responses: Mapping[str, str] | None = None,
    input_point_m: ArrayLike | None = None,
    output_point_m: ArrayLike | None = None,
) -> dict[str, Any]:
    """Reads a file of measurements: a Universal File (.uff, .unv), or a table (.csv).

    Tables have responses, natural frequencies, or time histories of sensors.

    Parameters
    ----------
    path
        File.
    nodes
        Points of the platform at nodes of a Universal File, platform frame [m]; the nodes of the file if not given.
    responses
        Signals of the responses of a table by their names in the header, as in `{"a1": "az/fz"}`; for a Universal File those
        of functions that do not tell them, by line or place, as in `{"line 7": "az/fz"}` or `{"az at node 1": "az/fz"}`.
    input_point_m, output_point_m
        Points where force and sensor of the responses of a table are, platform frame [m].

    Returns
    -------
    Experiment for `Robot.identify`: `{"responses": […]}`, `{"frequencies": […]}` or `{"histories": […]}`.

    Raises
    ------
    InputError
        The file cannot be read; the message names its line.

    Warns
    -----
    MeasurementWarning
        Functions of a Universal File were left out, or units were converted.
    """
    def point(name: str, value: ArrayLike | None) -> list[float] | None:
        return None if value is None else read("", "point_m", value, name=name)

    names = []
    for name, signals in (responses or {}).items():
        output, slash, signal = signals.rpartition("/")
        if not slash:
            raise InputError(f"`responses`: {name}={signals} is not OUTPUT/INPUT, as in az/fz")
        names.append({"name": name, "input": signal.strip(), "output": output.strip()})
    options = {
        "nodes": [{"node": int(node), "point_m": point(f"nodes[{node}].point_m", place)} for node, place in (nodes or {}).items()],
        "responses": names,
        "input_point_m": point("input_point_m", input_point_m),
        "output_point_m": point("output_point_m", output_point_m),
    }
    found: dict[str, Any] = json.loads(measurements_of_file(Path(path), json.dumps(options)))
    return found
