"""Robots, poses and results as Python objects: errors, equality, copies, pickles, tables."""

import copy
import pickle
from pathlib import Path
from typing import Any

import funicular
import numpy as np
import pytest
from conftest import ROBOT_FILES, ROBOTS

ALL = ROBOT_FILES


@pytest.mark.parametrize("name", ALL)
def test_a_robot_comes_back_from_its_text_its_dictionary_and_its_pickle(name: str) -> None:
    robot = funicular.Robot.from_file(ROBOTS / name)
    assert robot.to_toml() == (ROBOTS / name).read_text()
    for again in (
        funicular.Robot.from_toml(robot.to_toml()),
        funicular.Robot.from_dict(robot.to_dict()),
        pickle.loads(pickle.dumps(robot)),
        copy.copy(robot),
        copy.deepcopy(robot),
    ):
        assert again == robot and hash(again) == hash(robot)
        assert again.equilibrium() == robot.equilibrium()
    assert robot.with_(mass_kg=robot.mass_kg * 2) != robot and robot != robot.name


@pytest.mark.parametrize(
    "keywords",
    [
        {},
        {"pose": [1, 2, 1.5, 0, 3, 10]},
        {"pose": funicular.Pose([1, 2, 1.5], quaternion_wxyz=[0.6, 0, 0, 0.8]), "tension_rule": "middle", "max_tension_n": 4000},
        {"pose": [1, 2, 1.5], "target_tension_n": 900.0, "min_tension_n": 10, "static_model": "spring"},
        {"pose": [1, 2, 1.5], "force_n": [10, 0, -20], "moment_n_m": [0, 1, 0], "load_point_m": [0, 0, 0.1]},
    ],
)
def test_an_equilibrium_comes_back_from_its_pickle_and_its_copy(keywords: dict[str, Any], cogiro: funicular.Robot) -> None:
    try:
        rest = cogiro.equilibrium(**keywords)
    except funicular.StaticsError:
        pytest.fail("the case has to have an equilibrium")
    for again in (pickle.loads(pickle.dumps(rest)), copy.copy(rest), copy.deepcopy(rest)):
        assert again == rest and hash(again) == hash(rest)
        assert again.tension_platform_n.tobytes() == rest.tension_platform_n.tobytes() and again.robot == cogiro
        assert again.to_dict() == rest.to_dict()
    assert rest != cogiro.equilibrium(pose=[1, 2, 1.4])


def test_results_of_columns_come_back_too(robot: funicular.Robot) -> None:
    modes, states = robot.modes(5), robot.equilibria(poses=[[0, 0, 0.5], [0, 0, 50]])
    for result in (modes, states):
        for again in (pickle.loads(pickle.dumps(result)), copy.copy(result), copy.deepcopy(result)):
            assert again == result
    assert modes != robot.modes(5, damped=False) and modes != robot.modes(4) and states != modes
    assert len(modes) == modes.count_below == len(modes.to_pandas())


def test_the_cable_and_the_pose_come_back_bit_for_bit() -> None:
    cable = funicular.Catenary(4, -1, unstrained_length_m=4.5, weight_n_per_m=0.6, axial_stiffness_n=1e5)
    assert pickle.loads(pickle.dumps(cable)) == cable == copy.deepcopy(cable)
    for angles in np.random.default_rng(0).uniform(-180, 180, (200, 3)):
        pose = funicular.Pose([1, 2, 3], angles)
        again = pickle.loads(pickle.dumps(pose))
        assert again == pose and hash(again) == hash(pose)
        assert again.quaternion_wxyz.tobytes() == pose.quaternion_wxyz.tobytes()


def test_a_pose_is_the_same_in_all_its_forms() -> None:
    pose = funicular.Pose([1, 2, 3], [10, 20, 30])
    roll, pitch, yaw = np.radians([10, 20, 30])
    x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    y = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    z = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    assert np.allclose(pose.rotation, z @ y @ x, atol=1e-15)
    assert np.allclose(pose.matrix, np.vstack([np.c_[z @ y @ x, [1, 2, 3]], [0, 0, 0, 1]]), atol=1e-15)
    assert np.allclose(pose.to_array(), [1, 2, 3, 10, 20, 30], atol=1e-13)
    assert funicular.Pose([1, 2, 3], quaternion_wxyz=pose.quaternion_wxyz) == pose


