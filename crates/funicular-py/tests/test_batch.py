"""Many states at once give the results of single states."""

import funicular
import numpy as np
import pytest
from numpy.typing import NDArray

SINGLE = ("unstrained_length_m", "tension_platform_n", "tension_anchor_n", "sag_ratio")


def poses(count: int, seed: int, spread: tuple[float, ...] = (2, 1, 1.5, 20, 20, 40)) -> NDArray[np.float64]:
    """Poses in and around the workspace of the example."""
    return np.random.default_rng(seed).uniform(-1, 1, (count, 6)) * spread + [0, 0, 1.2, 0, 0, 0]


def assert_equals_loop(robot: funicular.Robot, rows: NDArray[np.float64], many: funicular.Equilibria, **keywords: str) -> None:
    for i, row in enumerate(rows):
        try:
            one = robot.equilibrium(pose=row, **keywords)  # type: ignore[arg-type]
        except funicular.StaticsError as error:
            assert (many.status[i], many.reason[i]) == (error.code, str(error))
            assert np.isnan(many.tension_platform_n[i]).all() and np.isnan(many.position_m[i]).all()
            assert np.isnan(many.residual[i])
            continue
        assert many.status[i] == "ok" and many.reason[i] == ""
        for name in SINGLE:
            assert getattr(many, name)[i].tobytes() == getattr(one, name).tobytes(), name
        assert many.position_m[i].tobytes() == one.pose.position_m.tobytes()
        assert many.quaternion_wxyz[i].tobytes() == one.pose.quaternion_wxyz.tobytes()
        assert many.roll_pitch_yaw_deg[i].tobytes() == one.pose.roll_pitch_yaw_deg.tobytes()
        assert many.residual[i] == one.residual
        assert (None if many.stable is None else bool(many.stable[i])) == one.stable
        stiffness = many.stiffness_min_n_per_m[i]
        assert (None if np.isnan(stiffness) else stiffness) == one.stiffness_min_n_per_m


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("threads", [1, 3])
def test_a_batch_is_the_loop_bit_for_bit(seed: int, threads: int, robot: funicular.Robot) -> None:
    rows = poses(200, seed)
    many = robot.equilibria(poses=rows, threads=threads)
    assert 0 < many.ok.sum() < len(many), "some are possible, some are not"
    assert_equals_loop(robot, rows, many)


def test_so_is_one_of_a_robot_with_a_choice_of_tensions(cogiro: funicular.Robot) -> None:
    rows = poses(60, 7, (4, 3, 1, 5, 5, 5))
    assert_equals_loop(cogiro, rows, cogiro.equilibria(poses=rows, tension_rule="lowest"), tension_rule="lowest")


def test_so_is_one_of_lengths(robot: funicular.Robot) -> None:
    assert robot.lengths_m is not None
    rows = robot.lengths_m + np.random.default_rng(1).uniform(-0.05, 0.05, (80, 6))
    many = robot.equilibria(lengths_m=rows)
    for i, row in enumerate(rows):
        assert many.tension_platform_n[i].tobytes() == robot.equilibrium(lengths_m=row).tension_platform_n.tobytes()


def test_stability_has_no_meaning_for_rigid_cables(robot: funicular.Robot) -> None:
    pytest.importorskip("pandas")
    rows = [[0, 0, 0.5], [0.2, 0, 0.6], [0, 0, 50]]
    rigid, elastic = (robot.equilibria(poses=rows, static_model=model) for model in ("ideal", "spring"))
    assert rigid.stable is None and robot.equilibrium(pose=rows[0], static_model="ideal").stable is None
    assert elastic.stable is not None and elastic.stable.tolist() == [True, True, False]
    assert_equals_loop(robot, np.asarray(rows), rigid, static_model="ideal")
    assert "stable" not in rigid.to_pandas().columns and "stable" in elastic.to_pandas().columns
    assert rigid == robot.equilibria(poses=rows, static_model="ideal") and rigid != elastic


def test_quaternions_are_the_angles(robot: funicular.Robot) -> None:
    rows = poses(50, 3)
    turned = [np.r_[row[:3], funicular.Pose(row[:3], row[3:]).quaternion_wxyz] for row in rows]
    by_angles, by_quaternion = robot.equilibria(poses=rows), robot.equilibria(poses=turned)
    assert (by_angles.status == by_quaternion.status).all()
    assert np.allclose(by_angles.tension_platform_n, by_quaternion.tension_platform_n, rtol=1e-9, equal_nan=True)


def test_what_is_no_state_is_a_row_with_its_reason(robot: funicular.Robot) -> None:
    many = robot.equilibria(poses=[[0, 0, 0.5], [np.nan, 0, 0.5], [0, 0, 1e300], [0, 0, 50]])
    assert many.status.tolist() == ["ok", "input", "input", "negative-tension"]
    assert "finite" in many.reason[1] and "tension" in many.reason[3]
    assert robot.equilibria(lengths_m=[[6.8] * 5 + [-1.0]]).status.tolist() == ["length"]
    beyond = robot.equilibria(lengths_m=[[6.8] * 5 + [1e13], [6.8] * 5 + [np.inf]])
    assert beyond.status.tolist() == ["input", "input"]
    assert "beyond 1e12" in beyond.reason[0] and "finite" in beyond.reason[1]
    assert len(robot.equilibria(poses=np.empty((0, 6)))) == 0


def test_arguments_that_hold_for_all_states_are_refused_at_once(robot: funicular.Robot) -> None:
    for keywords, said in [
        ({}, "one of them"),
        ({"poses": [[0, 0]]}, "rows of 2 numbers"),
        ({"poses": [0, 0, 0]}, "1 dimensions"),
        ({"lengths_m": [7] * 6}, "give an array with one row per state"),
        ({"lengths_m": [[6.8] * 5]}, "rows of 5 numbers, and the robot has 6 cables"),
        ({"poses": [[0, 0, 0.5]], "threads": 0}, "at least one"),
        ({"poses": [[0, 0, 0.5]], "threads": -1}, "at least one"),
        ({"poses": [[0, 0, 0.5]], "threads": 2**61}, "at most 1024"),
        ({"poses": [[0, 0, 0.5]], "static_model": "springs"}, 'did you mean `spring`'),
    ]:
        with pytest.raises(funicular.InputError, match=said):
            robot.equilibria(**keywords)  # type: ignore[arg-type]


def test_a_table_has_one_row_per_state(robot: funicular.Robot) -> None:
    pytest.importorskip("pandas")
    table = robot.equilibria(poses=[[0, 0, 0.5], [0, 0, 50]]).to_pandas()
    assert set(table.columns) > {"residual", "stable", "stiffness_min_n_per_m", "nearest_pose_distance_m"}
    assert table["status"].tolist() == ["ok", "negative-tension"] and table["tension_platform_6_n"].isna().tolist() == [False, True]
