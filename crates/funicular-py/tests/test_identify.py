"""Identification: the package and the program find the same values from the same measurements."""

from pathlib import Path

import funicular
import numpy as np
import pytest
from conftest import ROOT, Program

ROBOT, MODES = ROOT / "docs/quick-start/hall.toml", ROOT / "docs/identification/hall-modes.csv"


def test_the_package_finds_what_the_program_finds(program: Program, tmp_path: Path) -> None:
    arguments = ["--hold-lengths-of-pose", "--measured", MODES, "--fit", "platform.mass_kg"]
    theirs = program("identify", ROBOT, *arguments, "--prior", "platform.mass_kg=60±10")

    robot = funicular.Robot.from_file(ROBOT)
    fit = {"platform.mass_kg": {"prior": 60, "prior_std": 10}}
    found = robot.identify(fit, funicular.read_measurements(MODES), hold_lengths_of_pose=True)
    assert found.determined and found.assignment is None
    assert found.success and found.names == ("platform.mass_kg",)
    assert found.x[0] == theirs["values"][0]["value"] and found.chi2 == theirs["chi2"]
    assert abs(found.x[0] - 63.82) < 0.05 and 0 < found.deviations[0] < 1
    assert np.allclose(found.covariance, found.deviations[0] ** 2)
    page = found.page(tmp_path / "fit.html")
    assert (tmp_path / "fit.html").read_text() == page.html and page._repr_html_().startswith("<iframe")
    assert "robot.identify(experiments, " in page.html and "schema" not in page.html.split("robot.identify(")[1][:400]
    assert found.robot.mass_kg == pytest.approx(found.x[0], rel=1e-4)


def test_modes_of_frequencies_without_numbers_are_searched() -> None:
    robot = funicular.Robot.from_file(ROOT / "robots/yuan2014-4mm.toml")
    found = robot.identify(["platform.mass_kg"], funicular.read_measurements(ROOT / "docs/identification/unnumbered.csv"))
    assert found.determined and abs(found.x[0] - 14.3) < 0.01
    assert found.assignment is not None and found.assignment["second_best"]["values"][0] == pytest.approx(10.86, abs=0.05)
    assert [row["number"] for row in found.details["frequencies"]] == [1, 2, 4, 6, 8]


def test_unknown_paths_and_measurements_are_refused() -> None:
    robot = funicular.Robot.from_file(ROBOT)
    frequencies = funicular.read_measurements(MODES)
    with pytest.raises(funicular.InputError, match="platform.weight_kg"):
        robot.identify(["platform.weight_kg"], frequencies, hold_lengths_of_pose=True)
    with pytest.raises(funicular.InputError, match="no measurement"):
        robot.identify(["platform.mass_kg"], {}, hold_lengths_of_pose=True)


def test_frequencies_of_a_time_history(program: Program) -> None:
    decay = ROOT / "docs/identification/hall-decay.csv"
    theirs = program("identify", ROBOT, "--measured", decay, "--history-poles", "1")
    robot = funicular.Robot.from_file(ROBOT)
    found = robot.identify([], funicular.read_measurements(decay), history_poles=1)
    assert found.names == () and found.details["histories"] == theirs["histories"]
    pole = found.details["histories"][0]["poles"][0]
    low, high = pole["interval_95_hz"]
    assert low < pole["frequency_hz"] < high and abs(pole["frequency_hz"] - 6.803) < 0.02