def test_forces_of_the_cables_carry_the_platform(rest: funicular.Equilibrium) -> None:
    assert np.allclose(rest.force_on_platform_n.sum(axis=0), [0, 0, 10.55 * 9.81], atol=1e-9)
    assert np.allclose(np.linalg.norm(rest.force_on_platform_n, axis=1), rest.tension_platform_n, rtol=1e-13)
    ends = rest.cable_points(2)
    assert np.allclose(ends[:, 1], rest.robot.anchor_m, atol=1e-12)
    assert np.allclose(ends[:, 0], rest.pose.position_m + rest.robot.attachment_m @ rest.pose.rotation.T, atol=1e-12)


def test_stiffness_is_the_slope_of_the_force(robot: funicular.Robot, rest: funicular.Equilibrium) -> None:
    step, push = 1e-5, 1e-2
    stiffness = rest.stiffness()
    moved = robot.equilibrium(lengths_m=rest.unstrained_length_m, force_n=[0, 0, push])
    expected = np.linalg.solve(stiffness, [0, 0, push, 0, 0, 0])[:3]
    assert np.allclose(moved.pose.position_m - rest.pose.position_m, expected, rtol=1e-3, atol=step * 1e-4)


def test_the_hanging_cable_is_a_catenary() -> None:
    """A cable that hardly stretches has the tension H cosh(w x/H), with x from its lowest point."""
    weight, half, horizontal = 2.0, 5.0, 7.0
    length = 2 * horizontal / weight * np.sinh(weight * half / horizontal)
    cable = funicular.Catenary(2 * half, 0, unstrained_length_m=length, weight_n_per_m=weight, axial_stiffness_n=1e11)
    assert cable.horizontal_force_n == pytest.approx(horizontal, rel=1e-9)
    assert cable.tension_start_n == pytest.approx(horizontal * np.cosh(weight * half / horizontal), rel=1e-9)
    lowest = cable.points_m([length / 2])[0]
    assert lowest[1] == pytest.approx(horizontal / weight * (1 - np.cosh(weight * half / horizontal)), rel=1e-9)


@pytest.mark.parametrize(
    ("of", "arguments", "keywords", "said"),
    [
        ("equilibrium", (), {"pose": [0, 0]}, "2 numbers"),
        ("equilibrium", (), {"pose": [0, 0, np.nan]}, "finite"),
        ("equilibrium", (), {"pose": [0, 0, 1, 2, 0, 0, 0]}, "norm 2"),
        ("equilibrium", (), {"pose": [0, 0, 1], "lengths_m": [1] * 6}, "not both"),
        ("equilibrium", (), {"static_model": "katenary"}, "did you mean `catenary`"),
        ("equilibrium", (), {"pose": [0, 0, 1], "tension_rule": "closest"}, "target_tension_n"),
        ("equilibrium", (), {"min_tension_n": 5, "max_tension_n": 4}, "below `max_tension_n`"),
        ("equilibrium", (), {"load_point_m": [0, 0, 1]}, "force_n"),
        ("equilibrium", (), {"force_n": [0, 1]}, "x, y, z"),
        ("modes", (0,), {}, "positive"),
        ("modes", (1e9,), {"cable_model": "shallow-dynamic"}, "lower the limit"),
        ("modes", (5,), {"cable_model": "catenary-dynamik"}, "did you mean `catenary-dynamic`"),
        ("modes", (5,), {"assembly": "whole"}, "`consistent`, `without-geometric-stiffness`"),
        ("frf", ([1, 2], "fz", "fz"), {}, "not an output"),
        ("frf", ([1, 2], "z", "z"), {}, "not an input"),
        ("frf", ([1, 2], "cable:9@0.5:fz", "z"), {}, 'no cable "9"'),
        ("frf", ([1, 2], "mz", "z"), {"input_point_m": [0, 0, 1]}, "same at every point"),
        ("frf", ([-1, 2], "fz", "z"), {}, "is negative"),
        ("frf", ([[1, 2]], "fz", "z"), {}, "2 dimensions"),
        ("stiffness", (np.inf,), {}, "finite"),
    ],
)
def test_arguments_that_mean_nothing_are_refused(
    of: str, arguments: tuple[Any, ...], keywords: dict[str, Any], said: str, robot: funicular.Robot
) -> None:
    with pytest.raises(funicular.InputError, match=said) as error:
        getattr(robot, of)(*arguments, **keywords)
    assert isinstance(error.value, (funicular.Error, ValueError))
    assert str(pickle.loads(pickle.dumps(error.value))) == str(error.value)


