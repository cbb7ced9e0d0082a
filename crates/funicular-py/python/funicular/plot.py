"""Figures of robots, modes and responses by matplotlib or plotly, which are optional.

`robot`, `frf` and `modes` take `backend="matplotlib"` (they return the Axes; `ax=` draws into given Axes) or
`backend="plotly"` (they return the Figure). `bode`, `map` and `shape` draw complete figures for papers by matplotlib and
return the Figure: they have the width of a journal's column, texts of 8 pt, colours that people with any colour vision
can distinguish, and dashes that stay distinct in grey. `save` writes them with embedded fonts. Neither library is
imported before it is used.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from funicular._errors import InputError, needs
from funicular._funicular import (
    Analyses,
    Equilibrium,
    Robot,
    complex_numbers,
    figure_sizes,
    real_numbers,
    robot_of_source,
)
from funicular._hints import hinted
from funicular._reading import read
from funicular._rebuild import equilibrium
from funicular._results import Modes
from funicular._sweeps import Sweep

__all__ = ["WIDTHS_MM", "bode", "frf", "map", "modes", "robot", "save", "shape"]

Backend = Literal["matplotlib", "plotly"]

_WIDTHS, _WIDTH_LIMITS_MM, _FONT_SIZE_LIMITS_PT = figure_sizes()

WIDTHS_MM: Mapping[str, float] = dict(_WIDTHS)
"""Widths of the columns of journals [mm], as in the program's `--figure-width-mm`."""

def _settings(size: float) -> Any:
    """Settings of a figure for a paper with a size of its texts [pt]."""
    texts = ("font.size", "axes.labelsize", "axes.titlesize", "xtick.labelsize", "ytick.labelsize", "legend.fontsize")
    widths = ("axes.linewidth", "xtick.major.width", "ytick.major.width")
    return {
        **dict.fromkeys(texts, size),
        **dict.fromkeys(widths, 0.5),
        "xtick.minor.width": 0.4,
        "ytick.minor.width": 0.4,
        "lines.linewidth": 1.0,
        "hatch.linewidth": 0.4,
        "grid.linewidth": 0.3,
        "grid.color": "#d0d0d0",
        "legend.frameon": False,
        "legend.handlelength": 2.4,
    }


# Colours of Okabe and Ito, which people with any colour vision can distinguish; the dashes stay distinct in grey.
_CURVES = (
    ("#0072b2", "-"),
    ("#d55e00", (0, (5, 2))),
    ("#009e73", (0, (1.2, 1.5))),
    ("#cc79a7", (0, (6, 1.6, 1.2, 1.6))),
    ("#e69f00", (0, (10, 2.5))),
    ("#000000", (0, (6, 1.6, 1.2, 1.6, 1.2, 1.6))),
    ("#56b4e9", (0, (3, 1.4))),
)
# Colour, width and height of the ticks of the modes of a kind below a response.
_TICKS = {"cable": ("#8a8a8a", 0.5, 0.45), "drive": ("#0072b2", 0.65, 0.6), "mixed": ("#009e73", 0.8, 0.75), "platform": ("#d55e00", 1.1, 1.0)}

_KINDS = {"platform": "C0", "mixed": "C1", "cable": "C2", "drive": "C3"}
_COLOURS = {"platform": "#1f77b4", "mixed": "#ff7f0e", "cable": "#2ca02c", "drive": "#d62728"}
_ENERGY = "platform's fraction of the energy"


def _matplotlib() -> tuple[Any, Any]:
    """The library and its pyplot."""
    try:
        import matplotlib
        from matplotlib import pyplot
    except ImportError as error:
        raise needs("this figure", "matplotlib") from error
    return matplotlib, pyplot


def _axes(ax: Any, **keywords: Any) -> Any:
    if ax is not None:
        return ax
    _, pyplot = _matplotlib()
    return pyplot.figure(layout="constrained").add_subplot(**keywords)


def _figures() -> Any:
    try:
        from plotly import graph_objects
    except ImportError as error:
        raise needs("this figure", "plotly") from error
    return graph_objects


def _check(backend: str, ax: Any) -> bool:
    """Checks the choice of a library; True for matplotlib."""
    if backend not in ("matplotlib", "plotly"):
        raise InputError(f'`backend` is "{backend}": it must be matplotlib or plotly')
    if backend == "plotly" and ax is not None:
        raise InputError("`ax` belongs to matplotlib: leave it out with plotly")
    return backend == "matplotlib"


