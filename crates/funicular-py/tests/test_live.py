"""The page with a robot in it, as a widget of notebooks. The page itself is replaced by the place of its start, because
only a release contains it; scripts/test-web tests the page and the script of the widget in a browser."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest

import funicular
from funicular._live import live

ROBOT = funicular.Robot.example().to_toml()


def page(**more: Any) -> funicular.Live:
    start = {
        "version": 1, "robot": {"name": "a.toml", "text": ROBOT, "set": []}, "hold": "file", "pose": None, "lengths": None,
        "rule": "", "more": {}, "model": {}, **more,
    }
    text = json.dumps(start).replace("<", "\\u003c")
    return live(f'<!DOCTYPE html><script id="start" type="application/json">{text}</script><p>page</p>')


def test_the_state_is_that_with_which_the_page_was_made() -> None:
    made = page(hold="pose", pose=[0, 0, 0.5, 0, 0, 0], more={"force_n": [0, 0, -5]})
    assert made.pose == [0, 0, 0.5, 0, 0, 0] and made.lengths_m is None and made.values == {}
    expected = funicular.Robot.example().equilibrium(pose=[0, 0, 0.5], force_n=[0, 0, -5])
    assert (made.equilibrium().tension_platform_n == expected.tension_platform_n).all()
    assert page().equilibrium().tension_platform_n.shape == (6,)


def test_what_a_person_changes_in_a_notebook_comes_back() -> None:
    pytest.importorskip("anywidget")
    made = page()
    widget = made.widget()
    assert made.widget() is widget

    # The script asks for the page, and is answered with it.
    sent: list[Any] = []
    widget.send = sent.append
    widget._handle_custom_msg({"ask": "page"}, [])
    widget._handle_custom_msg({"ask": "else"}, [])
    assert sent == [{"page": made.html}]

    # The message of the notebook's front end after a drag, a slider and a held pose.
    state = {
        "version": 1, "robot": {"name": "a.toml", "text": ROBOT, "set": [{"path": "platform.mass_kg", "value": 2.5}]},
        "hold": "pose", "pose": [0.01, 0, 0.4, 0, 0, 0], "lengths": None, "rule": "", "more": {}, "model": {},
    }
    widget.set_state({"state": state})
    assert made.pose == [0.01, 0, 0.4, 0, 0, 0] and made.values == {"platform.mass_kg": 2.5}
    robot = funicular.Robot.example().with_({"platform.mass_kg": 2.5})
    assert made.robot.mass_kg == 2.5
    expected = robot.equilibrium(pose=[0.01, 0, 0.4])
    assert (made.equilibrium().tension_platform_n == expected.tension_platform_n).all()

    widget.set_state({"state": {**state, "hold": "lengths", "pose": None, "lengths": expected.unstrained_length_m.tolist()}})
    assert made.pose is None and made.equilibrium().pose.position_m == pytest.approx([0.01, 0, 0.4], abs=1e-6)


def test_a_notebook_shows_the_widget_with_a_note_or_the_page_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("anywidget")
    shown = page()._repr_mimebundle_()
    data = shown[0] if isinstance(shown, tuple) else shown
    assert "application/vnd.jupyter.widget-view+json" in data and "while the kernel runs" in data["text/html"]

    # Without anywidget: the whole page in a frame, and a message that says what to install.
    monkeypatch.setitem(sys.modules, "anywidget", None)
    alone = page()
    assert "<iframe" in alone._repr_mimebundle_()["text/html"]
    with pytest.raises(funicular.InputError, match=r"pip install anywidget"):
        alone.widget()


def test_the_page_is_written_complete(tmp_path: Path) -> None:
    made = page()
    made.write(tmp_path / "a.html")
    assert (tmp_path / "a.html").read_text() == made.html
    with pytest.raises(funicular.InputError, match="would hold one figure"):
        made.write(tmp_path / "a.png")
