"""Numbers out of their range, and values behind the first level, are refused alike by methods, requests and the program."""

import json
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import funicular
import numpy as np
import pytest
from funicular import InputError
from funicular._declared import COMMANDS

MOVE = {"move_to": [0.1, 0, 0.5, 0, 0, 0], "speed_m_s": 1.0}
# Keys that the keys of a command need besides.
LENGTHS = {f"length_{i}_m": [6.8, 6.9, 6.7] for i in range(1, 7)}
BESIDE: dict[str, dict[str, Any]] = {
    "trajectory": MOVE,
    "pose-error": {"mass_kg": (10, 20, 3)},
    "design": {"change": {"platform.mass_kg": [5, 20]}},
    "calibrate": {"readings": LENGTHS},
    "estimate": {"log": {"t_s": [0.0, 0.01], **{name: values[:2] for name, values in LENGTHS.items()}}},
    "reduce": {"below_hz": 5},
    "identify": {"fit": [{"path": "platform.mass_kg"}], "experiments": [{"frequencies": [{"frequency_hz": 1.2}]}]},
}


def numeric(command: str) -> list[str]:
    return [key["name"] for key in COMMANDS[command] if key["type"] == "SupportsFloat | SupportsIndex" and not key["required"]]


@pytest.mark.parametrize("command", ["simulate", "trajectory", "pose-error", "statics", "modes", "settle", "gust", "loads", "design", "calibrate", "estimate", "uncertainty", "workspace", "prove", "reduce", "frf", "identify"])
def test_a_number_out_of_its_range_is_refused_before_any_work(robot: funicular.Robot, command: str) -> None:
    tried = 0
    beside = BESIDE.get(command, {})
    # The whole request, as one that is not refused writes it.
    whole = funicular.Robot.request(robot, command, **beside)
    for key in numeric(command):
        for value in (-1e13, 1e13, -1.0):
            try:
                funicular.Robot.request(robot, command, **{**beside, key: value})
            except InputError as error:
                assert f"`{key}`" in str(error), error
                with pytest.raises(InputError, match=f"`{key}`"):
                    funicular.run(json.dumps({**whole, key: value}))
                tried += 1
    assert tried >= 2


def test_a_negative_acceleration_is_no_motion(robot: funicular.Robot) -> None:
    with pytest.raises(InputError, match="`acceleration_m_s2`: -1 is not positive"):
        robot.trajectory(**MOVE, acceleration_m_s2=-1)
    with pytest.raises(InputError, match="`duration_s`: -1 is not positive"):
        robot.simulate(None, -1, once=True)
    with pytest.raises(InputError, match="`find_way` means nothing without `move_to`"):
        robot.clearance(find_way=True)


SCENARIOS: list[tuple[Any, str]] = [
    ({"release": {"at_s": 0, "mass_kg": 1}}, "`release`: a mapping is no answer: give a list of events"),
    ({"relaese": []}, "did you mean `release`"),
    ({"release": [{"at_s": 0, "mass": 1}]}, r"\[\[release\]\] number 1: there is no key `mass`; did you mean `mass_kg`"),
    ({"release": [{"mass_kg": 1}]}, r"\[\[release\]\] number 1: it has no `at_s`"),
    ({"release": [{"at_s": "0", "mass_kg": 1}]}, "`at_s`: the text"),
    ({"push": [{"at_s": 0, "duration_s": 1, "force_n": 5}]}, "`force_n`: `5` is no answer: give a list of 3 numbers"),
    ({"tension": [{"at_s": 0, "duration_s": 1, "tension_n": [5]}]}, "names of cables to numbers"),
    ({"stop": [{"at_s": 0, "duration_s": 1, "cables": "1"}]}, "`cables`: the text \"1\" is no answer: give a list of texts"),
    ({"lengths": [{"at_s": 0, "table": {"t_s": [0, 1], "x_m": ["a", 1]}}]}, "column `x_m`, row 1: the text"),
    ([1], "a mapping from kinds of events to lists of events"),
]


@pytest.mark.parametrize(("scenario", "says"), SCENARIOS)
def test_an_odd_scenario_is_told_with_event_and_key(robot: funicular.Robot, scenario: Any, says: str) -> None:
    with pytest.raises(InputError, match=says) as error:
        robot.simulate(scenario, 0.01, once=True)
    assert not any(word in str(error.value) for word in ("field", "expected", "invalid type", "sequence"))


