"""Estimator in a loop: rows of `estimate`, missing readings, refused input, restart."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from funicular import Estimator, InputError, NoSolutionError, Robot

FOLDER = Path(__file__).parents[3] / "docs/estimation"
PRIORS: dict[str, Any] = {"payload_std_kg": 0.5, "first_moment_std_kg_m": 0.05, "inertial_unit_m": (0.1, 0, 0.5), "tracked_point_m": (0, 0, 1)}


@pytest.fixture(scope="module")
def machine() -> Robot:
    return Robot.from_file(FOLDER / "robot.toml")


def readings(count: int) -> list[tuple[float, dict[str, Any]]]:
    """Rows of the log of the documents: time and keywords."""
    with (FOLDER / "run.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))[:count]
    found = []
    for row in rows:
        of_cables = {
            key: {str(i): float(row[f"{stem}_{i}_{unit}"]) for i in range(1, 9) if row[f"{stem}_{i}_{unit}"]}
            for key, stem, unit in (("lengths_m", "length", "m"), ("tensions_n", "tension_anchor", "n"))
        }
        of_axes = {}
        for key, stem, unit in (("gyroscope_rad_s", "gyroscope", "rad_s"), ("accelerometer_m_s2", "accelerometer", "m_s2"), ("tracker_m", "tracker", "m")):
            cells = [row[f"{stem}_{axis}_{unit}"] for axis in "xyz"]
            if all(cells):
                of_axes[key] = [float(cell) for cell in cells]
        found.append((float(row["t_s"]), {key: value for key, value in of_cables.items() if value} | of_axes))
    return found


def test_updates_have_the_rows_of_estimate(machine: Robot) -> None:
    log = readings(400)
    whole = machine.estimate(FOLDER / "run.csv", **PRIORS)
    estimator = Estimator(machine, **log[0][1], **PRIORS)
    alarms = []
    for (before, _), (now, given), row in zip(log, log[1:], whole["rows"][1:], strict=False):
        found = estimator.update(now - before, **given)
        alarms += found["alarms"]
        assert np.allclose(found["position_m"], row["position_m"], rtol=0, atol=1e-12)
        assert found["payload_kg"] == pytest.approx(row["payload_kg"], abs=1e-9)
        assert found["slack"] == row["slack"] and found["is_trusted"] == row["is_trusted"]
    assert [alarm["fault"] for alarm in alarms] == ["payload"] == [alarm["fault"] for alarm in estimator.alarms]
    assert found["tensions_n"].shape == (8,) and estimator.cable_names == list("12345678")


def test_refused_input_changes_nothing(machine: Robot) -> None:
    log = readings(20)
    estimator = Estimator(machine, **log[0][1], **PRIORS)
    estimator.update(0.01, **log[1][1])
    before = estimator.now
    lengths = list(log[2][1]["lengths_m"].values())
    for given, words in (
        ({"dt_s": 0.0}, "`dt_s`"),
        ({"dt_s": 2.0}, "at most 1 s"),
        ({"dt_s": 0.01, "lengths_m": lengths[:3]}, "3 numbers"),
        ({"dt_s": 0.01, "lengths_m": [float("nan"), *lengths[1:]]}, "`lengths_m`"),
        ({"dt_s": 0.01, "lengths_m": {"9": 1.0}}, 'no cable "9"'),
        ({"dt_s": 0.01, "lengths_m": {"1": -1.0}}, "above zero"),
        ({"dt_s": 0.01, "tracker_m": [0, 0]}, "x, y, z"),
        ({"dt_s": 0.01, "tracker_m": [0, 0, float("inf")]}, "`tracker_m`"),
    ):
        with pytest.raises(InputError, match=words):
            estimator.update(**given)
        assert estimator.now["position_m"].tolist() == before["position_m"].tolist()
    with pytest.raises(InputError, match="cable \"1\" has none"):
        Estimator(machine, {"2": lengths[1]})
    with pytest.raises(InputError, match="one by one"):
        Estimator(machine, lengths, log={})
    with pytest.raises(InputError, match="tension_std_n"):
        Estimator(machine, lengths, tension_std_n=-1)


def test_encoders_that_are_silent_are_told_and_a_restart_goes_on(machine: Robot) -> None:
    log = readings(40)
    estimator = Estimator(machine, **log[0][1], **PRIORS)
    for _, given in log[1:]:
        estimator.update(0.01, **given)
    known = estimator.now["payload_std_kg"]
    with pytest.raises(NoSolutionError, match="no length has been read"):
        for _ in range(40):
            estimator.update(0.01)
    lengths = log[-1][1]["lengths_m"]
    estimator.restart(lengths)
    # The deviation of the payload stays, but for its growth while nothing was read.
    assert estimator.now["payload_std_kg"] < known * 1.0001
    assert [alarm["fault"] for alarm in estimator.update(0.01, lengths_m=lengths)["alarms"]] == ["restart"]
    estimator.restart(lengths, forget=True)
    assert estimator.now["payload_std_kg"] == pytest.approx(0.5, rel=0.01)
