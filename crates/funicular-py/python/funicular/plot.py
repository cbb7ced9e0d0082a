"""Figures of robots, modes and responses by matplotlib or plotly, which are optional.

Every function takes `backend="matplotlib"` (it returns the Axes; `ax=` draws into given Axes) or `backend="plotly"` (it
returns the Figure). Neither library is imported before it is used.
"""

from collections.abc import Sequence
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from funicular._errors import InputError
from funicular._funicular import Analyses, Equilibrium, complex_numbers, real_numbers
from funicular._results import Modes

__all__ = ["frf", "modes", "robot"]

Backend = Literal["matplotlib", "plotly"]

_KINDS = {"platform": "C0", "mixed": "C1", "cable": "C2"}
_COLOURS = {"platform": "#1f77b4", "mixed": "#ff7f0e", "cable": "#2ca02c"}
_ENERGY = "platform's fraction of the energy"


def _axes(ax: Any, **keywords: Any) -> Any:
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("this figure needs matplotlib: pip install 'funicular[matplotlib]'") from error
    return pyplot.figure(layout="constrained").add_subplot(**keywords)


def _figures() -> Any:
    try:
        from plotly import graph_objects
    except ImportError as error:
        raise ImportError("this figure needs plotly: pip install 'funicular[plotly]'") from error
    return graph_objects


def _check(backend: str, ax: Any) -> bool:
    """Checks the choice of a library; True for matplotlib."""
    if backend not in ("matplotlib", "plotly"):
        raise InputError(f'`backend` is "{backend}": it must be matplotlib or plotly')
    if backend == "plotly" and ax is not None:
        raise InputError("`ax` belongs to matplotlib: leave it out with plotly")
    return backend == "matplotlib"


def robot(of: Equilibrium, *, points: int = 33, backend: Backend = "matplotlib", ax: Any = None) -> Any:
    """Draws an equilibrium in space: hanging cables, anchors, and attachments joined to the origin of the platform [m].

    All axes have one scale.
    """
    curves = of.cable_points(points)
    origin, anchors = of.pose.position_m, of.robot.anchor_m
    platform = np.stack([point for curve in curves for point in (origin, curve[0], np.full(3, np.nan))])
    names = of.robot.cable_names
    if _check(backend, ax):
        ax = _axes(ax, projection="3d")
        for name, curve in zip(names, curves, strict=True):
            ax.plot(*curve.T, color="C0", linewidth=1, label=f"cable {name}")
        ax.plot(*platform.T, color="C3", linewidth=2, label="platform")
        ax.scatter(*anchors.T, color="black", s=12, label="anchors")
        ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", title=of.robot.name)
        ax.set_aspect("equal")
        return ax
    go = _figures()
    lines = [
        go.Scatter3d(x=x, y=y, z=z, mode="lines", name=f"cable {name}", line={"color": "#1f77b4", "width": 3})
        for name, (x, y, z) in zip(names, curves.transpose(0, 2, 1), strict=True)
    ]
    x, y, z = platform.T
    lines.append(go.Scatter3d(x=x, y=y, z=z, mode="lines", name="platform", line={"color": "#d62728", "width": 6}))
    x, y, z = anchors.T
    lines.append(go.Scatter3d(x=x, y=y, z=z, mode="markers", name="anchors", marker={"color": "black", "size": 3}))
    figure = go.Figure(lines)
    figure.update_layout(title=of.robot.name, scene={"aspectmode": "data"}, showlegend=False)
    return figure


