"""Text of the user in exceptions: nothing acts on a terminal, and no message is as long as its input."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import funicular
import pytest
from conftest import ROOT

UFF = ROOT / "crates/funicular-cli/tests/cli/identify/frame.uff"

HOSTILE = ["a\x1b[31mred\x1b]0;owned\x07", "a\u202etxt\u2066b\u200f\x9b31m", "x" * 1_000_000, "x " * 500_000]

ROBOT = funicular.Robot.from_file(ROOT / "robots/cogiro.toml")
REST = ROBOT.equilibrium(pose=[1, 2, 1.5])

CALLS: list[Callable[[str], Any]] = [
    lambda text: ROBOT.equilibrium(pose=[1, 2, 1.5], tension_rule=text),
    lambda text: ROBOT.equilibrium(pose=[1, 2, 1.5], static_model=text),
    lambda text: REST.frf([1.0], text, "z"),
    lambda text: REST.frf([1.0], "fz", text),
    lambda text: REST.cable(text, 1.0),
    lambda text: ROBOT.map({"x": [0.0]}, [text]),
    lambda text: ROBOT.with_({text: 1}),
    lambda text: ROBOT.with_({"platform.mass_kg": text}),
    lambda text: ROBOT.identify([text], {}),
    lambda text: funicular.Robot.from_file(text),
    lambda text: funicular.Robot.from_toml(f"'{text}' = 1"),
    lambda text: funicular.read_measurements(text),
]


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("text", HOSTILE, ids=["colours", "directions", "word", "words"])
def test_messages_are_harmless(call: Callable[[str], Any], text: str) -> None:
    with pytest.raises((funicular.Error, OSError)) as caught:
        call(text)
    if isinstance(caught.value, OSError):
        return
    message = str(caught.value)
    assert len(message) < 8000
    assert all(c == "\n" or c.isprintable() for c in message), ascii(message)


def test_what_is_converted_or_left_out_is_a_warning(tmp_path: Path) -> None:
    text = UFF.read_text()
    file = tmp_path / "a.uff"
    file.write_text(text.replace("m/s^2", "g's  "))
    with pytest.warns(funicular.MeasurementWarning, match="the unit `g's` is converted: it is 9.80665 in SI units"):
        converted = funicular.read_measurements(file)["responses"][0]
    plain = funicular.read_measurements(UFF)["responses"][0]
    assert converted["real"][0] == pytest.approx(9.80665 * plain["real"][0])

    file.write_text(text.replace("NONE               1   3", "NONE               1   0"))
    with pytest.raises(funicular.InputError, match=r'`responses` "line 7=az/fz"'):
        funicular.read_measurements(file)
    assert funicular.read_measurements(file, responses={"line 7": "az/fz"})["responses"] == [plain]
