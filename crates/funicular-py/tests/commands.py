"""Conversion of command lines to calls of Python: an option's name with _ in place of - is the keyword."""

import csv
import json
import re
import shlex
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import funicular

# Options for the place and the form of a result, which do not change the computation.
OUTPUT = {"--format", "-o", "--output-file", "--print-request", "--help", "--matrices", "--resume", "--discard", "--part", "--threads"}
OUTPUT |= {"--figure-width-mm", "--font-size-pt", "--figure-mode", "--fitted", "--designed", "--calibrated", "--calibrated-covariance", "--page", "--pdf", "--proved", "--certificate", "--samples-file", "--junit", "--badge", "--lengths", "--surface", "--animation", "--figure", "--universal-file", "--quiet"}
# Options without a value.
SWITCHES = {
    *("--log", "--adaptive", "--all", "--in-plane-only", "--print-request", "--resume", "--discard"),
    *("--platform", "--hold-lengths-of-pose", "--friction-interval", "--rigid-cables", "--rope-inertia", "--fastest", "--once", "--hold-platform"),
    *("--find-way", "--in-gusts", "--quiet", "--summary", "--reconnect", "--prove", "--controls"),
}
# Options that may be given several times.
LISTS = {"reduce": {"--input", "--output"}, "gust": {"--output"}, "identify": {"--profile"}}


def commands(executable: str) -> list[str]:
    """Commands of the program, without those for shells and the manual."""
    told = subprocess.run([executable, "--help"], capture_output=True, text=True, check=True).stdout
    listed = told.split("Commands:")[1].split("Options:")[0]
    return [name for name in re.findall(r"^  ([a-z][a-z-]*) ", listed, re.MULTILINE) if name not in ("help", "completions", "man")]


def help_of(executable: str, command: str) -> str:
    return subprocess.run([executable, command, "--help"], capture_output=True, text=True, check=True).stdout


def options(executable: str, command: str) -> list[str]:
    """Names of the options of a command, without the options of all commands."""
    told = help_of(executable, command).split("Examples:")[0]
    found = re.findall(r"^ +(?:-[a-zA-Z], )?(--[a-z0-9-]+)(?: <|$|\n)", told, re.MULTILINE)
    return [name for name in dict.fromkeys(found) if name not in ("--help", "--version", "--print-request")]


def examples(executable: str, command: str) -> list[str]:
    """Examples in the help of a command."""
    _, _, told = help_of(executable, command).partition("Examples:\n")
    blocks = told.split("\n\n")[0]
    joined = re.sub(r"\s+", " ", blocks.replace("\\\n", " "))
    lines = [f"funicular {line.strip()}" for line in re.split(r"(?:^|\s)funicular ", joined) if line.strip()]
    return [line.split("&&")[0].strip() for line in lines if line.split()[1] == command]


def number(text: str) -> Any:
    return int(text) if re.fullmatch(r"-?\d+", text) else float(text)


def numbers(text: str) -> list[Any]:
    return [number(part) for part in text.split(",")]


def steps(text: str) -> Any:
    """Values along an axis for the keywords `grid`, `vary`, `section` and `accuracy_grid`."""
    if ":" in text:
        first, last, count = text.split(":")
        return (number(first), number(last), int(count))
    return numbers(text)


def value(command: str, option: str, text: str) -> Any:
    if (command, option) == ("pose-error", "--mass-kg"):
        return steps(text)
    if option in ("--sensors", "--unknowns", "--hold-anchors", "--frame", "--propose-for", "--propose-measuring") or (command, option) == ("calibrate", "--profile"):
        return text.split(",")
    if option in ("--of", "--by", "--tolerances", "--deviations") and command != "schema":
        return text.split(",")
    if option in ("--weights", "--leave-out", "--avoid-hz", "--tension-range-n", "--profile-s", "--shape-modes-hz"):
        return [float(part) for part in text.replace(":", ",").split(",")]
    if option in ("--input", "--output", "--name", "--rope", "--to", "--prefix") or re.search("[a-z]{2}", text):
        return text
    found = numbers(text)
    return found[0] if len(found) == 1 else found