def test_tables_of_events_are_those_of_trajectories(robot: funicular.Robot, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    lengths = robot.equilibrium().unstrained_length_m
    columns = {"t_s": [0.0, 0.05], **{f"unstrained_length_{i + 1}_m": [length, length] for i, length in enumerate(lengths)}}
    frame = pandas.DataFrame(columns)
    path = tmp_path / "lengths.csv"
    frame.to_csv(path)
    settings: dict[str, Any] = {"once": True, "elements": 1, "degree": 4, "sample_time_s": 0.01}
    found = [robot.simulate({"lengths": [{"at_s": 0.0, "table": table}]}, 0.05, **settings) for table in (columns, frame, path)]
    assert found[0] == found[1] == found[2]


def test_values_of_a_function_are_read_as_arguments(robot: funicular.Robot) -> None:
    def path(value: Any) -> Callable[[float], list[Any]]:
        return lambda t: [value if t > 0 else 0.0, 0.0, 0.5]

    for value in ("0.1", True, float("nan"), {"x": 1}):
        with pytest.raises(InputError, match="path"):
            robot.trajectory(path(value), duration_s=1.0, sample_time_s=0.5)

    def lengths(t: float) -> dict[str, Any]:
        return {"x_m": "0.1" if t > 0 else 0.0, "y_m": 0.0, "z_m": 0.5}

    with pytest.raises(InputError, match=r"scenario.lengths\[0\].table: lengths\(0.01\)"):
        robot.simulate({"lengths": [{"at_s": 0, "duration_s": 1.0, "table": lengths}]}, 2.0)
    for duration in ({}, "1", float("nan"), True):
        with pytest.raises(InputError, match=r"scenario.lengths\[0\].duration_s"):
            robot.simulate({"lengths": [{"at_s": 0, "duration_s": duration, "table": lengths}]}, 2.0)
    found = robot.trajectory(lambda t: [0.01 * t, 0.0, 0.5], duration_s=np.float32(0.5), sample_time_s=0.25)
    assert len(found["rows"]) == 3


def test_files_are_tried_before_the_work(robot: funicular.Robot, tmp_path: Path) -> None:
    called: list[int] = []
    with pytest.raises(funicular.FileError, match="there is no directory"):
        robot.simulate({}, 20, once=True, page=tmp_path / "no" / "a.html", progress=lambda done, rows: called.append(done))
    with pytest.raises(funicular.FileError):
        robot.trajectory(**MOVE, acceleration_m_s2=1, page=tmp_path)
    assert not called and not list(tmp_path.iterdir())


def test_an_exception_of_a_handler_ends_a_simulation_and_carries_its_rows(robot: funicular.Robot) -> None:
    def raised(*_: object) -> None:
        raise TimeoutError("too long")

    before = signal.signal(signal.SIGALRM, raised)
    try:
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        with pytest.raises(TimeoutError, match="too long") as error:
            robot.simulate({"release": [{"at_s": 0.0, "mass_kg": 1.0}]}, 300, once=True, sample_time_s=0.01)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    part = error.value.partial_results
    assert isinstance(part, funicular.Results) and part["rows"] and part["stopped_at_s"] < 300


def test_a_workspace_that_is_stopped_keeps_what_was_found(cogiro: funicular.Robot) -> None:
    import os

    # The first surface asks 105 positions, the second 585, the third 1965.
    grid: dict[str, Any] = {"grid": {"x": (-6, 6, 49), "y": (-4, 4, 33), "z": (0.5, 4.5, 17)}, "threads": 1}

    def told(done: int, total: int) -> None:
        if done > 2000:
            raise TimeoutError("too long")

    with pytest.raises(TimeoutError, match="too long") as error:
        cogiro.workspace(progress=told, **grid)
    part = error.value.partial_results
    assert isinstance(part, funicular.Results) and part["complete"] is False and part["volumes"][-1]["volume_m3"] > 0

    # Stopped before the first surface, the exception says how far the search was.
    def at_once(done: int, total: int) -> None:
        raise TimeoutError("too long")

    with pytest.raises(TimeoutError) as early:
        cogiro.workspace(progress=at_once, **grid)
    assert not hasattr(early.value, "partial_results") and "too few for a surface" in early.value.__notes__[0]

    def interrupted(done: int, total: int) -> None:
        if done > 2000 and not sent:
            sent.append(done)
            os.kill(os.getpid(), signal.SIGINT)

    sent: list[int] = []
    with pytest.raises(KeyboardInterrupt) as stopped:
        cogiro.workspace(progress=interrupted, **grid)
    assert stopped.value.partial_results["volumes"]


def test_results_compare_by_values_and_survive_pickles(cogiro: funicular.Robot) -> None:
    import copy
    import pickle

    at = {"pose": [1, 2, 1.5]}
    for compute in (lambda: cogiro.loads(**at), lambda: cogiro.payload(**at), lambda: cogiro.clearance(**at), lambda: cogiro.equilibrium(**at).settle([0, 0, 10])):
        one, other = compute(), compute()
        assert one == other and not one != other
        assert pickle.loads(pickle.dumps(one)) == one and copy.deepcopy(one) == one
        changed = copy.deepcopy(one)
        changed["robot"] = "another"
        assert changed != one and one != 3


def test_a_dictionary_has_the_table_of_the_program(robot: funicular.Robot, program: Any) -> None:
    pytest.importorskip("pandas")
    settings: dict[str, Any] = {"once": True, "elements": 1, "degree": 4, "sample_time_s": 0.01}
    found = robot.simulate({"release": [{"at_s": 0.0, "mass_kg": 1.0}]}, 0.05, **settings)
    table = found.to_pandas()
    assert len(table) == len(found["rows"]) == 6
    assert table["z_m"].tolist() == [row["position_m"][2] for row in found["rows"]]
    assert table.attrs["units"]["z_m"] == "m"


def leaves(value: Any) -> list[float]:
    """Numbers of JSON."""
    if isinstance(value, dict):
        return [number for key, of in value.items() if key not in ("schema",) for number in leaves(of)]
    if isinstance(value, (list, tuple, np.ndarray)):
        return [number for of in value for number in leaves(of)]
    if isinstance(value, (complex, np.complexfloating)):
        return [value.real, value.imag]
    return [float(value)] if isinstance(value, (int, float, np.number)) and not isinstance(value, (bool, np.bool_)) else []


def test_every_number_of_a_result_is_in_its_dataset_or_named(robot: funicular.Robot, cogiro: funicular.Robot) -> None:
    import warnings

    pytest.importorskip("xarray")
    rest, at = robot.equilibrium(), {"pose": [1, 2, 1.5]}
    settings: dict[str, Any] = {"once": True, "elements": 1, "degree": 4, "sample_time_s": 0.01}
    every = [
        rest.cable("1", [1, 2, 3]),
        rest.settle([0, 0, 10]),
        rest.compare(below_hz=2),
        rest.gradient(of=["frequencies"], below_hz=1.5),
        cogiro.loads(**at),
        cogiro.payload(**at),
        cogiro.clearance(**at),
        cogiro.trajectory(pose=[1, 2, 1.5], move_to=[1.2, 2, 1.5, 0, 0, 0], speed_m_s=1, acceleration_m_s2=1, jerk_m_s3=10),
        robot.simulate({"release": [{"at_s": 0.0, "mass_kg": 1.0}]}, 0.05, **settings),
        robot.pose_error((10, 20, 3)),
        *(funicular.run(robot.request(command, **more)) for command, more in [
            ("check", {}), ("parameters", {}), ("statics", {}), ("stiffness", {}), ("modes", {"below_hz": 1.5}),
            ("frf", {"from_hz": 1, "to_hz": 2, "points": 5, "input": ["fz", "fx"]}),
        ]),
    ]  # fmt: skip
    for found in every:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            of = found.to_xarray()
        told = "".join(str(one.message) for one in caught)
        kept: list[float] = []
        for name in [*of.variables, *of.coords]:
            values = np.asarray(of[name].values)
            if values.dtype.kind in "iufb":
                kept += values.ravel().astype(float).tolist()
            elif values.dtype.kind == "U":
                kept += [float(text) for text in values.ravel().tolist() if text.replace(".", "").replace("-", "").replace("e", "").isdigit()]
        kept += [float(value) for value in of.attrs.values() if isinstance(value, (int, float))]
        wanted = {number for number in leaves(dict(found)) if np.isfinite(number)}
        missing = wanted - set(kept)
        assert not missing or "leaves out" in told, (found.get("command"), sorted(missing)[:5])
        assert not found.get("rows") or len(of.data_vars) > 5 or found["command"] == "parameters"


def test_rows_over_time_have_dimensions_with_labels_and_units(robot: funicular.Robot) -> None:
    pytest.importorskip("xarray")
    settings: dict[str, Any] = {"once": True, "elements": 1, "degree": 4, "sample_time_s": 0.01}
    found = robot.simulate({"release": [{"at_s": 0.0, "mass_kg": 1.0}]}, 0.05, **settings)
    of = found.to_xarray()
    assert of["tensions_platform_n"].dims == ("time", "cable") and of["tensions_platform_n"].attrs["units"] == "N"
    assert of["tensions_platform_n"].sel(cable="3").values.tolist() == [row["tensions_platform_n"][2] for row in found["rows"]]
    assert of["position_m"].dims == ("time", "axis") and of["position_m"].sel(axis="z").shape == (6,)
    assert of["time"].attrs["units"] == "s" and np.allclose(of["time"], np.linspace(0, 0.05, 6))
