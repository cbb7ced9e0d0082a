"""Jobs in G-code, columns in inches, and tables for papers."""

from pathlib import Path

import funicular
import numpy as np
import pytest

ROOT = Path(__file__).parents[3]
COURSE = {"speed_m_s": 0.2, "acceleration_m_s2": 1.0, "jerk_m_s3": 20.0}


@pytest.fixture
def wall() -> funicular.Robot:
    return funicular.Robot.from_file(ROOT / "robots" / "wall-machine.toml")


def test_a_job_is_the_same_from_its_file_and_as_columns(wall: funicular.Robot, tmp_path: Path) -> None:
    (tmp_path / "job.nc").write_text("G20\nG1 X4 F60\nG3 X6 Y2 J2\n")
    of_file = wall.trajectory(path=tmp_path / "job.nc", path_origin_m=[2.2, 1.8, 0.0], **COURSE)
    columns = {
        "x_in": np.array([2.2, 2.2, 2.2]) / 0.0254 + [0, 4, 6],
        "y_in": np.array([1.8, 1.8, 1.8]) / 0.0254 + [0, 0, 2],
        "z_m": [0, 0, 0],
        "feed_in_min": [0, 60, 60],
        "center_x_m": [0, 0, 2.2 + 4 * 0.0254],
        "center_y_m": [0, 0, 1.8 + 2 * 0.0254],
        "turn_z_deg": [0, 0, 90],
    }
    of_columns = wall.trajectory(path=columns, **COURSE)
    assert of_file["duration_s"] == pytest.approx(of_columns["duration_s"], rel=1e-9)
    told = [command["told"] for command in of_file["length_commands"]]
    assert len(told) == 2 and all("goes slack" in text for text in told)
    with pytest.raises(funicular.InputError, match="line 1: there is no feed rate"):
        (tmp_path / "job.nc").write_text("G1 X4\n")
        wall.trajectory(path=tmp_path / "job.nc", **COURSE)


def test_readings_in_inches_are_those_in_millimetres() -> None:
    machine = funicular.Robot.from_file(ROOT / "docs" / "calibration" / "machine.toml")
    lines = [line for line in (ROOT / "docs" / "calibration" / "belts.csv").read_text().splitlines() if line[0] != "#"]
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    names = lines[0].split(",")
    plain = machine.calibrate(ROOT / "docs" / "calibration" / "belts.csv")
    inches = machine.calibrate({name.replace("_mm", "_in"): values[:, k] / 25.4 for k, name in enumerate(names)})
    assert plain["residual_rms_m"] == pytest.approx(inches["residual_rms_m"], rel=1e-6)


def test_tables_for_papers_are_those_of_the_program(wall: funicular.Robot) -> None:
    rest = wall.equilibrium()
    latex, markdown = rest.to_latex(), rest.to_markdown()
    assert latex.splitlines()[-1] == r"\end{tabular}" and latex.count(r"\toprule") == 1
    assert len(markdown.splitlines()) == 6 and markdown.count("|") % 6 == 0
    payload = wall.loads(required_force_n=[1, 1, 0])
    assert payload.to_latex().startswith("% \\usepackage{booktabs, siunitx}\n\\begin{tabular}")
    assert payload.to_markdown().startswith("| ")
