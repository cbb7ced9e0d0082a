"""Labels of tables: numbers are taken by their names or refused, whatever their order."""

import itertools
from typing import Any

import funicular
import numpy as np
import pytest

pandas = pytest.importorskip("pandas")

POSE = [1.0, 2.0, 1.5]
SIX = [*POSE, 1.0, 2.0, 3.0]


def test_poses_are_those_of_their_names_in_any_order(cogiro: funicular.Robot) -> None:
    expected = cogiro.equilibria([POSE])
    for names in (["x", "y", "z"], ["x_m", "y_m", "z_m"], ["position_x_m", "position_y_m", "position_z_m"]):
        for order in itertools.permutations(range(3)):
            table = pandas.DataFrame({names[i]: [POSE[i]] for i in order})
            assert cogiro.equilibria(table) == expected
            assert cogiro.map(poses=table, quantities="tension-max") == cogiro.map(poses=[POSE], quantities=["tension-max"])
            assert cogiro.equilibrium(table.iloc[0]) == cogiro.equilibrium(POSE)
            assert cogiro.request("map", poses=table)["poses"] == [[*POSE, 0, 0, 0]]
    angles = pandas.DataFrame([SIX[::-1]], columns=["yaw", "pitch_deg", "roll", "z", "y", "x"])
    assert cogiro.equilibria(angles) == cogiro.equilibria([SIX])
    assert cogiro.equilibria(angles.drop(columns=["roll", "pitch_deg"])) == cogiro.equilibria([[*POSE, 0, 0, 3]])
    assert cogiro.request("statics", pose=angles.iloc[0])["pose"] == SIX
    design = cogiro.design({"cables.1.anchor_m.x": 0.1}, poses=angles, max_iterations=1)
    assert design.poses.tolist() == [SIX]
    several = {"poses": pandas.DataFrame({"z": [1.5, 1.4], "x": [1, 0], "y": [2, 1]}), "hold": "pose", "of": "tensions"}
    assert cogiro.uncertainty({"platform.mass_kg": 1}, **several).position_m.tolist() == [POSE, [0, 1, 1.4]]  # type: ignore[arg-type]


def test_tables_of_the_package_come_back(cogiro: funicular.Robot) -> None:
    states, rest = cogiro.equilibria([POSE, [0, 0, 1.5]]), cogiro.equilibrium(POSE)
    assert np.allclose(cogiro.equilibria(states.to_pandas()).position_m, states.position_m)
    mixed = states.to_pandas().sample(frac=1, axis=1, random_state=0)
    assert cogiro.equilibria(lengths_m=mixed) == cogiro.equilibria(lengths_m=states.unstrained_length_m)
    rows = cogiro.map(poses=[POSE], quantities=["tensions", "tension-max"]).to_pandas()
    assert cogiro.equilibria(rows) == cogiro.equilibria([POSE])
    lengths = rest.to_pandas()["unstrained_length_m"]
    for series in (lengths, lengths[::-1], lengths.sort_values()):
        assert cogiro.equilibrium(lengths_m=series) == cogiro.equilibrium(lengths_m=rest.unstrained_length_m)
    targets = pandas.Series(np.linspace(500, 900, 8), index=cogiro.cable_names)
    assert cogiro.equilibrium(POSE, target_tension_n=targets[::-1]) == cogiro.equilibrium(POSE, target_tension_n=targets.to_numpy())
    experiment = {"measured_lengths_m": lengths[::-1]}
    request = cogiro.request("identify", fit="platform.mass_kg", experiments=experiment)
    assert request["experiments"][0]["measured_lengths_m"] == rest.unstrained_length_m.tolist()


def test_vectors_and_bounds_have_names(cogiro: funicular.Robot) -> None:
    expected = cogiro.equilibrium(POSE, force_n=[1, 2, -30], wind_m_s=[3, 0, 0])
    for names in (("z", "x", "y"), ("z_n", "x_n", "y_n"), ("fz", "fx", "fy"), ("force_z_n", "force_x_n", "force_y_n")):
        force = pandas.Series([-30.0, 1, 2], index=names)
        wind = pandas.Series({"z": 0.0, "x": 3, "y": 0})
        assert cogiro.equilibrium(POSE, force_n=force, wind_m_s=wind) == expected
    assert funicular.Pose(pandas.Series({"z": 1.5, "y": 2, "x": 1})) == funicular.Pose(POSE)
    band = cogiro.request("design", change={"platform.mass_kg": 1}, avoid_hz=pandas.Series({"maximum": 3, "minimum": 2}))
    assert band["avoid_hz"] == [2, 3]
    new = funicular.new_robot(box_m=pandas.Series({"z": 0.2, "x": 0.4, "y": 0.3})).text
    assert new == funicular.new_robot(box_m=[0.4, 0.3, 0.2]).text


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (["a", "b", "c"], "has the columns a, b, c, and none for `x_m`"),
        (["x", "y", "height"], "none for `z_m`"),
        (["x_mm", "y_mm", "z_mm"], "none for `x_m`"),
        (["x", "x_m", "y", "z"], "has the columns `x` and `x_m`: keep one"),
        (["x", "y", "z", "z"], "has the columns `z` and `z`: keep one"),
        (["x", "y", "z", "yaw_rad"], "has the columns `yaw_rad` and no `yaw_deg`"),
        (["x", "y", "z", "yaw", "quaternion_w"], "angles and a quaternion"),
        (["x", "y", "z", "quaternion_w"], "none for `quaternion_x`"),
        ([2, 1, 0], "none for `x_m`"),
    ],
)
def test_names_that_mean_no_pose_are_refused(columns: list[Any], said: str, cogiro: funicular.Robot) -> None:
    table = pandas.DataFrame([[1.0] * len(columns)], columns=columns)
    with pytest.raises(funicular.InputError, match=f"^`poses` .*{said}"):
        cogiro.equilibria(table)
    with pytest.raises(funicular.InputError, match=f"^`poses` .*{said}"):
        cogiro.map(poses=table)


def test_labels_of_places_and_other_columns_do_no_harm(cogiro: funicular.Robot) -> None:
    assert cogiro.equilibria(pandas.DataFrame([POSE])) == cogiro.equilibria([POSE])
    assert cogiro.equilibrium(pandas.Series([0, *POSE])[1:]) == cogiro.equilibrium(POSE)
    named = pandas.DataFrame({"name": ["p"], "z": [1.5], "y": [2.0], "x": [1.0], "when": pandas.to_datetime(["2026-01-01"])})
    assert cogiro.equilibria(named) == cogiro.equilibria([POSE])
    with pytest.raises(funicular.InputError, match=r'^`poses\["y"\]\[0\]` is '):
        cogiro.equilibria(named.assign(y=["2"]))
    with pytest.raises(funicular.InputError, match=r"`lengths_m` has the labels .* none for `8`"):
        cogiro.equilibrium(lengths_m=cogiro.equilibrium(POSE).to_pandas()["unstrained_length_m"][:-1])


def test_tables_of_arrow_have_names(cogiro: funicular.Robot) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    table = pyarrow.table({"z": [1.5], "y": [2.0], "x": [1.0]})
    assert cogiro.equilibria(table) == cogiro.equilibria([POSE])
