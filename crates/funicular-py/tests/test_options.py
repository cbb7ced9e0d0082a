"""docs/python.md lists the Python of every command and every option; `UPDATE_DOCS=1` writes the tables."""

import inspect
import os
import re
from collections.abc import Callable
from typing import Any

import commands
import funicular
import funicular.plot
import numpy as np
import pytest
from conftest import ROOT
from funicular import Equilibrium, Robot, Sweep
from funicular._declared import OUTPUTS

DOCUMENT = ROOT / "docs/python.md"

# Python for every command, and the callables whose keywords are the options of the command.
COMMANDS: dict[str, tuple[str, list[Callable[..., Any]]]] = {
    "check": ("`robot.check()`", [Robot.check]),
    "parameters": ("`robot.parameters()`", [Robot.parameters]),
    "statics": ("`robot.equilibrium(…)`", [Robot.equilibrium]),
    "stiffness": ("`robot.equilibrium(…).stiffness(…)`", [Robot.equilibrium, Equilibrium.stiffness]),
    "modes": ("`robot.equilibrium(…).modes(…)`", [Robot.equilibrium, Equilibrium.modes]),
    "frf": ("`robot.equilibrium(…).frf(…)`, `funicular.peaks(…)`", [Robot.equilibrium, Equilibrium.frf, funicular.peaks]),
    "settle": ("`robot.equilibrium(…).settle(…)`", [Robot.equilibrium, Equilibrium.settle]),
    "gust": ("`robot.equilibrium(…).gust(…)`", [Robot.equilibrium, Equilibrium.gust]),
    "compare": ("`robot.equilibrium(…).compare(…)`", [Robot.equilibrium, Equilibrium.compare]),
    "gradient": ("`robot.equilibrium(…).gradient(…)`", [Robot.equilibrium, Equilibrium.gradient]),
    "uncertainty": ("`robot.uncertainty(…)`", [Robot.uncertainty]),
    "payload": ("`robot.payload(…)`", [Robot.payload]),
    "loads": ("`robot.loads(…)`", [Robot.loads]),
    "speeds": ("`robot.speeds(…)`", [Robot.speeds]),
    "winches": ("`robot.winches(…)`", [Robot.winches]),
    "trajectory": ("`robot.trajectory(path, …)`", [Robot.trajectory]),
    "simulate": ("`robot.simulate(scenario, …)`", [Robot.simulate]),
    "clearance": ("`robot.clearance(…)`", [Robot.clearance]),
    "workspace": ("`robot.workspace(…)`", [Robot.workspace]),
    "prove": ("`robot.prove(…)`", [Robot.prove]),
    "pose-error": ("`robot.pose_error(…)`", [Robot.pose_error]),
    "identify": ("`robot.identify(fit, experiments, …)`", [Robot.identify]),
    "calibrate": ("`robot.calibrate(readings, …)`", [Robot.calibrate]),
    "estimate": ("`robot.estimate(log, …)`", [Robot.estimate]),
    "observability": ("`robot.observability(…)`", [Robot.observability]),
    "design": ("`robot.design(change, …)`", [Robot.design]),
    "cable": ("`robot.equilibrium(…).cable(…)`", [Robot.equilibrium, Equilibrium.cable]),
    "reduce": (
        "`robot.equilibrium(…).state_space(…)`, `robot.equilibrium(…).reduce(…)` for the second-order form",
        [Robot.equilibrium, Equilibrium.state_space],
    ),
    "map": ("`robot.map(…)`", [Robot.map]),
    "sweep": ("`robot.sweep(…)`", [Robot.sweep]),
    "merge": ("`funicular.merge(parts, path)`", [funicular.merge]),
    "plot": ("`sweep.plot(…)`, `funicular.Sweep.read(path).plot(…)`", [Sweep.plot]),
    "report": ("`robot.equilibrium(…).report(…)`", [Robot.equilibrium, Equilibrium.report]),
    "live": ("`robot.equilibrium(…).live(…)`", [Robot.equilibrium, Equilibrium.live]),
    "paper": ("`funicular.paper(…)`", [funicular.paper]),
    "new": ("`funicular.new_robot(…)`", [funicular.new_robot]),
    "schema": ("`funicular.schema()`", [funicular.schema]),
    "import": ("`funicular.import_robot(files, …)`", [funicular.import_robot]),
    "export": ("`robot.equilibrium(…).export(to, path, …)`", [Robot.equilibrium, Equilibrium.export]),
    "validate": ("`funicular.validate(…)`", [funicular.validate]),
    "request": ("`funicular.run(request)`", [funicular.run, Robot.map, Robot.sweep]),
}

