"""The page on which a platform can be dragged, in notebooks: what a person changes there comes back to Python."""

import json
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from funicular._errors import InputError, needs
from funicular._funicular import Equilibrium, Robot
from funicular._pages import Page

_START = '<script id="start" type="application/json">'
_NOTE = "<p>The page is live while the kernel runs. <code>write(path)</code> writes it to a file.</p>"


@dataclass(frozen=True, repr=False)
class Live(Page):
    """A page on which the platform can be dragged; notebooks show it.

    With the package `anywidget`, `state` follows the page in the notebook: pose, lengths and values that a person has
    changed. Without it the page is shown alone, and `state` stays as it was made.
    """

    _kept: dict[str, Any] = field(default_factory=dict, init=False, compare=False)

    @property
    def state(self) -> dict[str, Any]:
        """State of the page: robot with the changes of its values, what is held, pose or lengths."""
        state = self._kept["widget"].state if "widget" in self._kept else None
        return state or self._start()

    @property
    def pose(self) -> list[float] | None:
        """Requested pose: x, y, z [m], roll, pitch, yaw [degrees]; None if lengths or the state of the file are held."""
        return self.state["pose"] if self.state["hold"] == "pose" else None

    @property
    def lengths_m(self) -> list[float] | None:
        """Held unstrained lengths [m]; None if a pose or the state of the file is held."""
        return self.state["lengths"] if self.state["hold"] == "lengths" else None

    @property
    def values(self) -> dict[str, Any]:
        """Values that differ from the robot file, by their paths."""
        return {change["path"]: change["value"] for change in self.state["robot"].get("set", [])}

    @property
    def robot(self) -> Robot:
        """Robot with these values."""
        robot = Robot.from_toml(self.state["robot"]["text"])
        return robot.with_(self.values) if self.values else robot

    def equilibrium(self) -> Equilibrium:
        """Computes the equilibrium that the page shows.

        Raises
        ------
        StaticsError
            The robot has none at this state.
        """
        state = self.state
        given: dict[str, Any] = dict(state.get("more") or {})
        if state["hold"] == "pose" and state.get("rule"):
            given["tension_rule"] = state["rule"]
        return self.robot.equilibrium(pose=self.pose, lengths_m=self.lengths_m, **given)

    def widget(self) -> Any:
        """Makes the widget that notebooks show, once; later calls return the same one.

        Raises
        ------
        InputError
            The package `anywidget` is missing.
        """
        if "widget" not in self._kept:
            try:
                import anywidget
                import traitlets
            except ImportError as error:
                raise InputError(f"{needs('a widget', 'anywidget')}; here: {error}") from error

            class LiveWidget(anywidget.AnyWidget):
                _esm = Path(__file__).with_name("_live.js").read_text(encoding="utf-8")
                state = traitlets.Dict(allow_none=True, default_value=None).tag(sync=True)

            def answer(widget: Any, content: Any, buffers: Any) -> None:
                if content == {"ask": "page"}:
                    widget.send({"page": self.html})

            made = LiveWidget()
            made.on_msg(answer)
            self._kept["widget"] = made
        return self._kept["widget"]

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        try:
            found = self.widget()._repr_mimebundle_(**kwargs)
        except InputError:
            return {"text/html": self._repr_html_(), "text/plain": repr(self)}
        data, *rest = found if isinstance(found, tuple) else (found,)
        data = {"text/plain": repr(self), "text/html": _NOTE, **(data or {})}
        return (data, *rest) if rest else data

    def _start(self) -> dict[str, Any]:
        _, _, after = self.html.partition(_START)
        return dict(json.loads(after.partition("</script>")[0]))


def live(html: str, path: str | PathLike[str] | None = None) -> Live:
    """Makes the page of a robot, and writes it if a path is given."""
    made = Live(html, ())
    if path is not None:
        made.write(path)
    return made
