"""Requests as dictionaries, and the commands of the program without a robot file."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from funicular._declared import OUTPUTS, check_wanted, wanted_files, write_wanted
from funicular._errors import InputError
from funicular._funicular import (
    Answered,
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
from funicular._live import live
from funicular._hints import hinted
from funicular._pages import Page, page, try_page
from funicular._reading import File, keywords, read
from funicular._results import kind_of
from funicular._sweeps import Sweep


@dataclass(frozen=True, repr=False)
class Imported:
    """Robot file made from files of another program."""

    text: str
    """Text of the robot file."""
    assumed: tuple[str, ...]
    """Assumptions about facts that the files leave open."""
    lost: tuple[str, ...]
    """Facts of the files that a robot file cannot hold."""

    @property
    def robot(self) -> Robot:
        """Robot of the robot file."""
        return Robot.from_toml(self.text)

    def write(self, path: File) -> None:
        """Writes the robot file; the file is complete or absent."""
        write_file(Path(path), self.text)

    def __repr__(self) -> str:
        return f"<Imported {self.robot.name!r}: {len(self.assumed)} assumptions, {len(self.lost)} facts lost>"


@dataclass(frozen=True, repr=False)
class NewRobot:
    """Robot file with starting values and comments."""

    text: str
    """Text of the robot file."""
    warnings: tuple[str, ...]
    """Caveats; empty if the robot has a stable equilibrium in the state of the file."""

    @property
    def robot(self) -> Robot:
        """Robot of the robot file."""
        return Robot.from_toml(self.text)

    def write(self, path: File) -> None:
        """Writes the robot file, complete or not at all. A file that exists is never replaced.

        Raises
        ------
        FileExistsError
            The file exists and may hold numbers of your own.
        """
        if Path(path).exists():
            raise FileExistsError(f"{path} exists and may hold your own numbers: name another file, or remove it")
        write_file(Path(path), self.text)

    def __repr__(self) -> str:
        return f"<NewRobot {self.robot.name!r}: {len(self.warnings)} warnings>"


@dataclass(frozen=True, repr=False)
class Exported:
    """Equilibrium of a robot as the file of another program."""

    text: str
    """Text of the file."""
    warnings: tuple[str, ...]
    """Caveats of the file."""

    def __repr__(self) -> str:
        return f"<Exported: {len(self.text)} characters>"


def request(command: str, robot: str | None, cables: Sequence[str], given: Mapping[str, Any]) -> dict[str, Any]:
    """Makes a request with all its keys; `robot` is JSON, `cables` are the names of its cables."""
    made = {**keywords(command, given, cables), "command": command}
    if robot is not None:
        made["robot"] = json.loads(robot)
    return complete(made)


def complete(given: Mapping[str, Any] | str) -> dict[str, Any]:
    """Adds the defaults to a request, which is a dictionary or JSON."""
    text = given if isinstance(given, str) else json.dumps(read("", "request", given))
    full: dict[str, Any] = json.loads(complete_request(text))
    return full


def _without_files(request: Mapping[str, Any] | str) -> tuple[Mapping[str, Any] | str, Mapping[str, Any]]:
    """Request without the files that it wants, and these."""
    given: Any = request
    if isinstance(request, str):
        try:
            given = json.loads(request)
        except ValueError:  # the reader of requests says what is wrong
            return request, {}
    if not isinstance(given, Mapping) or given.get("write_files") is None:
        return request, {}
    if not isinstance(given["write_files"], Mapping):
        raise InputError(f"`write_files` is of type {type(given['files']).__name__}: give a mapping, as in {{'page': 'page.html'}}")
    return {key: value for key, value in given.items() if key != "write_files"}, given["write_files"]


def run(request: Mapping[str, Any] | str, **files: Any) -> Any:
    """Runs a request: the dictionary of `Robot.request`, or the JSON of the program's `--print-request`.

    Parameters
    ----------
    files
        Files that the command writes besides its result, as the keywords of its method: `page`, `figure`, `lengths` and so
        on. The key `write_files` of a request has the same.

    Returns
    -------
    The `Results` with the keys of the program's JSON, a dictionary; a `Sweep` for `map` and `sweep`, a `Page` for `report`, `paper` and `plot`, a `Live`
    for `live`, an `Imported` for `import`, a `NewRobot` for `new`, an `Exported` for `export`.

    Raises
    ------
    InputError
        A value of the request is wrong.
    Error
        The request has no result.
    """
    request, own = _without_files(request)
    full = complete(request)
    keys = {**own, **files}
    wanted = wanted_files(full["command"], keys)
    if keys:
        known = ", ".join(output["key"] for output in OUTPUTS[full["command"]]) or "no other file"
        raise InputError(f"`{full['command']}` writes no `{next(iter(keys))}`: besides its result it writes {known}")
    check_wanted(full["command"], {key: value for key, value in full.items() if value not in (None, [])}, wanted)
    text = json.dumps(full)
    match full["command"]:
        case "map" | "sweep":
            work = SweepPlan(text).begin()
            assert work is not None
            work.run()
            return Sweep(work.finish())
        case "live":
            return live(text_of(text, "")[0])
        case "report" | "paper":
            return page(*text_of(text, "funicular.run(request)"))
        case "export":
            made, warnings = text_of(text, "")
            return Exported(made, tuple(warnings))
        case "new":
            made, warnings = text_of(text, "")
            return NewRobot(made, tuple(warnings))
        case "schema":
            made, _ = text_of(text, "")
            return json.loads(made)
        case "import":
            made, assumed, lost = imported(text)
            return Imported(made, tuple(assumed), tuple(lost))
        case "plot":
            write_wanted(Answered(text), "funicular.run(request, ", wanted)
            return Sweep.read(full["file"]).plot()
        case "merge":
            raise InputError("`merge` writes a file: call `funicular.merge(parts, path)`")
        case "validate":
            found = json.loads(answer(text))
            write_wanted(Answered(text), "funicular.run(request, ", wanted)
            return kind_of(full)(found)
        case _:
            answered = Answered(text)
            plain = json.loads(answered.json())
            found = kind_of(full)(plain)
            write_wanted(answered, "funicular.run(request, ", wanted)
            found._answered = answered
            return found


@hinted
def new_robot(
    *,
    cables: int | None = None,
    motion: str = "rigid",
    from_csv: File | None = None,
    csv_unit: str | None = None,
    name: str | None = None,
    pose: Pose | ArrayLike | None = None,
    mass_kg: float | None = None,
    box_m: ArrayLike | None = None,
    rope: str = "6x19",
    diameter_m: float | None = None,
    axial_stiffness_n: float | None = None,
    mass_kg_per_m: float | None = None,
) -> NewRobot:
    """Makes a robot file with starting values, as the program's `new`.

    Parameters
    ----------
    cables
        Number of cables of a symmetric layout, up to 64; 8 if not given, 4 for `planar-xz` and `point-mass`.
    motion
        Motion of the platform: `rigid`, `point-mass` or `planar-xz`.
    from_csv, csv_unit
        Table of the cables in place of their number: name (may be left out), anchor x, y, z in the world frame,
        attachment x, y, z in the platform frame; and its unit, `m` or `mm`.
    name
        Name of the robot.
    pose
        Pose that the robot file gives as its state; a stable pose that is found if not given.
    mass_kg, box_m
        Mass of the platform [kg], 100 if not given, and sides [m] of the homogeneous box that gives the inertia.
    rope, diameter_m
        Type of the rope, the wire ropes `6x19` and `7x7` or the fibre rope `hmpe`, and its diameter [m].
    axial_stiffness_n, mass_kg_per_m
        Axial stiffness EA [N] and mass per unstrained length [kg/m] of another rope.

    Raises
    ------
    InputError
        A value is out of its range, or the table cannot be read; the message says where and why.
    """
    given = {
        "cables": cables,
        "motion": motion,
        "from_csv": None if from_csv is None else json.loads(source_file(Path(from_csv))),
        "csv_unit": csv_unit,
        "name": name,
        "pose": pose,
        "mass_kg": mass_kg,
        "box_m": box_m,
        "rope": rope,
        "diameter_m": diameter_m,
        "axial_stiffness_n": axial_stiffness_n,
        "mass_kg_per_m": mass_kg_per_m,
    }
    made = run(request("new", None, (), given))
    assert isinstance(made, NewRobot)
    return made


def schema(of: Literal["robot-file", "request", "columns", "results"] = "robot-file") -> dict[str, Any]:
    """Returns a JSON Schema, as the program's `schema` writes it.

    Parameters
    ----------
    of
        The robot file, requests (the dictionaries that `run` takes), or results: the keys of every command with their
        meanings and units. `columns` are those of the tables in files.
    """
    made: dict[str, Any] = run({"command": "schema", "of": of})
    return made


@hinted
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
    """Makes a robot file from files of other programs, as the program's `import`.

    Parameters
    ----------
    files
        File, or list of the files of one robot.
    cable_set
        Set of cables of a CASPR file.
    mass_kg_per_m, axial_stiffness_n, youngs_modulus_pa, diameter_m
        Mass per unstrained length [kg/m], axial stiffness EA [N], Young's modulus of the full circular section [Pa] and
        diameter [m] of the ropes; they replace the values of the files.
    mass_kg, inertia_kg_m2, center_of_mass_m
        Mass [kg], inertia tensor about the centre of mass, platform axes [kg m²]: xx, yy, zz, xy, xz, yz, and centre of
        mass in the platform frame [m]; they replace the values of the files.
    pose
        Pose that the robot file gives as its state.

    Raises
    ------
    InputError
        A file cannot be read as a robot; the message says where and why.
    """
    listed = [files] if isinstance(files, (str, PathLike)) else files
    given = {
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
    made = run(request("import", None, (), given))
    assert isinstance(made, Imported)
    return made


def import_trajectory(files: Sequence[File], name: str) -> dict[str, NDArray[np.float64]]:
    """Reads a trajectory of CASPR, as the program's `import --trajectory`.

    Parameters
    ----------
    files
        The bodies file and the trajectories file of a robot.
    name
        Name of the trajectory.

    Returns
    -------
    Columns `t_s` [s], `x_m`, `y_m`, `z_m` [m] and, where the platform turns, `roll_deg`, `pitch_deg`, `yaw_deg`, as
    arrays: the `path` of `Robot.trajectory`.

    Raises
    ------
    InputError
        There is no such trajectory, or it cannot be read; the message says where and why.
    """
    listed = [json.loads(source_file(Path(path))) for path in files]
    made = run({"command": "import", "files": listed, "trajectory": name})
    assert isinstance(made, Imported)
    header, *rows = made.text.splitlines()
    columns = np.array([[float(cell) for cell in row.split(",")] for row in rows]).T
    return dict(zip(header.split(","), columns, strict=True))


def paper(path: File | None = None) -> Page:
    """Makes the page that compares the results of Yuan, Courteille and Deblaise 2014 with those of this package.

    With `path` the page is also written to a file.
    """
    try_page(path)
    text = json.dumps({"command": "paper"})
    return page(*text_of(text, f"funicular.paper({'' if path is None else repr(str(path))})"), path)


def validate(
    *,
    only: str | Sequence[str] = (),
    level: Literal["exact", "program", "published", "measured"] | None = None,
    controls: bool = False,
    junit: File | None = None,
    badge: File | None = None,
) -> dict[str, Any]:
    """Computes comparisons with published and independent numbers, as the program's `validate`.

    Parameters
    ----------
    only
        IDs of comparisons, or their beginnings: a section, a source or one comparison; all if none is given.
    level
        Kind of the reference numbers; all if none is given.
    controls
        Runs the negative controls, too: sections with one wrong input, which must fail.
    junit, badge
        Files: a report for build servers (XML), and a badge (SVG).

    Returns
    -------
    The keys of the program's JSON: `comparisons` is their number, `passed` the number within their tolerances.

    Raises
    ------
    InputError
        No comparison has such an ID.
    """
    files = {key: path for key, path in (("junit", junit), ("badge", badge)) if path is not None}
    ids = [only] if isinstance(only, str) else list(only)
    found: dict[str, Any] = run({"command": "validate", "only": ids, "level": level, "controls": controls}, **files)
    return found


def merge(parts: Sequence[File], path: File) -> Sweep:
    """Joins the parts of a map or sweep (`part="3/8"`) in one file, as the program's `merge`.

    Raises
    ------
    FileError
        The files are not all parts of one map or sweep, or the file cannot be written.
    """
    merge_parts([Path(part) for part in parts], Path(path))
    return Sweep(None, Path(path))