# Options without a keyword of their name, with the object that replaces them; entries of one command go first.
OTHERS: dict[tuple[str | None, str], tuple[str, Callable[..., Any]]] = {
    ("import", "--trajectory"): ("`funicular.import_trajectory`", funicular.import_trajectory),
    (None, "--quiet"): ("a call prints nothing", Robot.check),
    (None, "--set"): ("`robot.with_({path: value})`", Robot.with_),
    (None, "--all"): ("`equilibrium.all_equilibria()`", Equilibrium.all_equilibria),
    (None, "--friction-interval"): ("`equilibrium.friction_interval()`", Equilibrium.friction_interval),
    (None, "--format"): ("`to_dict()`, `to_pandas()` of the result", Equilibrium.to_dict),
    (None, "--output-file"): ("results are values; `json.dumps(result.to_dict())`", Equilibrium.to_dict),
    ("identify", "--from-hz"): ("`from_hz=`", Robot.identify),
    ("identify", "--to-hz"): ("`to_hz=`", Robot.identify),
    ("identify", "--prior"): ("`prior` and `prior_std` of a value of `fit=`", Robot.identify),
    ("identify", "--measured"): ("`funicular.read_measurements(path)`", funicular.read_measurements),
    ("identify", "--node"): ("`nodes=` of `funicular.read_measurements`", funicular.read_measurements),
    ("identify", "--response"): ("`responses=` of `funicular.read_measurements`", funicular.read_measurements),
    ("identify", "--input-point-m"): ("`input_point_m=` of `funicular.read_measurements`", funicular.read_measurements),
    ("identify", "--output-point-m"): ("`output_point_m=` of `funicular.read_measurements`", funicular.read_measurements),
    ("identify", "--measured-pose"): ("`measured_pose` of an experiment", Robot.identify),
    ("identify", "--payload-kg"): ("`payload_kg` of an experiment", Robot.identify),
    ("identify", "--payload-center-m"): ("`payload_center_m` of an experiment", Robot.identify),
    ("identify", "--measured-tensions-n"): ("`measured_tensions_n` of an experiment", Robot.identify),
    ("identify", "--measured-lengths-m"): ("`measured_lengths_m` of an experiment", Robot.identify),
    ("identify", "--position-std-m"): ("`position_std_m` of an experiment", Robot.identify),
    ("identify", "--rotation-std-deg"): ("`rotation_std_deg` of an experiment", Robot.identify),
    ("identify", "--tension-std-n"): ("`tension_std_n` of an experiment", Robot.identify),
    ("identify", "--length-std-m"): ("`length_std_m` of an experiment", Robot.identify),
    ("identify", "--output-file"): ("`json.dumps(result.details)`", funicular.Identified.to_dict),
    ("simulate", "--resume"): ("a run stays in memory, and Ctrl-C keeps what there is", Robot.simulate),
    ("simulate", "--discard"): ("a run stays in memory, and Ctrl-C keeps what there is", Robot.simulate),
    ("design", "--output-file"): ("`json.dumps(result.details)`", funicular.Designed.to_dict),
    ("workspace", "--compare-set"): ("`robot.with_({path: value})` as `compare`", Robot.with_),
    ("frf", "--output-file"): ("`equilibrium.write_frf(path, …)` for a Universal File", Equilibrium.write_frf),
    ("modes", "--output-file"): ("`equilibrium.write_modes(path, …)` for a Universal File", Equilibrium.write_modes),
    (None, "--from-hz"): ("`hz=numpy.linspace(from_hz, to_hz, points)`", np.linspace),
    (None, "--to-hz"): ("`hz=numpy.linspace(from_hz, to_hz, points)`", np.linspace),
    (None, "--points"): ("`hz=numpy.linspace(from_hz, to_hz, points)`", np.linspace),
    (None, "--log"): ("`hz=numpy.geomspace(from_hz, to_hz, points)`", np.geomspace),
    (None, "--quantity"): ("`quantities=` of `Robot.map`, `Robot.sweep`", Robot.map),
    (None, "--form"): ("`state_space(…)` or `reduce(…)` of the equilibrium", Equilibrium.reduce),
    (None, "--matrices"): ("`model.save(path)`; `model.A`, …, `to_scipy()`, `to_control()`", funicular.StateSpaceModel.save),
    ("reduce", "--to"): ("`model.save(path)` with a path that ends in .fmu", funicular.StateSpaceModel.save),
    (None, "--figure-width-mm"): ("`width=` of `funicular.plot.bode`, `funicular.plot.map`, `funicular.plot.shape`", funicular.plot.bode),
    (None, "--font-size-pt"): ("`font_size_pt=` of these functions of `funicular.plot`", funicular.plot.bode),
    (None, "--figure-mode"): ("`mode=` of `funicular.plot.shape`, from 0", funicular.plot.shape),
    ("plot", "--quantity"): ("`column=` of `funicular.plot.map`", funicular.plot.map),
    (None, "--plane"): ("`plane=` of `funicular.plot.map`", funicular.plot.map),
    (None, "--at"): ("`at=` of `funicular.plot.map`", funicular.plot.map),
    ("map", "--format"): ("`rows.to_pandas()`, `rows.write(path)`", Sweep.write),
    ("sweep", "--format"): ("`rows.to_pandas()`, `rows.write(path)`", Sweep.write),
    ("map", "--output-file"): ("`file=` of `Robot.map`, `Robot.sweep`", Robot.map),
    ("sweep", "--output-file"): ("`file=` of `Robot.map`, `Robot.sweep`", Robot.sweep),
    ("merge", "--output-file"): ("`path=` of the call", funicular.merge),
    ("plot", "--output-file"): ("`path=` of the call", Sweep.plot),
    ("report", "--output-file"): ("`path=` of the call", Equilibrium.report),
    ("live", "--output-file"): ("`path=` of the call", Equilibrium.live),
    ("paper", "--output-file"): ("`path=` of the call", funicular.paper),
    ("export", "--output-file"): ("`path=` of the call", Equilibrium.export),
    ("new", "--output-file"): ("`new.write(path)`", funicular.NewRobot.write),
    ("schema", "--output-file"): ("`json.dumps(funicular.schema())`", funicular.schema),
    ("import", "--output-file"): ("`imported.write(path)`", funicular.Imported.write),
    ("request", "--samples-file"): ("`samples_file=` of `Robot.uncertainty`", Robot.uncertainty),
    ("request", "--format"): ("`json.dumps(result)`", funicular.run),
    ("request", "--output-file"): ("`json.dumps(result)`, `rows.write(path)`, `page.write(path)`", funicular.Page.write),
}