def _inches(width: float | str) -> float:
    """Width of a figure [in] from millimetres or from the name of a column."""
    if isinstance(width, str):
        if width not in WIDTHS_MM:
            raise InputError(f'`width` is "{width}": give millimetres or one of {", ".join(WIDTHS_MM)}')
        width = WIDTHS_MM[width]
    low, high = _WIDTH_LIMITS_MM
    if isinstance(width, bool) or not isinstance(width, (int, float)) or not low <= width <= high:
        raise InputError(f"`width` is {width}: give {low:g} to {high:g} mm or one of {', '.join(WIDTHS_MM)}")
    return width / 25.4


@contextmanager
def _paper(size: float, inches: tuple[float, float], layout: str | None = "constrained") -> Iterator[Any]:
    """New figure of pyplot [in], and the settings of a figure for a paper while it is drawn.

    In notebooks the figure is taken out of pyplot afterwards: the value of a cell shows it, and pyplot would show it a
    second time.
    """
    low, high = _FONT_SIZE_LIMITS_PT
    if isinstance(size, bool) or not isinstance(size, (int, float)) or not low <= size <= high:
        raise InputError(f"`font_size_pt` is {size}: give {low:g} to {high:g} pt")
    matplotlib, pyplot = _matplotlib()
    # Outside of the settings: the first figure chooses the backend of the session and makes notebooks interactive, and
    # the end of the settings would undo that.
    figure = pyplot.figure(figsize=inches, layout=layout)
    try:
        with matplotlib.rc_context(_settings(size)):
            yield figure
    except BaseException:
        pyplot.close(figure)
        raise
    if "inline" in matplotlib.get_backend().lower():
        pyplot.close(figure)