def frf(
    hz: ArrayLike,
    response: ArrayLike | Sequence[ArrayLike] | Analyses,
    input: str | Sequence[str] | None = None,
    output: str | Sequence[str] | None = None,
    *,
    labels: Sequence[str] | None = None,
    unit: str = "",
    backend: Backend = "matplotlib",
    ax: Any = None,
    **keywords: Any,
) -> Any:
    """Draws the magnitude of a response over frequency on a logarithmic scale.

    `response` is an equilibrium (or a robot, at the state of its file), whose responses of `output` to `input` are
    computed between the first and the last of the frequencies `hz` with every peak, as `Equilibrium.frf` does with
    `adaptive=True`; `keywords` are those of `Equilibrium.frf`. Or it is an array of a response at `hz`, which is drawn
    as it is; several responses are then the rows of the array.

    `labels` has a name per response; several responses of an equilibrium have the names of output and input if it is
    not given.
    """
    if isinstance(response, Analyses):
        if input is None or output is None:
            raise InputError("`response` is an equilibrium: give `input` and `output` too")
        frequencies, values = response.frf(hz, input, output, adaptive=True, **keywords)
        curves: NDArray[np.complex128] = values.reshape(-1, len(frequencies))
        if labels is None and len(curves) > 1:
            inputs, outputs = ([of] if isinstance(of, str) else of for of in (input, output))
            labels = [f"{to} / {of}" for to in outputs for of in inputs]
    else:
        if input is not None or output is not None or keywords:
            raise InputError("`response` is an array: `input`, `output` and models belong to an equilibrium")
        frequencies = real_numbers("hz", hz)
        curves = np.atleast_2d(complex_numbers("response", cast(ArrayLike, response)))
    names = [f"response {i + 1}" for i in range(len(curves))] if labels is None else list(labels)
    if curves.shape[1:] != frequencies.shape or len(names) != len(curves):
        raise InputError(
            f"frequencies of shape {frequencies.shape} and {len(names)} labels for responses of shape {curves.shape}: "
            "give a row of frequencies, and for each response a row of as many values and a label"
        )
    magnitude = f"magnitude{f' [{unit}]' if unit else ''}"
    if _check(backend, ax):
        ax = _axes(ax)
        for name, curve in zip(names, curves, strict=True):
            ax.semilogy(frequencies, abs(curve), linewidth=1, label=name)
        ax.set(xlabel="frequency [Hz]", ylabel=magnitude)
        if labels is not None:
            ax.legend()
        return ax
    go = _figures()
    figure = go.Figure(
        [go.Scatter(x=frequencies, y=abs(curve), name=name) for name, curve in zip(names, curves, strict=True)]
    )
    figure.update_layout(xaxis_title="frequency [Hz]", yaxis_title=magnitude, showlegend=labels is not None)
    figure.update_yaxes(type="log")
    return figure


def modes(of: Modes, *, backend: Backend = "matplotlib", ax: Any = None) -> Any:
    """Draws the natural frequencies, coloured by kind, over the platform's fraction of the kinetic energy."""
    if _check(backend, ax):
        ax = _axes(ax)
        for kind, colour in _KINDS.items():
            chosen = of.kind == kind
            if chosen.any():
                ax.vlines(of.frequency_hz[chosen], 0, of.platform_energy_fraction[chosen], color=colour, linewidth=1)
                fraction = of.platform_energy_fraction[chosen]
                ax.plot(of.frequency_hz[chosen], fraction, "o", ms=3, color=colour, label=kind)
        ax.set(xlabel="frequency [Hz]", ylabel=_ENERGY, xlim=(0, of.below_hz), ylim=(0, 1.05))
        ax.legend()
        return ax
    go = _figures()
    figure = go.Figure()
    for kind, colour in _COLOURS.items():
        chosen = of.kind == kind
        if chosen.any():
            x, y = of.frequency_hz[chosen], of.platform_energy_fraction[chosen]
            down = {"type": "data", "symmetric": False, "array": np.zeros(len(y)), "arrayminus": y, "width": 0}
            figure.add_scatter(x=x, y=y, mode="markers", name=kind, marker_color=colour, error_y=down)
    figure.update_layout(xaxis_title="frequency [Hz]", yaxis_title=_ENERGY)
    return figure