def equal(command: str, option: str) -> tuple[str, str] | None:
    """Python for an option, and the callable whose keyword it is (empty for other things); None if there is none."""
    for key in ((command, option), (None, option)):
        if key in OTHERS:
            return OTHERS[key][0], ""
    keyword = option.removeprefix("--").replace("-", "_")
    for called in COMMANDS[command][1]:
        if keyword in inspect.signature(called).parameters:
            # A method has the name of its class, a function that of the package.
            name = called.__qualname__ if "." in called.__qualname__ else f"funicular.{called.__name__}"
            # `Equilibrium` and `Robot` share the methods of `Analyses`.
            name = name.replace("Analyses.", "Equilibrium.")
            return f"`{keyword}=`", f"`{name}`"
    # Files of every command are keywords of `funicular.run`.
    outputs = [output for of, found in OUTPUTS.items() if command in ("request", of) for output in found]
    if any(output["key"] == keyword for output in outputs):
        return f"`{keyword}=`", "`funicular.run`"
    return None


def tables(executable: str) -> str:
    """Tables of the commands, and of the options with their commands."""
    lines = ["| Command | Python |", "|---|---|"]
    lines += [f"| `{command}` | {COMMANDS[command][0]} |" for command in commands.commands(executable)]
    rows: dict[tuple[str, str], tuple[list[str], dict[str, None]]] = {}
    for command in commands.commands(executable):
        for option in commands.options(executable, command):
            python, called = equal(command, option) or ("MISSING", "")
            names, callables = rows.setdefault((option, python), ([], {}))
            names.append(command)
            callables[called] = None
    lines += ["", "| Option | of | Python |", "|---|---|---|"]
    for (option, python), (names, callables) in sorted(rows.items()):
        of = ", ".join(filter(None, callables))
        lines.append(f"| `{option}` | {', '.join(names)} | {python}{f' of {of}' if of else ''} |")
    return "\n".join(lines) + "\n"


def test_every_command_is_in_python(executable: str) -> None:
    assert sorted(COMMANDS) == sorted(commands.commands(executable))


def test_every_option_is_in_python(executable: str) -> None:
    lacking = [
        f"{command} {option}"
        for command in commands.commands(executable)
        for option in commands.options(executable, command)
        if equal(command, option) is None
    ]
    assert lacking == []


def test_nothing_is_named_that_the_program_does_not_have(executable: str) -> None:
    there = {(command, option) for command in commands.commands(executable) for option in commands.options(executable, command)}
    for command, option in OTHERS:
        assert (command, option) in there or (command is None and any(option == name for _, name in there)), (command, option)


def test_what_replaces_an_option_takes_what_it_says() -> None:
    """A keyword of the text is one of the callable, and a call of the text calls it, with the arguments that it has."""
    for (command, option), (text, called) in OTHERS.items():
        taken = set(inspect.signature(called).parameters)
        named = set(re.findall(r"`(\w+)=`", text))
        calls = re.findall(r"(\w+)\(([^)]*)\)", text)
        assert named <= taken, (command, option)
        assert called is not funicular.run or command == "request", (command, option)
        for name, arguments in calls:
            if name == called.__name__ and "path" in [argument.strip() for argument in arguments.split(",")]:
                assert "path" in taken, (command, option)
        parts = {name for name, _ in calls} - {"dumps", "to_pandas"}
        assert not parts or called.__name__ in parts, (command, option)


def test_the_tables_of_the_document_are_those_of_the_program_and_the_package(executable: str) -> None:
    begin, end = "<!-- commands and options: begin -->\n", "<!-- commands and options: end -->"
    before, rest = DOCUMENT.read_text().split(begin)
    written, after = rest.split(end)
    made = f"\n{tables(executable)}\n"
    if os.environ.get("UPDATE_DOCS"):
        DOCUMENT.write_text(f"{before}{begin}{made}{end}{after}")
        return
    assert written == made


def test_a_command_without_a_keyword_is_found(executable: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(COMMANDS, "reduce", ("", [Robot.equilibrium]))
    assert equal("reduce", "--damping-at-hz") is None and "MISSING" in tables(executable)
