"""Design: the package and the program choose the same values."""

import pickle
from pathlib import Path

import funicular
import numpy as np
import pytest
from conftest import ROOT, Program

ROBOT = ROOT / "robots/cogiro.toml"


def test_the_package_chooses_what_the_program_chooses(program: Program, tmp_path: Path) -> None:
    theirs = program(
        "design", ROBOT, "--pose", "3.5,2.5,1", "--target-tension-n", "350", "--goal", "platform",
        "--change", "cables.*.attachment_m.z=±0.05",
    )
    robot = funicular.Robot.from_file(ROBOT)
    found = robot.design({"cables.*.attachment_m.z": 0.05}, goal="platform", poses=[[3.5, 2.5, 1]], target_tension_n=350)
    assert found.success and found.fun == theirs["after"] and found.unit == "Hz"
    assert found.fun > found.fun_before == found.before.min()
    assert found.x.tolist() == [row["value"] for row in theirs["values"]]
    assert np.all((found.bounds[:, 0] <= found.x) & (found.x <= found.bounds[:, 1]))
    assert np.all((found.gains == 0) | np.isin(found.x, found.bounds))

    # The page is made of the result. A copy from a pickle computes it again and makes an equal page.
    page = found.page(tmp_path / "design.html")
    assert (tmp_path / "design.html").read_text() == page.html and page._repr_html_().startswith("<iframe")
    assert "robot.design(" in page.html and f"{found.fun:.5g}" in page.html
    assert pickle.loads(pickle.dumps(found)).page().html == page.html

    # The robot of the result has the result.
    modes = found.robot.equilibrium(pose=[3.5, 2.5, 1], target_tension_n=350).modes(10, cable_model="catenary-static")
    assert modes.frequency_hz[0] == pytest.approx(found.fun, rel=1e-9)


def test_demands_that_cannot_be_met_are_said_with_what_was_reached() -> None:
    robot = funicular.Robot.from_file(ROBOT)
    change = {"cables.*.attachment_m.z": (0.9, 1.1)}
    with pytest.raises(funicular.InputError, match="is not between the bounds"):
        robot.design(change)
    with pytest.raises(funicular.NoSolutionError, match="reached after"):
        robot.design({"cables.1.attachment_m": 0.01}, pose=[0, 0, 1.5], goal="rope-mass", min_frequency_hz=20)
