"""Attributes of results have the names of the program's JSON; attributes of earlier versions name the present ones."""

from typing import Any

import funicular
import numpy as np
import pytest
from conftest import ROBOTS, Program
from funicular import _earlier_names

ROBOT = "yuan2014-4mm.toml"

# Attributes whose name is no key of the program's JSON, with the reason.
EXCEPTIONS: dict[str, dict[str, str]] = {
    "Robot": {
        "cable_names": "the key `cable_names` of `modes`; `check` has the key `name` of each cable",
        "lengths_m": "the key of requests and the keyword of `Robot.equilibrium`; `check` has `unstrained_length_m`",
    },
    "Equilibrium": {
        "robot": "the robot as an object; its name stands in the key `robot`",
        "unique_centre": "the key `unique` of `centre`",
        "held_pose": "the key `pose` of `held`",
        "support_displacement_m": "`displacement_m` of `supports`, as one array",
    },
    "Equilibria": {
        "status": "the key of rows of `map` and `sweep`",
        "reason": "the key of rows of `map` and `sweep`",
        "ok": "True where `status` is `ok`",
    },
    "Modes": {
        "robot": "the name of the robot, which `statics` has as the key `robot`",
        "first_platform_index": "the key `index` of `first_platform_mode`",
        "drive_energy_fractions": "a key for robots with inertia in their drives; here zeros",
        "cable_axes": "`axes` of `stations`, as one array",
        "station_arc_length_m": "`arc_length_m` of `stations`, as one array",
        "station_position_m": "`position_m` of `stations`, as one array",
        "found": "the whole dictionary",
    },
}


def keys(found: Any) -> set[str]:
    """Keys of a result and of everything in it."""
    if isinstance(found, dict):
        return set(found) | {key for value in found.values() for key in keys(value)}
    return {key for value in found for key in keys(value)} if isinstance(found, list) else set()


def attributes(of: Any) -> list[str]:
    """Public attributes that are values: no methods."""
    return [name for name in dir(of) if not name.startswith("_") and not callable(getattr(of, name))]


@pytest.fixture(scope="module")
def results(program: Program, tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Any, set[str]]]:
    """Per class an object, and the keys of the commands whose results it holds."""
    path = ROBOTS / ROBOT
    robot = funicular.Robot.from_file(path)

    # Redundantly constrained robots have the key of the rule, under-constrained robots that of the nearest pose.
    statics = keys(program("statics", path)) | keys(program("statics", ROBOTS / "cogiro.toml", "--pose", "1,2,1.5"))
    cogiro = funicular.Robot.from_file(ROBOTS / "cogiro.toml").to_dict()
    four = funicular.Robot.from_dict({**cogiro, "cables": cogiro["cables"][::2]})
    file = tmp_path_factory.mktemp("four") / "four.toml"
    file.write_text(four.to_toml())
    pose = ",".join(map(repr, four.equilibrium().pose.to_array().tolist()))
    statics |= keys(program("statics", file, f"--pose={pose}"))

    # Robots with pulleys have the keys of their drives.
    wheel = {"radius_m": 0.05, "entry_direction": [0.0, 0.0, 1.0]}
    cables = [{**cable, "pulley": "wheel", "support": "post"} for cable in cogiro["cables"]]
    post = {"stiffness_n_per_m": 1e6, "mass_kg": 20.0}
    tables = {"pulleys": {"wheel": wheel}, "supports": {"post": post}}
    driven = funicular.Robot.from_dict({**cogiro, **tables, "cables": cables})
    file.write_text(driven.to_toml())
    statics |= keys(program("statics", file, "--pose", "1,2,1.5"))

    # Cables that all end at one point leave the platform free to turn.
    point = [{**cable, "attachment_m": [0.0, 0.0, 0.0]} for cable in cogiro["cables"]]
    camera = file.with_name("camera.toml")
    hung = {**cogiro["platform"], "center_of_mass_m": [0.0, 0.0, 0.0]}
    camera.write_text(funicular.Robot.from_dict({**cogiro, "platform": hung, "cables": point}).to_toml())
    statics |= keys(program("statics", camera, "--pose", "1,2,1.5"))

    response = ["--input", "fz", "--output", "az", "--stations", 3]
    return {
        "Robot": (robot, keys(program("check", path))),
        "Equilibrium": (robot.equilibrium(), statics),
        "Equilibria": (robot.equilibria(poses=[[0, 0, 0.5]]), statics),
        "Modes": (
            robot.modes(2, input="fz", output="az", stations=3),
            keys(program("modes", path, "--below-hz", 2, *response))
            | keys(program("modes", file, "--pose", "1,2,1.5", "--below-hz", 3)),
        ),
    }


@pytest.mark.parametrize("name", EXCEPTIONS)
def test_attributes_have_the_names_of_the_programs_json(name: str, results: dict[str, tuple[Any, set[str]]]) -> None:
    of, known = results[name]
    found = attributes(of)
    assert len(found) > 5 and set(EXCEPTIONS[name]) <= set(found), "an exception is no attribute any more"
    assert [attribute for attribute in found if attribute not in known | set(EXCEPTIONS[name])] == []


def test_an_exception_is_no_key(results: dict[str, tuple[Any, set[str]]]) -> None:
    """An exception that has become a key has to go from the list; `robot` is a key with another meaning."""
    for name, (_, known) in results.items():
        assert not known & set(EXCEPTIONS[name]) - {"robot"}, name


def test_an_attribute_has_the_value_of_its_key(results: dict[str, tuple[Any, set[str]]]) -> None:
    rest, states = results["Equilibrium"][0], results["Equilibria"][0]
    again = rest.robot.equilibrium(pose=[0, 0, 0.5])
    rows = {key: np.array([cable[key] for cable in again.to_dict()["cables"]]) for key in again.to_dict()["cables"][0]}
    for key in ("unstrained_length_m", "tension_platform_n", "tension_anchor_n", "sag_ratio"):
        assert np.array_equal(getattr(states, key)[0], rows[key]), key
        assert np.array_equal(getattr(again, key), rows[key]), key
    for key in ("force_on_platform_n", "chord_m", "lambda2", "string_frequency_hz"):
        assert np.array_equal(getattr(again, key), rows[key]), key
    assert states.static_model == again.static_model == again.to_dict()["static_model"]

    robot, read = rest.robot, rest.robot.check()
    keys_of = {"anchor_m": "anchor_m", "attachment_m": "attachment_m", "lengths_m": "unstrained_length_m"}
    for attribute, key in keys_of.items():
        assert np.array_equal(getattr(robot, attribute), [cable[key] for cable in read["cables"]]), attribute


@pytest.mark.parametrize("name", ["Robot", "Equilibrium", "Equilibria"])
def test_an_earlier_name_names_the_present_one(name: str, results: dict[str, tuple[Any, set[str]]]) -> None:
    of, _ = results[name]
    earlier = _earlier_names.EARLIER_NAMES[getattr(funicular, name)]
    assert "lengths" in earlier
    for before, present in earlier.items():
        assert hasattr(of, present) and not hasattr(of, before)
        message = f"'{name}' object has no attribute '{before}': it is now called '{present}'"
        with pytest.raises(AttributeError, match=message):
            getattr(of, before)
    with pytest.raises(AttributeError, match=f"^'{name}' object has no attribute 'tensionz'$") as error:
        of.tensionz
    assert error.value.name == "tensionz" and error.value.obj is of
