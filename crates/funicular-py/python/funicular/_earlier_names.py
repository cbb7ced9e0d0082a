"""Attributes of earlier versions: each raises AttributeError with the name that it has now."""

from typing import NoReturn

from funicular._funicular import Equilibrium, Robot
from funicular._results import Equilibria

_OF_STATES = {
    "lengths": "unstrained_length_m",
    "tensions": "tension_platform_n",
    "anchor_tensions": "tension_anchor_n",
    "model": "static_model",
}

EARLIER_NAMES: dict[type, dict[str, str]] = {
    Robot: {"lengths": "lengths_m", "anchors_m": "anchor_m", "attachments_m": "attachment_m"},
    Equilibrium: {**_OF_STATES, "forces": "force_on_platform_n", "chords": "chord_m"},
    Equilibria: _OF_STATES,
}
"""Earlier names of attributes and the present ones, per class."""


def _missing(self: object, name: str) -> NoReturn:
    """`__getattr__` of the classes above: Python calls it only for attributes that do not exist."""
    kind = type(self)
    message = f"{kind.__name__!r} object has no attribute {name!r}"
    present = EARLIER_NAMES.get(kind, {}).get(name)
    if present is not None:
        message += f": it is now called {present!r}"
    raise AttributeError(message, name=name, obj=self)


# Assigned here and not written into the classes: type checkers would take `__getattr__` for permission to use any name.
for _kind in EARLIER_NAMES:
    setattr(_kind, "__getattr__", _missing)  # noqa: B010  # mypy refuses the plain assignment