@pytest.mark.parametrize("value", [np.inf, np.nan, complex(0, -np.inf), complex(1.7e308, 1.7e308)])
def test_peaks_are_of_finite_responses(value: complex) -> None:
    with pytest.raises(funicular.InputError, match="`response` is .* at 2 Hz: it must be finite"):
        funicular.peaks([1, 2, 3], [1, value, 1])


def test_what_has_no_answer_has_its_own_error(robot: funicular.Robot) -> None:
    with pytest.raises(funicular.StaticsError) as statics:
        robot.equilibrium(pose=[0, 0, 5])
    again = pickle.loads(pickle.dumps(statics.value))
    assert again.code == statics.value.code == "negative-tension" and str(again) == str(statics.value)
    with pytest.raises(funicular.StaticsError, match="nothing to choose"):
        robot.equilibrium(pose=[0, 0, 0.5], tension_rule="lowest")
    with pytest.raises(funicular.DynamicsError, match="rigid"):
        robot.equilibrium(pose=[0, 0, 0.5], static_model="ideal").stiffness()
    undamped = robot.with_({"materials.rope-4mm.damping_ratio": 0.0})
    with pytest.raises(funicular.DynamicsError, match="end of a cable only"):
        undamped.frf([1.0], "fz", "cable:1@0.5:z", cable_model="shallow-dynamic")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"platfrom.mass_kg": 3}, "did you mean `platform.mass_kg`"),
        ({"platform.mass_kg": -3}, "must be positive"),
        ({"platform.mass_kg": [1, 2]}, "mass_kg"),
        ({"platform": 3}, "names a table"),
        ({"cables.9.anchor_m": [0, 0, 1]}, 'no cable "9"'),
        ({"platform.mass_kg": object()}, "of type object"),
        ({"platform.mass_kg": float("nan")}, "must be finite"),
        ({"platform.mass_kg": 1 << 80}, "so large"),
    ],
)
def test_changes_that_cannot_be_made_are_refused(changes: dict[str, Any], said: str, robot: funicular.Robot) -> None:
    with pytest.raises(funicular.RobotFileError, match=said):
        robot.with_(changes)


def test_what_holds_itself_is_refused(robot: funicular.Robot) -> None:
    endless: list[Any] = []
    endless.append(endless)
    with pytest.raises(funicular.RobotFileError, match="deep"):
        robot.with_({"platform.mass_kg": endless})
    table: dict[str, Any] = {}
    table["platform"] = table
    with pytest.raises(funicular.RobotFileError, match="deep"):
        funicular.Robot.from_dict(table)


def test_a_maximum_above_the_breaking_load_is_refused(cogiro: funicular.Robot) -> None:
    said = "maximum tension 12000 N is above the breaking load 10000 N .* give `max_tension_n` of at most 10000"
    with pytest.raises(funicular.InputError, match=said):
        cogiro.equilibrium(pose=[1, 2, 1.5], max_tension_n=12000)
    with pytest.raises(funicular.InputError, match=said):
        cogiro.equilibria(poses=[[1, 2, 1.5]], max_tension_n=12000)


def test_text_in_a_change_stays_text(robot: funicular.Robot) -> None:
    name = 'a "quoted" = name, é # not a comment'
    assert robot.with_({"name": name}).name == name


