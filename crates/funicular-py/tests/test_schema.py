"""The JSON Schema of the robot file accepts robot files and refuses mistakes, by the validator of another project."""

import json
import pickle
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import funicular
import funicular.results
import pytest
from conftest import ROBOT_FILES, ROBOTS, ROOT
from jsonschema import Draft7Validator, Draft202012Validator


@pytest.fixture(scope="module")
def validator() -> Draft7Validator:
    schema = funicular.schema()
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


@pytest.mark.parametrize("name", ROBOT_FILES)
def test_every_robot_of_the_library_is_valid(validator: Draft7Validator, name: str) -> None:
    assert [error.message for error in validator.iter_errors(tomllib.loads((ROBOTS / name).read_text()))] == []


@pytest.mark.parametrize("motion", ["rigid", "point-mass", "planar-xz"])
def test_a_new_robot_is_valid(validator: Draft7Validator, motion: str) -> None:
    assert list(validator.iter_errors(tomllib.loads(funicular.new_robot(motion=motion).text))) == []


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("mass_kg = 100.0", "mas_kg = 100.0", "'mas_kg' was unexpected"),
        ("[platform]", "[platfrom]", "'platfrom' was unexpected"),
        ("mass_kg = 100.0", "mass_kg = 0.0", "less than the minimum"),
        ("mass_kg = 100.0", 'mass_kg = "100"', "is not of type 'number'"),
        ("mass_kg = 100.0", "", "'mass_kg' is a required property"),
        ('motion = "rigid"', 'motion = "rigit"', "is not one of"),
        ('name = "1"', 'name = " "', "does not match"),
        ("position_m = [0.0, 0.0, 2.4]", "position_m = [0.0, 0.0]", "is too short"),
        ("damping_ratio = 0.003", "damping_ratio = 0.5", "greater than or equal to the maximum"),
        ("inertia_kg_m2 = [", "inertia_kg_m2 = [0.5, ", "is not valid under any of the given schemas"),
    ],
)
def test_a_mistake_is_refused_by_schema_and_program(validator: Draft7Validator, old: str, new: str, says: str) -> None:
    text = funicular.new_robot().text
    assert old in text
    wrong = text.replace(old, new, 1)
    data: dict[str, Any] = tomllib.loads(wrong)
    assert any(says in error.message for error in validator.iter_errors(data)), [e.message for e in validator.iter_errors(data)]
    with pytest.raises(funicular.RobotFileError):
        funicular.Robot.from_toml(wrong)


@pytest.mark.parametrize(
    "request_of",
    [
        {"command": "check"},
        {"command": "statics"},
        {"command": "modes", "below_hz": 2.0, "stations": 3},
        {"command": "frf", "from_hz": 0.0, "to_hz": 2.0, "points": 5, "input": "fz", "output": ["z", "tension:1"]},
        {"command": "settle", "release_n": [0.0, 0.0, 10.0], "below_hz": 2.0},
        {"command": "settle", "stop_m_s": [0.1, 0.0, 0.0], "below_hz": 2.0},
        {"command": "trajectory", "move_to": [0.0, 0.1, 0.5], "duration_s": 4.0, "course": "quintic"},
        {"command": "speeds"},
        {"command": "reduce", "below_hz": 2.0, "input": ["fz"], "output": ["z"]},
    ],
    ids=lambda of: of["command"],
)
def test_results_are_valid_by_their_schema_and_a_change_is_not(request_of: dict[str, Any], robot: funicular.Robot) -> None:
    schema = funicular.schema("results")
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator({"$defs": schema["$defs"], "$ref": f"#/$defs/{request_of['command']}"})
    request = robot.request(request_of["command"], **{key: value for key, value in request_of.items() if key != "command"})
    found = json.loads(funicular._funicular.answer(json.dumps(request)))
    assert [error.message for error in validator.iter_errors(found)] == []
    assert not validator.is_valid({**found, "foreign": 1})


def test_the_classes_of_results_are_those_of_the_declarations() -> None:
    script = ROOT / "scripts" / "python_results.py"
    made = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True).stdout
    assert made == Path(funicular.results.__file__).read_text(), "run UPDATE_STUBS=1 scripts/test-python"


def test_keys_of_results_are_attributes_with_the_types_of_their_class(robot: funicular.Robot) -> None:
    found = robot.equilibrium().settle(release_n=[0, 0, 10], below_hz=2)
    assert type(found) is funicular.results.SettleResults and isinstance(found, funicular.Results)
    assert found.modes is found["modes"] and type(found.modes[0]) is funicular.results.SettlingMode
    assert found.modes[0].frequency_hz == found["modes"][0]["frequency_hz"]
    assert found.shaping is None and "shaping" not in found
    with pytest.raises(AttributeError, match="SettleResults has no key `mods`.*modes"):
        _ = found.mods  # type: ignore[attr-defined]
    again = pickle.loads(pickle.dumps(found.modes[0]))
    assert type(again) is type(found.modes[0]) and again == found.modes[0] == dict(found.modes[0])
    assert funicular.run(robot.request("loads")).closure in (True, False)
