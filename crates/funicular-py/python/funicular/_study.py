"""Requests as dictionaries, and commands of the program that belong to no single robot."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from funicular._errors import InputError
from funicular._funicular import (
    Pose,
    Robot,
    SweepPlan,
    answer,
    complete_request,
    imported,
    merge_parts,
    source_file,
    text_of,
    write_file,
)
from funicular._pages import Page, page
from funicular._sweeps import Sweep

File = str | PathLike[str]


@dataclass(frozen=True, repr=False)
class Imported:
    """A robot file made from files of another program."""

    text: str
    """The robot file."""
    assumed: tuple[str, ...]
    """Facts that the files leave open, and how they were read."""
    lost: tuple[str, ...]
    """Facts of the files that a robot file cannot hold."""

    @property
    def robot(self) -> Robot:
        """The robot."""
        return Robot.from_toml(self.text)

    def write(self, path: File) -> None:
        """Writes the robot file, as a whole or not at all."""
        write_file(Path(path), self.text)

    def __repr__(self) -> str:
        return f"<Imported {self.robot.name!r}: {len(self.assumed)} assumptions, {len(self.lost)} facts lost>"


@dataclass(frozen=True, repr=False)
class Exported:
    """A robot at rest as the file of another program."""

    text: str
    """The file."""
    warnings: tuple[str, ...]
    """What to know before trusting it."""

    def __repr__(self) -> str:
        return f"<Exported: {len(self.text)} characters>"


def request(command: str, robot: str | None, keywords: Mapping[str, Any]) -> dict[str, Any]:
    """A request with every key that it has; the robot is JSON."""
    given = {key: _plain(key, value) for key, value in keywords.items() if value is not None}
    given["command"] = command
    if robot is not None:
        given["robot"] = json.loads(robot)
    return _complete(given)


def _complete(given: Mapping[str, Any]) -> dict[str, Any]:
    full: dict[str, Any] = json.loads(complete_request(_text(given)))
    return full


def _text(given: Mapping[str, Any]) -> str:
    try:
        return json.dumps(given, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError(f"the request holds what JSON cannot: {error}") from error


def _plain(key: str, value: Any) -> Any:
    """The value of a key as JSON has it."""
    if isinstance(value, Pose):
        return {"position_m": value.position_m.tolist(), "quaternion_wxyz": value.quaternion_wxyz.tolist()}
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if key in ("grid", "vary") and isinstance(value, Mapping):
        return [_axis(name, values) for name, values in value.items()]
    if isinstance(value, (list, tuple)):
        value = [_plain("", item) for item in value]
    if key == "pose" and isinstance(value, list) and len(value) == 7:
        return {"position_m": value[:3], "quaternion_wxyz": value[3:]}
    if key == "poses":
        return [[*row, 0.0, 0.0, 0.0] if len(row) == 3 else row for row in value]
    if key == "target_tension_n" and not isinstance(value, list):
        return [value]
    return value


def _axis(name: str, values: Any) -> dict[str, Any]:
    """Values along an axis: a tuple of first, last and how many, else values."""
    if isinstance(values, tuple) and len(values) == 3:
        first, last, count = (_plain("", value) for value in values)
        return {"axis": name, "from": first, "to": last, "count": count}
    return {"axis": name, "values": np.atleast_1d(values).tolist()}


def run(request: Mapping[str, Any] | str) -> Any:
    """Runs a request: a dictionary or JSON, as `Robot.request` makes it and the program's `--print-request` prints it.

    Returns
    -------
    The dictionary of the program's JSON. For `map` and `sweep` a `Sweep`, for `report`, `paper` and `plot` a `Page`, for
    `import` an `Imported`, for `export` an `Exported`.

    Raises
    ------
    InputError
        The request means nothing.
    Error
        There is no such result.
    """
    full = _complete(json.loads(request) if isinstance(request, str) else request)
    text = json.dumps(full)
    match full["command"]:
        case "map" | "sweep":
            work = SweepPlan(text).begin()
            assert work is not None
            work.run()
            return Sweep(work.finish())
        case "report" | "paper":
            return page(*text_of(text, "funicular.run(request)"))
        case "export":
            made, warnings = text_of(text, "")
            return Exported(made, tuple(warnings))
        case "import":
            made, assumed, lost = imported(text)
            return Imported(made, tuple(assumed), tuple(lost))
        case "plot":
            return Sweep.read(full["file"]).plot()
        case "merge":
            raise InputError("`merge` writes a file: call `funicular.merge(parts, path)`")
        case _:
            return json.loads(answer(text))


def import_robot(
    files: File | Sequence[File],
    *,
    cable_set: str | None = None,
    mass_kg_per_m: float | None = None,
    axial_stiffness_n: float | None = None,
    youngs_modulus_pa: float | None = None,
    diameter_m: float | None = None,
    mass_kg: float | None = None,
    inertia_kg_m2: ArrayLike | None = None,
    center_of_mass_m: ArrayLike | None = None,
    pose: Pose | ArrayLike | None = None,
) -> Imported:
    """A robot file from files of CASPR, WireX or MoorDyn: the program's `import`.

    Parameters
    ----------
    files
        The file, or the files of one robot.
    cable_set
        Set of cables of a CASPR file.
    mass_kg_per_m, axial_stiffness_n, youngs_modulus_pa, diameter_m
        Numbers of the ropes that the files lack, or instead of theirs.
    mass_kg, inertia_kg_m2, center_of_mass_m
        Numbers of the platform that the files lack, or instead of theirs; the inertia is xx, yy, zz, xy, xz, yz.
    pose
        Pose of the robot file's state.

    Raises
    ------
    InputError
        A file that cannot be read as a robot; the message says where and what.
    """
    listed = [files] if isinstance(files, (str, PathLike)) else files
    keywords = {
        "files": [json.loads(source_file(Path(path))) for path in listed],
        "cable_set": cable_set,
        "mass_kg_per_m": mass_kg_per_m,
        "axial_stiffness_n": axial_stiffness_n,
        "youngs_modulus_pa": youngs_modulus_pa,
        "diameter_m": diameter_m,
        "mass_kg": mass_kg,
        "inertia_kg_m2": inertia_kg_m2,
        "center_of_mass_m": center_of_mass_m,
        "pose": pose,
    }
    made = run(request("import", None, keywords))
    assert isinstance(made, Imported)
    return made


def paper(path: File | None = None) -> Page:
    """The page about the starting paper (Yuan, Courteille and Deblaise 2014), theirs beside ours; `path` writes it, too."""
    text = json.dumps({"command": "paper"})
    return page(*text_of(text, f"funicular.paper({'' if path is None else repr(str(path))})"), path)


def validate() -> dict[str, Any]:
    """Every comparison with published and independent numbers, made now: the program's `validate`, with the keys of its
    JSON; `comparisons` of them, `passed` within their tolerances."""
    found: dict[str, Any] = run({"command": "validate"})
    return found


def merge(parts: Sequence[File], path: File) -> Sweep:
    """Joins the parts of a map or sweep (`funicular map --part`) in one file: the program's `merge`.

    Raises
    ------
    FileError
        Files that are no parts of one whole, or a file that cannot be written.
    """
    merge_parts([Path(part) for part in parts], Path(path))
    return Sweep(None, Path(path))
