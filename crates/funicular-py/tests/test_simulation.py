"""Simulations: functions of the time, progress, and what is refused."""

from math import cos, pi
from typing import Any

import numpy as np
import pytest
from funicular import InputError, Robot


def followed(table: Any, **event: Any) -> dict[str, Any]:
    """Scenario in which a table says the lengths."""
    return {"lengths": [{"at_s": 0.05, "table": table, **event}]}


def test_a_function_of_the_time_gives_the_lengths_of_its_table(robot: Robot) -> None:
    rest = robot.equilibrium().unstrained_length_m

    def lengths(t: float) -> dict[str, float]:
        part = 0.5 * (1 - cos(pi * t / 0.5))
        return {f"unstrained_length_{name}_m": of - 0.01 * part for name, of in zip("123456", rest, strict=True)}

    calls: list[tuple[int, int]] = []
    settings: dict[str, Any] = {"once": True, "elements": 1, "degree": 6, "tolerance_m": 1e-6}
    found = robot.simulate(
        followed(lengths, duration_s=0.5), 0.6, **settings, progress=lambda done, rows: calls.append((done, rows))
    )
    end = found["rows"][-1]
    assert np.allclose(end["unstrained_lengths_m"], np.asarray(rest) - 0.01, rtol=0, atol=1e-12)
    halfway = next(row for row in found["rows"] if row["t_s"] >= 0.3 - 1e-9)
    assert np.allclose(halfway["unstrained_lengths_m"], np.asarray(rest) - 0.005, rtol=0, atol=1e-6)

    assert calls[-1] == (1001, 1001)
    assert all(rows == 1001 for _, rows in calls)
    assert [done for done, _ in calls] == sorted(done for done, _ in calls)


def test_what_a_function_returns_is_checked(robot: Robot) -> None:
    for table, event, says in [
        (lambda t: {"x_m": 0.0}, {}, "needs `duration_s`"),
        (lambda t: [0.0], {"duration_s": 1.0}, "has to return a mapping from columns to numbers"),
        (lambda t: {"x_m": t} if t < 0.5 else {"y_m": t}, {"duration_s": 1.0}, "the same columns at all times"),
    ]:
        with pytest.raises(InputError, match=says):
            robot.simulate(followed(table, **event), 2.0)


def test_what_the_function_of_the_progress_raises_ends_the_run(robot: Robot) -> None:
    with pytest.raises(ZeroDivisionError):
        robot.simulate({"release": [{"at_s": 0.0, "mass_kg": 1.0}]}, 20.0, once=True, progress=lambda *_: 1 / 0)