def test_files_that_cannot_be_read_say_so(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="none.toml"):
        funicular.Robot.from_file(tmp_path / "none.toml")
    with pytest.raises(IsADirectoryError):
        funicular.Robot.from_file(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"name = '\xff'")
    with pytest.raises(funicular.RobotFileError, match="not valid UTF-8 at byte 9"):
        funicular.Robot.from_file(tmp_path / "binary.toml")
    with pytest.raises(funicular.RobotFileError, match="line|<dict>"):
        funicular.Robot.from_dict({"name": "r", "platform": {"mass_kg": -1}})


def test_notebooks_show_tables_and_texts_are_short(robot: funicular.Robot, rest: funicular.Equilibrium) -> None:
    named = robot.with_({"name": "<script>alert(1)</script>"})
    shown: list[Any] = [named, named.equilibrium(), named.modes(20), robot.equilibria(poses=[[0, 0, 0.5], [0, 0, 9]])]
    for result in shown:
        html = result._repr_html_()
        assert html.count("<table>") == html.count("</table>") == 1 and "<script>" not in html
        assert len(repr(result)) < 200 and "\n" not in repr(result)
    assert "17.685" in rest._repr_html_() and "52.549" in repr(rest)


def test_arrays_own_what_the_core_computed(rest: funicular.Equilibrium) -> None:
    tensions = rest.tension_platform_n
    tensions[:] = 0
    assert rest.tension_platform_n.min() > 15, "an array is the caller's own"
    for array in (rest.frf([1.0, 2.0], "fz", "z"), rest.receptance([1.0, 2.0]), rest.stiffness(1.0)):
        assert array.flags.writeable


def test_warnings_come_with_the_result(robot: funicular.Robot) -> None:
    heavy = robot.with_({"materials.rope-4mm.breaking_load_n": 40.0})
    assert any("breaks at 40" in warning for warning in heavy.equilibrium().warnings)
    assert any("breaks at 40" in warning for warning in heavy.modes(1).warnings)


def test_implausible_values_come_with_the_result_and_with_an_error(robot: funicular.Robot) -> None:
    slip = robot.with_({"materials.rope-4mm.youngs_modulus_pa": 20.0})
    warnings = slip.equilibrium(pose=[0.0, 0.0, 1.0]).warnings
    assert sum("GPa given as Pa?" in warning and "Young's modulus is" in warning for warning in warnings) == 1
    turned = robot.equilibrium(pose=[0.0, 0.0, 1.0, 0.0, 0.0, 720.0]).warnings
    assert sum("yaw of the pose is 720 degrees" in warning for warning in turned) == 1
    with pytest.raises(funicular.StaticsError) as caught:
        robot.equilibrium(pose=[0.0, 0.0, 1500.0])
    assert caught.value.code == "negative-tension"
    assert str(caught.value).count("position in mm or cm given as m?") == 1


def test_cables_leave_their_pulleys_towards_the_platform() -> None:
    cogiro = funicular.Robot.from_file(ROBOTS / "cogiro.toml").to_dict()
    cables = [{**cable, "pulley": "wheel", "winch": "drum"} for cable in cogiro["cables"]]
    tables = {
        "pulleys": {"wheel": {"radius_m": 0.05, "entry_direction": [0.0, 0.0, 1.0]}},
        "winches": {"drum": {"drum_side_length_m": 5.0, "stiffness_n_per_m": 1e6}},
    }
    robot = funicular.Robot.from_dict({**cogiro, **tables, "cables": cables})
    rest = robot.equilibrium(pose=[1.0, 2.0, 1.5])
    # The exit points are on wheels around the entry points.
    distance = np.linalg.norm(rest.exit_m - robot.anchor_m, axis=1)
    assert ((distance > 0.05) & (distance < 0.1)).all()
    # The cable's weight on the wheel separates both tensions.
    assert (abs(rest.tension_drum_n - rest.tension_anchor_n) < 0.1).all()
    for cable in rest.cables:
        drive = cable["drive"]
        parts = drive["free_length_m"] + drive["arc_length_m"] + drive["drum_side_length_m"]
        assert abs(parts - cable["unstrained_length_m"]) < 1e-12
        assert 90 < drive["wrap_deg"] < 180
    table = rest.to_pandas()
    assert {"exit_x_m", "swivel_z", "wrap_deg", "tension_drum_n"} <= set(table.columns)
