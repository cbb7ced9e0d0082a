"""HTML that notebooks show for robots and results."""

from collections.abc import Iterable, Mapping
from html import escape

import numpy as np

from funicular import _show
from funicular._funicular import Equilibrium, Robot
from funicular._results import Equilibria, Modes, Results
from funicular._sweeps import Sweep

# Maximum number of rows of a table in a notebook.
_MAX_ROWS = 40


def _table(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _more(count: int) -> str:
    """Number of rows that the table leaves out."""
    return f"<p>and {count - _MAX_ROWS} more</p>" if count > _MAX_ROWS else ""


def _notes(warnings: Iterable[str]) -> str:
    return "".join(f"<p>Warning: {escape(warning)}</p>" for warning in warnings)


def _point(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.4f}" for value in values)


@_show.html.register
def _robot(of: Robot) -> str:
    rows = [
        (name, _point(anchor), _point(attachment))
        for name, anchor, attachment in zip(of.cable_names, of.anchor_m, of.attachment_m, strict=True)
    ]
    return (
        f"<p><b>{escape(of.name)}</b>: {of.mass_kg:g} kg, {escape(of.motion)}, {len(rows)} cables</p>"
        f"{_table(('cable', 'anchor [m]', 'attachment [m]'), rows)}<p>{escape(of.source)}</p>"
    )


@_show.html.register
def _equilibrium(of: Equilibrium) -> str:
    columns = (of.unstrained_length_m, of.chord_m, of.tension_platform_n, of.tension_anchor_n, of.sag_ratio)
    rows = [
        (name, f"{length:.4f}", f"{chord:.4f}", f"{tension:.3f}", f"{anchor:.3f}", f"{sag:.5f}")
        for name, length, chord, tension, anchor, sag in zip(of.robot.cable_names, *columns, strict=True)
    ]
    heads = ("cable", "unstrained [m]", "chord [m]", "T platform [N]", "T anchor [N]", "sag/chord")
    stability = {True: "stable", False: "NOT STABLE", None: "rigid"}[of.stable]
    return (
        f"<p><b>{escape(of.robot.name)}</b> at rest, {of.static_model} cables: "
        f"position ({_point(of.pose.position_m)}) m, "
        f"roll, pitch, yaw ({_point(of.pose.roll_pitch_yaw_deg)})°, {stability}</p>"
        f"{_table(heads, rows)}{_notes(of.warnings)}"
    )


@_show.html.register
def _modes(of: Modes) -> str:
    rows = [
        (
            f"{of.frequency_hz[i]:.4f}",
            f"{100 * of.damping_ratio[i]:.3g}",
            f"{100 * of.platform_energy_fraction[i]:.1f}",
            of.kind[i],
        )
        for i in range(min(len(of), _MAX_ROWS))
    ]
    certificate = "certified: none is missing" if of.certified else "NOT certified"
    return (
        f"<p><b>{escape(of.robot)}</b>: {len(of)} natural frequencies below {of.below_hz:g} Hz, {certificate}</p>"
        f"{_table(('f [Hz]', 'damping [%]', 'platform [%]', 'kind'), rows)}{_more(len(of))}{_notes(of.warnings)}"
    )


@_show.html.register
def _equilibria(of: Equilibria) -> str:
    tension = of.tension_platform_n
    rows = [
        (i, of.status[i], _point(of.position_m[i]), f"{tension[i].min():.3f}", f"{tension[i].max():.3f}")
        for i in range(min(len(of), _MAX_ROWS))
    ]
    heads = ("state", "status", "position [m]", "minimum tension [N]", "maximum tension [N]")
    found = f"{int(of.ok.sum())} of {len(of)} states have an equilibrium"
    return f"<p>{found}</p>{_table(heads, rows)}{_more(len(of))}"


@_show.html.register
def _sweep(of: Sweep) -> str:
    units = of.units
    heads = [f"{name} [{units[name]}]" if units[name] else name for name in of.columns]

    def shown(value: object) -> object:
        if value is None or value != value:
            return ""
        return f"{value:.6g}" if isinstance(value, float) else value

    rows = [[shown(column[i]) for column in of.columns.values()] for i in range(min(len(of), _MAX_ROWS))]
    feasible = f"{int(of.feasible.sum())} of {len(of)} rows are feasible"
    return f"<p>{feasible}</p>{_table(heads, rows)}{_more(len(of))}"


@_show.html.register
def _results(of: Results) -> str:
    command, warnings = of.get("command", ""), of.get("warnings", [])
    own = {key: value for key, value in of.items() if key not in ("schema", "command", "warnings")}
    return f"<p><b>{escape(str(command))}</b></p>{_mapping(own)}{_notes(warnings)}"


def _mapping(of: Mapping[str, object]) -> str:
    """Table of the keys with one value each, then a table for every list of rows."""
    rows, below = [], []
    for key, value in of.items():
        if isinstance(value, list) and value and all(isinstance(row, Mapping) for row in value):
            below.append(f"<p>{escape(key)}</p>{_rows(value)}")
        elif isinstance(value, Mapping) and any(isinstance(part, (Mapping, list)) for part in value.values()):
            below.append(f"<p>{escape(key)}</p>{_mapping(value)}")
        elif isinstance(value, Mapping):
            rows += [(f"{key}.{name}", _shown(part)) for name, part in value.items()]
        else:
            rows.append((key, _shown(value)))
    return (_table(("key", "value"), rows) if rows else "") + "".join(below)


def _rows(rows: list[Mapping[str, object]]) -> str:
    """Table of rows with the same keys, as far as they have them."""
    heads = list(dict.fromkeys(key for row in rows for key in row))
    cells = [[_shown(row[key]) if key in row else "" for key in heads] for row in rows[:_MAX_ROWS]]
    return _table(heads, cells) + _more(len(rows))


def _shown(value: object) -> str:
    """Short text of a value: long arrays and lists are named by their size."""
    if isinstance(value, np.ndarray):
        return np.array2string(value, precision=5, threshold=12) if value.size <= 12 else f"array {value.shape}"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_shown(part)}" for key, part in value.items())
    if isinstance(value, list):
        return ", ".join(map(_shown, value)) if len(value) <= 12 else f"{len(value)} values"
    return str(value)
