"""Identification: values of a robot file that fit measurements best."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from funicular._errors import InputError
from funicular._funicular import Answered, Robot, measurements_of_file
from funicular._pages import Page, page_of_result
from funicular._results import with_arrays
from funicular._study import complete, plain

File = str | PathLike[str]


@dataclass(frozen=True, repr=False, eq=False)
class Identified:
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
    _answered: Answered
    """Request and results in the compiled half, for `page`."""

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariances of the values; NaN where a value is not determined."""
        matrix: NDArray[np.float64] = self.correlations * np.outer(self.deviations, self.deviations)
        return matrix

    @property
    def robot_file(self) -> str:
        """Text of the robot file with the values."""
        text: str = self.details["robot_file"]
        return text

    @property
    def robot(self) -> Robot:
        """Robot with the values."""
        return Robot.from_toml(self.robot_file)

    def page(self, path: File | None = None) -> Page:
        """Makes a page in HTML about the fit, which notebooks show, and writes it if a path is given."""
        return page_of_result(self._answered, path)

    def to_dict(self) -> dict[str, Any]:
        """Keys of the program's JSON, with arrays for lists of numbers."""
        found: dict[str, Any] = with_arrays(self.details)
        return found

    def __repr__(self) -> str:
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


def identify_request(robot: str, fit: Any, experiments: Any, keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Request of `Robot.identify`; `robot` is JSON. Keywords of the state belong to experiments that do not give them."""
    given = {key: plain(key, value) for key, value in keywords.items() if value is not None}
    own: tuple[str, ...] = ("starts", "from_hz", "to_hz", "response_noise", "frequency_noise", "damping_noise", "rigid_cables", "profile")
    own += ("tension_rule", "target_tension_n", "min_tension_n", "max_tension_n")
    own += ("cable_model", "assembly", "in_plane_only", "winches")
    state = {key: value for key, value in given.items() if key not in own}
    if isinstance(experiments, Mapping):
        experiments = [experiments]
    made = {
        "command": "identify",
        "robot": json.loads(robot),
        "fit": _fit(fit),
        "experiments": [{**state, **_experiment(experiment)} for experiment in experiments],
        **{key: value for key, value in given.items() if key in own},
    }
    return complete(made)


def _fit(fit: Any) -> list[dict[str, Any]]:
    """Values to identify: paths, or a mapping from paths to bounds (minimum, maximum) or to keys of a value."""
    if isinstance(fit, str):
        fit = [fit]
    if not isinstance(fit, Mapping):
        return [dict(value) if isinstance(value, Mapping) else {"path": value} for value in fit]
    found = []
    for path, value in fit.items():
        if value is None:
            found.append({"path": path})
        elif isinstance(value, Mapping):
            found.append({"path": path, **value})
        else:
            low, high = value
            found.append({"path": path, "minimum": low, "maximum": high})
    return [{key: value for key, value in entry.items() if value is not None} for entry in found]


def _experiment(experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Experiment with lists in place of arrays."""
    def lists(value: Any) -> Any:
        if isinstance(value, Mapping):
            return {key: lists(of_key) for key, of_key in value.items() if of_key is not None}
        if isinstance(value, (list, tuple)) and value and isinstance(value[0], Mapping):
            return [lists(item) for item in value]
        return plain("", value)

    return {key: plain(key, lists(value)) for key, value in experiment.items() if value is not None}


def read_measurements(
    path: File,
    *,
    nodes: Mapping[int, ArrayLike] | None = None,
    responses: Mapping[str, str] | None = None,
    input_point_m: ArrayLike | None = None,
    output_point_m: ArrayLike | None = None,
) -> dict[str, Any]:
    """Reads a file of measurements: a Universal File (.uff, .unv), or a table (.csv) of responses or of natural frequencies.

    Parameters
    ----------
    path
        File.
    nodes
        Points of the platform at nodes of a Universal File, platform frame [m]; the nodes of the file if not given.
    responses
        Signals of the responses of a table by their names in the header, as in `{"a1": "az/fz"}`.
    input_point_m, output_point_m
        Points where force and sensor of the responses of a table are, platform frame [m].

    Returns
    -------
    Experiment for `Robot.identify`: `{"responses": […]}` or `{"frequencies": […]}`.

    Raises
    ------
    InputError
        The file cannot be read; the message names its line.
    """
    def point(value: ArrayLike | None) -> list[float] | None:
        return None if value is None else np.asarray(value, float).tolist()

    names = []
    for name, signals in (responses or {}).items():
        output, slash, signal = signals.rpartition("/")
        if not slash:
            raise InputError(f"`responses`: {name}={signals} is not OUTPUT/INPUT, as in az/fz")
        names.append({"name": name, "input": signal.strip(), "output": output.strip()})
    options = {
        "nodes": [{"node": int(node), "point_m": point(place)} for node, place in (nodes or {}).items()],
        "responses": names,
        "input_point_m": point(input_point_m),
        "output_point_m": point(output_point_m),
    }
    found: dict[str, Any] = json.loads(measurements_of_file(Path(path), json.dumps(options)))
    return found