def call(line: str) -> tuple[str, list[str], dict[str, Any], dict[str, Any]]:
    """Command, files, keywords and changes of the robot file of a command line."""
    words = shlex.split(line)[1:]
    command, files, keywords, changes = words[0], [], {}, {}
    keywords: dict[str, Any] = {}
    rest = iter(words[1:])
    for word in rest:
        key = {"--for": "duration_s"}.get(word, word.removeprefix("--").replace("-", "_"))
        if not word.startswith("-"):
            files.append(word)
        elif word in OUTPUT:
            if word not in SWITCHES:
                next(rest)
        elif word in SWITCHES and (command, word) != ("estimate", "--log"):
            keywords[key] = True
        elif word == "--set":
            path, _, text = next(rest).partition("=")
            changes[path] = value(command, word, text)
        elif word in ("--at-least", "--at-most"):
            quantity, _, text = next(rest).partition("=")
            keywords.setdefault(key, {})[quantity] = float(text)
        elif word in ("--grid", "--vary", "--section", "--accuracy-grid"):
            axis, _, text = next(rest).partition("=")
            keywords.setdefault(key, {})[axis] = steps(text)
        elif word == "--within":
            axis, _, text = next(rest).partition("=")
            ends = [number(part) for part in text.split(":")]
            keywords.setdefault(key, {})[axis] = tuple(ends) if len(ends) == 2 else ends[0]
        elif word == "--point":
            name, _, text = next(rest).partition("=")
            keywords.setdefault(key, {})[name] = numbers(text)
        elif word == "--scenario":
            keywords[key] = tomllib.loads(Path(next(rest)).read_text())
        elif word == "--quantity":
            keywords["quantities"] = next(rest).split(",")
        elif word in ("--offers", "--ropes") or (command, word) == ("uncertainty", "--covariance"):
            keywords[key] = read_records(next(rest))
        elif word in ("--poses", "--via", "--accuracy-poses"):
            keywords[key] = read_poses(next(rest))
        elif command == "design" and word == "--change":
            keywords.setdefault(key, []).append(chosen(next(rest)))
        elif command == "calibrate" and word == "--prior":
            path, _, prior = next(rest).partition("=")
            known, _, deviation = prior.partition("±")
            keywords.setdefault(key, {})[path] = (float(known), float(deviation)) if known else float(deviation)
        elif command == "identify" and word in ("--fit", "--prior", "--measured", "--node", "--response"):
            keywords.setdefault(key, []).append(next(rest))
        elif word in LISTS.get(command, ()):
            keywords.setdefault(key, []).append(next(rest))
        elif command == "frf" and key in ("input", "output") and key in keywords:
            before = keywords[key]
            keywords[key] = [*([before] if isinstance(before, str) else before), next(rest)]
        else:
            keywords[key] = value(command, word, next(rest))
    if command == "identify":
        keywords = identification(keywords)
    return command, files, keywords, changes


def read_records(name: str) -> list[dict[str, Any]]:
    """Rows of a table with texts and numbers, as keywords; empty cells are left out."""
    with Path(name).open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [{key: text if key in ("name", "first", "second") else float(text) for key, text in row.items() if text} for row in rows]


def chosen(text: str) -> dict[str, Any]:
    """Value of a design with its bounds, as in a request."""
    path, _, bounds = text.partition("=")
    if bounds.startswith("±"):
        return {"path": path, "plus_minus": float(bounds[1:])}
    low, high = map(float, bounds.split(":"))
    return {"path": path, "minimum": low, "maximum": high}


# Options of `identify` that belong to the request; the others belong to its experiment.
OF_REQUEST = {"starts", "from_hz", "to_hz", "response_noise", "frequency_noise", "damping_noise", "rigid_cables"}
OF_REQUEST |= {"profile", "tension_rule", "target_tension_n", "min_tension_n", "max_tension_n"}
OF_REQUEST |= {"propose", "grid", "poses", "propose_measuring", "propose_payloads_kg", "propose_modes", "propose_for", "propose_by", "wanted_percent"}
OF_REQUEST |= {"cable_model", "assembly", "in_plane_only", "winches"}
OF_REQUEST |= {"history_kind", "history_from_s", "history_to_s", "history_poles"}


def identification(keywords: dict[str, Any]) -> dict[str, Any]:
    """Keywords of a request of `identify` with one experiment."""
    fit: dict[str, dict[str, Any]] = {}
    for text in keywords.pop("fit", []):
        path, _, bounds = text.partition("=")
        low, high = map(float, bounds.split(":")) if bounds else (None, None)
        fit[path] = {"path": path, "minimum": low, "maximum": high}
    for text in keywords.pop("prior", []):
        path, _, prior = text.partition("=")
        value, deviation = prior.split("±")
        fit[path] |= {"prior": float(value), "prior_std": float(deviation)}
    of_files: dict[str, Any] = {
        "nodes": {int(text.partition("=")[0]): numbers(text.partition("=")[2]) for text in keywords.pop("node", [])},
        "responses": dict(text.split("=") for text in keywords.pop("response", [])),
        **{key: keywords.pop(key) for key in ("input_point_m", "output_point_m") if key in keywords},
    }
    measured, states = keywords.pop("measured", []), keywords.pop("experiments", None)
    experiment = {key: value for key, value in keywords.items() if key not in OF_REQUEST}
    for path in measured:
        experiment |= funicular.read_measurements(path, **of_files)
    experiments = [experiment]
    if states is not None:
        with open(states) as file:
            experiments = json.load(file)
    return {
        "fit": [{key: value for key, value in entry.items() if value is not None} for entry in fit.values()],
        "experiments": experiments,
        **{key: value for key, value in keywords.items() if key in OF_REQUEST},
    }


def read_poses(path: str) -> list[list[float]]:
    with open(path) as file:
        return [list(map(float, line.split(","))) for line in file.read().splitlines()[1:]]


def robot_of(files: list[str], changes: dict[str, Any]) -> funicular.Robot:
    robot = funicular.Robot.from_file(files[0]) if files else funicular.Robot.example()
    return robot.with_(changes) if changes else robot
