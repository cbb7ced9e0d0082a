"""`Robot.uncertainty` and `Modes.gradient`."""

import subprocess
from io import StringIO
from pathlib import Path

import funicular
import numpy as np
import pandas
import pytest


def test_deviations_of_tensions_are_arrays_with_names_and_units() -> None:
    robot = funicular.Robot.example()
    found = robot.uncertainty({"platform.mass_kg": "1%", "cables.*.anchor_m": 0.0002}, of=["tensions"])
    assert found.value.shape == found.deviation.shape == (12,) and found.interval_95.shape == (12, 2)
    assert found.units == ("N",) * 12 and len(found.input_names) == 19 and not found.is_sampled.any()
    assert found.group_names == ("platform.mass_kg=1%", "cables.*.anchor_m=0.0002")
    assert np.allclose(found.group_shares.sum(axis=1), 1)
    assert np.allclose(found.interval_95[:, 1] - found.value, 1.959964 * found.deviation)
    tension, deviation = found['tension of cable "3" at the platform']
    assert np.isclose(tension, robot.equilibrium().tension_platform_n[2]) and 0 < deviation < 1
    assert found.to_dict()["held"] == "lengths" and "12 results" in repr(found)

    # A list of texts is the same request.
    again = robot.uncertainty(["platform.mass_kg=1%", "cables.*.anchor_m=0.0002"], of=["tensions"])
    assert again.details == found.details


def test_the_table_has_the_columns_of_the_csv_with_units(executable: str) -> None:
    found = funicular.Robot.example().uncertainty(["platform.mass_kg=1%"], of=["tensions"])
    table = found.to_pandas()
    robot = str(Path(__file__).parents[3] / "robots/yuan2014-4mm.toml")
    line = [executable, "uncertainty", robot, "--deviations", "platform.mass_kg=1%", "--of", "tensions", "--format", "csv"]
    csv = pandas.read_csv(StringIO(subprocess.run(line, capture_output=True, text=True, check=True).stdout))
    assert list(table.columns) == list(csv.columns) and len(table) == 12
    assert np.array_equal(table["deviation"], csv["deviation"]) and np.array_equal(table["value"], found.value)
    assert table.attrs["units"]["x_m"] == "m" and "result" not in table.attrs["units"]


def test_several_poses_have_one_row_each() -> None:
    robot = funicular.Robot.from_file(Path(__file__).parents[3] / "robots/cogiro.toml")
    poses = [(0, 0, 1.5), (1, 0, 1.5), (100, 0, 1.5)]
    found = robot.uncertainty(tolerances={"cables.*.anchor_m": 0.001}, of=["stiffness-min"], hold="pose", poses=poses)
    assert found.value.shape == (3, 1) and np.isnan(found.value[2, 0]) and np.isnan(found.position_m[2]).all()
    assert (found.deviation[:2] > 0).all() and found.group_shares.shape == (3, 1, 1)
    assert "reason" in found.details["poses"][2]


def test_samples_are_kept_and_progress_is_reported(tmp_path: Path) -> None:
    robot = funicular.Robot.example()
    calls: list[tuple[int, int]] = []
    keywords = {"method": "sampled", "samples": 30, "samples_file": tmp_path / "robots.parquet"}
    found = robot.uncertainty({"platform.mass_kg": "2%"}, progress=lambda done, total: calls.append((done, total)), **keywords)
    assert calls[-1] == (30, 30) and found.is_sampled.all()
    assert (tmp_path / "robots.parquet").exists()
    page = found.page(tmp_path / "deviations.html")
    assert (tmp_path / "deviations.html").read_text() == page.html and page._repr_html_().startswith("<iframe")
    assert "robot.uncertainty(" in page.html
    assert robot.uncertainty({"platform.mass_kg": "2%"}, resume=True, threads=1, **keywords).details == found.details
    with pytest.raises(funicular.InputError, match="need `samples_file`"):
        robot.uncertainty({"platform.mass_kg": "2%"}, resume=True)
    with pytest.raises(ZeroDivisionError):
        robot.uncertainty({"platform.mass_kg": "2%"}, progress=lambda *_: 1 / 0)
    with pytest.raises(funicular.InputError, match="is no mapping from paths to numbers"):
        robot.uncertainty(3)
    with pytest.raises(funicular.InputError, match=r"did you mean `platform\.mass_kg`"):
        robot.uncertainty({"platform.mas_kg": "2%"})


def test_modes_have_gradients_that_agree_with_differences() -> None:
    robot = funicular.Robot.example()
    modes = robot.modes(below_hz=1.5)
    found = modes.gradient(["platform.mass_kg", "materials.*.damping_ratio"])
    assert found.paths[0] == "platform.mass_kg" and found.units == ("kg", "1")
    assert found.frequency_hz.shape == (len(modes), 2) and found.blocks == ()
    assert found.damping_ratio is not None and found.damping_ratio.shape == (len(modes), 2)
    # The file of the example gives the lengths, which stay.
    step, mass = 1e-3, found.values[0]
    lighter, heavier = (robot.with_({"platform.mass_kg": mass + side * step}).modes(below_hz=1.5) for side in (-1, 1))
    difference = (heavier.frequency_hz - lighter.frequency_hz) / (2 * step)
    # The error of the differences is of second order in the step.
    assert np.allclose(found.frequency_hz[:, 0], difference, rtol=1e-4, atol=1e-7)
    difference = (heavier.damping_ratio - lighter.damping_ratio) / (2 * step)
    assert np.allclose(found.damping_ratio[:, 0], difference, rtol=1e-3, atol=1e-9)
    # The derivative of a frequency by the damping is zero.
    assert np.abs(found.frequency_hz[:, 1]).max() < 1e-12

    per_percent = modes.gradient(["platform.mass_kg"], per="percent")
    assert np.allclose(per_percent.frequency_hz[:, 0], 0.01 * mass * found.frequency_hz[:, 0])
    assert robot.modes(below_hz=1.5, damped=False).gradient(["platform.mass_kg"]).damping_ratio is None
    with pytest.raises(funicular.InputError, match="no such number"):
        modes.gradient(["platform.mas_kg"])