@hinted
def save(figure: Any, path: str | PathLike[str]) -> None:
    """Writes a figure of matplotlib as .svg, .pdf or .png, for a paper.

    Fonts in a PDF are embedded as TrueType, as publishers ask for (matplotlib's default, Type 3, is refused by some).
    Texts in an SVG stay texts. A PNG has 600 dots per inch. The bytes of a PDF or SVG do not depend on the time.
    """
    ending = Path(path).suffix.lower()
    if ending not in (".svg", ".pdf", ".png"):
        raise InputError(f"`path` is {path}: it must end in .svg, .pdf or .png")
    import matplotlib

    metadata = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {}}[ending]
    with matplotlib.rc_context({"pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "funicular"}):
        figure.savefig(path, dpi=600, metadata=metadata)


def _responses(
    hz: ArrayLike,
    response: ArrayLike | Sequence[ArrayLike] | Analyses,
    input: str | Sequence[str] | None,
    output: str | Sequence[str] | None,
    labels: Sequence[str] | None,
    keywords: dict[str, Any],
) -> tuple[NDArray[np.float64], NDArray[np.complex128], list[str], Sequence[str] | None]:
    """Frequencies, responses as rows, a name for each, and the names for a legend."""
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
    return frequencies, curves, names, labels


@hinted
def bode(
    hz: ArrayLike,
    response: ArrayLike | Sequence[ArrayLike] | Analyses,
    input: str | Sequence[str] | None = None,
    output: str | Sequence[str] | None = None,
    *,
    labels: Sequence[str] | None = None,
    unit: str = "",
    modes: Modes | None = None,
    log: bool = False,
    width: float | str = "ieee-single",
    font_size_pt: float = 8,
    **keywords: Any,
) -> Any:
    """Draws magnitude and phase of a response over frequency, with the natural frequencies below, for a paper.

    Parameters
    ----------
    hz
        Frequencies [Hz], ascending.
    response
        Equilibrium, or a robot at the state of its file: its responses of `output` to `input` are computed between the
        first and the last frequency with every peak, as by `frf` here. Or a complex response at the frequencies;
        several responses are rows.
    input, output
        Signals of an equilibrium.
    labels
        Names of the responses in the legend above the figure.
    unit
        Unit of the magnitude.
    modes
        Natural modes, whose frequencies are marked by kind.
    log
        Logarithmic frequencies.
    width
        Width of the figure [mm], or a name of `WIDTHS_MM`.
    font_size_pt
        Size of the texts [pt].
    keywords
        Models and points, as for `Equilibrium.frf`.

    Returns
    -------
    The Figure of matplotlib; its axes are magnitude, phase and, with `modes`, the natural frequencies.
    """
    if modes is not None and isinstance(response, Analyses):
        _check_same(response, modes)
    frequencies, curves, names, labels = _responses(hz, response, input, output, labels, keywords)
    if len(frequencies) < 2 or not np.isfinite(frequencies).all() or not (np.diff(frequencies) > 0).all() or frequencies[0] < 0:
        raise InputError("`hz` has to ascend from zero or more, with at least two frequencies")
    inches = _inches(width)
    with _paper(font_size_pt, (inches, min(0.85 * inches, 4.0))) as figure:
        ratios = [2.0, 1.0] if modes is None else [2.0, 1.0, 0.2]
        axes = figure.subplots(len(ratios), 1, sharex=True, gridspec_kw={"height_ratios": ratios})
        for name, curve, (colour, dashes) in zip(names, curves, _CURVES * (len(curves) // len(_CURVES) + 1)):
            axes[0].semilogy(frequencies, abs(curve), color=colour, linestyle=dashes, label=name)
            phase = np.degrees(np.angle(curve))
            # An undamped response is real; the sign of its zero imaginary part has no meaning.
            phase[phase <= -179.99] = 180.0
            # Gaps where the phase wraps, so that no line crosses the figure.
            wraps = np.flatnonzero(abs(np.diff(phase)) > 270) + 1
            at = np.insert(frequencies, wraps, np.nan)
            axes[1].plot(at, np.insert(phase, wraps, np.nan), color=colour, linestyle=dashes)
        axes[0].set_ylabel(f"magnitude{f' [{unit}]' if unit else ''}")
        axes[1].set(ylabel="phase [°]", ylim=(-190, 190), yticks=[-180, -90, 0, 90, 180])
        if log:
            axes[0].set_xscale("log")
        axes[0].set_xlim(frequencies[0], frequencies[-1])
        handles, texts = axes[0].get_legend_handles_labels() if labels is not None else ([], [])
        if modes is not None:
            for kind, (colour, line, height) in _TICKS.items():
                inside = (modes.frequency_hz >= frequencies[0]) & (modes.frequency_hz <= frequencies[-1])
                chosen = modes.frequency_hz[(modes.kind == kind) & inside]
                if len(chosen):
                    handles.append(axes[2].vlines(chosen, 0, height, color=colour, linewidth=line))
                    texts.append(f"{kind} mode")
            axes[2].set(ylim=(0, 1), yticks=[])
        axes[-1].set_xlabel("frequency [Hz]")
        _legend_above(figure, handles, texts, inches / font_size_pt)
        figure.align_ylabels()
        return figure


def _check_same(of: Analyses, modes: Modes) -> None:
    """Refuses modes of another robot or of another equilibrium, which would be drawn as if they belonged together."""
    rest = of.equilibrium() if isinstance(of, Robot) else of
    assert isinstance(rest, Equilibrium)
    if modes._request is None:
        same = modes.robot == rest.robot.name and modes.cable_names == tuple(rest.robot.cable_names)
    else:
        request = json.loads(modes._request)
        state = {key: request[key] for key in _OF_STATE if key in request}
        same = rest == equilibrium(robot_of_source(json.dumps(request["robot"])), json.dumps(state))
    if not same:
        raise InputError(
            f"`modes` are those of another equilibrium than `{rest!r}`, or of another robot: give those that its method "
            "`modes` returns"
        )


# Keys of a request that give the equilibrium.
_OF_STATE = (
    *("lengths_m", "pose", "hold_lengths_of_pose", "mass_kg", "static_model", "force_n", "moment_n_m", "load_point_m"),
    *("wind_m_s", "cable_load_n_per_m", "tension_rule", "target_tension_n", "min_tension_n", "max_tension_n"),
)


def _legend_above(figure: Any, handles: list[Any], texts: list[str], sizes: float) -> None:
    """Puts a legend above all axes, in as many columns as fit the width."""
    if not texts:
        return
    # Widths in inches per point of the size: a letter takes 0.008, a sample and the space around it 0.0625.
    column = 0.008 * max(len(text) for text in texts) + 0.0625
    columns = max(1, min(len(texts), int(sizes / column)))
    figure.legend(handles, texts, loc="outside upper left", ncols=columns, borderaxespad=0.2, columnspacing=1.2)


@hinted
def map(
    of: Sweep,
    column: str,
    *,
    at: Mapping[str, float] | None = None,
    plane: tuple[str, str] | None = None,
    levels: int | Sequence[float] = 7,
    label: str | None = None,
    log: bool = False,
    width: float | str = "ieee-single",
    font_size_pt: float = 8,
) -> Any:
    """Draws a slice of a grid with contours and hatched infeasible cells, for a paper.

    Parameters
    ----------
    of
        Rows of `Robot.map` or `Robot.sweep` over two or more axes.
    column
        Name of the column, such as `tension_max_n`.
    at
        Values of the other axes; the middle of an axis that is not given.
    plane
        Horizontal and vertical axis; the two axes with most values by default.
    levels
        Number of contours, about, or their values.
    label
        Title of the colour bar; the name of the column with its unit by default.
    log
        Logarithmic colours.
    width
        Width of the figure [mm], or a name of `WIDTHS_MM`.
    font_size_pt
        Size of the texts [pt].

    Returns
    -------
    The Figure of matplotlib; its axes are the map and the colour bar.
    """
    axes, values, feasible = _grid(of, column)
    names = list(axes)
    h, v = plane if plane is not None else _widest(axes)
    for name in (h, v, *(at or {})):
        if name not in names:
            raise InputError(f'"{name}" is no axis of these rows: they have {", ".join(names)}')
    if h == v:
        raise InputError(f'`plane` has "{h}" twice: give two axes')
    index = [slice(None) if name in (h, v) else _nearest(name, axes[name], at) for name in reversed(names)]
    if at and (h in at or v in at):
        raise InputError(f"`at` gives a value for an axis of the slice itself: {h} and {v} are shown completely")
    shown, good = values[tuple(index)], feasible[tuple(index)]
    if names.index(h) > names.index(v):
        shown, good = shown.T, good.T
    if not np.isfinite(shown).any():
        raise InputError(f"the slice has no value of {column}: choose another with `at`")

    unit = of.units.get(column, "")
    title = label or _title(column, unit)
    x, y = axes[h], axes[v]
    inches = _inches(width)
    lengths = all(_unit(of, name) == "m" for name in (h, v))
    ratio = (y[-1] - y[0]) / (x[-1] - x[0])
    equal = lengths and 0.25 < ratio < 4
    with _paper(font_size_pt, (inches, min((0.72 * ratio if equal else 0.6) * inches + 0.5, 7.0))) as figure:
        from matplotlib import collections, colormaps, patches
        from matplotlib.colors import LinearSegmentedColormap, LogNorm

        ax = figure.add_subplot(aspect="equal" if equal else "auto")
        norm = LogNorm() if log else None
        masked = np.ma.masked_invalid(shown)
        # The lightness falls evenly; the darkest part is left out so that contours stay visible.
        shades = colormaps["plasma_r"](np.linspace(0.08, 0.75, 256))
        colours = LinearSegmentedColormap.from_list("light", shades)
        drawn = ax.pcolormesh(x, y, masked, shading="nearest", cmap=colours, norm=norm, rasterized=shown.size > 20_000)
        if np.ptp(masked.compressed()) > 0 and min(shown.shape) > 1:
            lines = ax.contour(x, y, masked, levels, colors="black", linewidths=0.6)
            ax.clabel(lines, fontsize=0.875 * font_size_pt)
        legend: tuple[list[Any], list[str]] = ([], [])
        if not good.all():
            grey: Any = {"facecolor": "none", "edgecolor": "#707070", "hatch": "////", "linewidth": 0}
            ax.add_collection(collections.PolyCollection(_cells(x, y, ~good), **grey), autolim=False)
            legend = ([patches.Patch(**grey)], ["infeasible"])
        ax.set(xlabel=_axis_title(of, h), ylabel=_axis_title(of, v))
        figure.colorbar(drawn, ax=ax, label=title)
        _legend_above(figure, *legend, inches / font_size_pt)
        return figure


def _grid(of: Sweep, column: str) -> tuple[dict[str, NDArray[np.float64]], NDArray[np.float64], NDArray[np.bool_]]:
    """Axes with more than one value, ascending; the column and the feasibility, one dimension per axis, the last first."""
    plan = of.plan
    axes = {}
    for axis in plan.get("grid", plan.get("vary", [])):
        values = np.array(axis["values"], dtype=float) if "values" in axis else None
        axes[axis["axis"]] = np.linspace(axis["from"], axis["to"], axis["count"]) if values is None else values
    axes = {name: values for name, values in axes.items() if len(values) > 1}
    if len(axes) < 2:
        raise InputError(f"these rows have {len(axes)} axes with more than one value: a map needs two")
    shape = [len(values) for values in reversed(axes.values())]
    if not of.complete or len(of) != np.prod(shape):
        raise InputError(f"the grid is not complete: {len(of)} of {np.prod(shape)} rows are there")
    if column not in of.columns:
        raise InputError(f'the rows have no column "{column}": they have {", ".join(of.columns)}')
    values = of[column]
    if values.dtype.kind != "f":
        raise InputError(f'column "{column}" has no numbers')
    grids = [values.reshape(shape), of.feasible.reshape(shape)]
    # Values in any order are sorted, as cells need it.
    for dimension, name in enumerate(reversed(axes)):
        order = np.argsort(axes[name])
        grids = [np.take(grid, order, axis=dimension) for grid in grids]
        axes[name] = axes[name][order]
    return axes, grids[0], grids[1]


def _widest(axes: Mapping[str, NDArray[np.float64]]) -> tuple[str, str]:
    """The two axes with most values, in their order."""
    most = sorted(axes, key=lambda name: -len(axes[name]))[:2]
    first, second = (name for name in axes if name in most)
    return first, second


def _nearest(name: str, values: NDArray[np.float64], at: Mapping[str, float] | None) -> int:
    """Index of the value of an axis at which a slice lies."""
    if at is None or name not in at:
        return (len(values) - 1) // 2
    wanted = read("", "minimum", at[name], name=f'at["{name}"]')
    k = int(np.argmin(abs(values - wanted)))
    if abs(values[k] - wanted) > 1e-6 * np.ptp(values):
        raise InputError(f"`at` gives {name} = {wanted}: the nearest value of these rows is {values[k]:g}")
    return k


def _unit(of: Sweep, name: str) -> str:
    """Unit of an axis."""
    for column, unit in of.units.items():
        if column in (name, f"{name}_{unit}"):
            return unit
    return ""


def _axis_title(of: Sweep, name: str) -> str:
    """Title of an axis with its unit, such as `x [m]` or `platform mass [kg]`."""
    return _title(name, _unit(of, name))


def _title(name: str, unit: str) -> str:
    """Name of a quantity without the unit at its end, then the unit in brackets: `tension max [N]`."""
    ending = unit.lower().replace("/", "_per_").replace(" ", "_").replace("·", "_")
    words = name.removesuffix(f"_{ending}") if ending else name
    words = words.replace(".", " ").replace("_", " ")
    return words + (f" [{'°' if unit == 'deg' else unit}]" if unit not in ("", "1") else "")


def _cells(x: NDArray[np.float64], y: NDArray[np.float64], chosen: NDArray[np.bool_]) -> list[NDArray[np.float64]]:
    """Rectangles of the chosen cells; neighbours in a row are one rectangle."""

    def edges(values: NDArray[np.float64]) -> NDArray[np.float64]:
        middle = (values[1:] + values[:-1]) / 2
        return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])

    of_x, of_y = edges(x), edges(y)
    cells = []
    for j, row in enumerate(chosen):
        changes = np.flatnonzero(np.diff(np.concatenate([[False], row, [False]]).astype(int)))
        for i, k in changes.reshape(-1, 2):
            low, high, left, right = of_y[j], of_y[j + 1], of_x[i], of_x[k]
            cells.append(np.array([[left, low], [right, low], [right, high], [left, high]]))
    return cells


def _joined(names: Sequence[str], points: NDArray[np.float64]) -> list[str]:
    """Names at points; those of close neighbours are joined at the first of them, so that no name covers another."""
    reach = np.linalg.norm(np.ptp(points, axis=0))
    close = np.linalg.norm(points[:, None] - points[None], axis=2) < 0.08 * reach
    taken: set[int] = set()
    labels = []
    for i in range(len(names)):
        here = [j for j in range(len(names)) if close[i, j] and j not in taken]
        labels.append("" if i in taken else ", ".join(names[j] for j in here))
        taken.update(here if i not in taken else [])
    return labels


@hinted
def shape(
    of: Equilibrium,
    modes: Modes,
    mode: int,
    *,
    amplitude: float | None = None,
    width: float | str = "ieee-single",
    font_size_pt: float = 8,
) -> Any:
    """Draws the robot in one of its modes, with its hanging cables, beside its equilibrium, for a paper.

    Parameters
    ----------
    of
        Equilibrium of the modes.
    modes
        Modes with the motion of the cables: `of.modes(below_hz, stations=65)`.
    mode
        Row of the mode in `modes`, from 0.
    amplitude
        Factor on the scale of `modes.shape`; by default the largest displacement is 6 % of the robot's diagonal, or
        less where the platform would turn by more than 0.3 rad.
    width
        Width of the figure [mm], or a name of `WIDTHS_MM`.
    font_size_pt
        Size of the texts [pt].

    Returns
    -------
    The Figure of matplotlib with one axis in space; all axes have one scale [m].
    """
    if modes.cable_shapes is None or modes.cable_axes is None or modes.station_position_m is None:
        raise InputError("these modes have no motion of the cables: compute them with `stations=65`")
    row = read("", "count", mode, name="mode")
    if row >= len(modes):
        raise InputError(f"`mode` is {mode}: there are {len(modes)} modes, from 0")
    mode = row
    _check_same(of, modes)
    rest = modes.station_position_m
    moved = np.einsum("csk,ckw->csw", modes.cable_shapes[mode], modes.cable_axes)
    origin, motion = of.pose.position_m, modes.shape[mode]
    corners = rest[:, 0]
    rigid = motion[:3] + np.cross(motion[3:], corners - origin)
    if amplitude is None:
        largest = max(np.linalg.norm(moved, axis=2).max(), np.linalg.norm(rigid, axis=1).max())
        diagonal = np.linalg.norm(np.ptp(rest.reshape(-1, 3), axis=0))
        turn = np.linalg.norm(motion[3:])
        amplitude = min(0.06 * diagonal / largest, 0.3 / turn if turn > 0 else np.inf) if largest > 0 else 0.0
    inches = _inches(width)
    with _paper(font_size_pt, (inches, 0.72 * inches), layout=None) as figure:
        ax = figure.add_axes((0.02, 0.0, 0.9, 0.9), projection="3d", computed_zorder=False)
        for k, (cable, displacement) in enumerate(zip(rest, moved, strict=True)):
            ax.plot(*cable.T, color="#8a8a8a", linewidth=0.5, linestyle=(0, (4, 2)), label="equilibrium" if k == 0 else None)
            ax.plot(*(cable + amplitude * displacement).T, color="#0072b2", label="cables" if k == 0 else None)
        # The platform as lines between its attachments and the origin of its frame.
        for points, shift, colour, line in (
            (corners, None, "#8a8a8a", 0.5),
            (corners + amplitude * rigid, amplitude * motion[:3], "#d55e00", 1.0),
        ):
            centre = origin if shift is None else origin + shift
            spokes = np.stack([point for corner in points for point in (centre, corner, np.full(3, np.nan))])
            ax.plot(*spokes.T, color=colour, linewidth=line, label="platform" if shift is not None else None)
        anchors = of.robot.anchor_m
        ax.scatter(*anchors.T, color="black", s=5, depthshade=False)
        for name, point in zip(_joined(of.robot.cable_names, anchors), anchors, strict=True):
            ax.text(*point, f" {name}", fontsize=0.875 * font_size_pt)
        ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
        ax.set_aspect("equal")
        ax.set_proj_type("ortho")
        ax.view_init(elev=18, azim=-67)
        ax.tick_params(pad=-1, labelsize=0.875 * font_size_pt)
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
            axis.labelpad = -1
            axis.pane.set_facecolor("white")
        ax.locator_params(nbins=4)
        title = f"mode {mode % len(modes) + 1}: {modes.frequency_hz[mode]:.3f} Hz, {modes.kind[mode]}"
        figure.text(0.02, 0.93, title)
        ax.legend(loc="upper left", bbox_to_anchor=(0.0, 0.92), bbox_transform=figure.transFigure, ncols=3)
        return figure


@hinted
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


@hinted
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
    frequencies, curves, names, labels = _responses(hz, response, input, output, labels, keywords)
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


@hinted
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
