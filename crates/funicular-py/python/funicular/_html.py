"""What notebooks show."""

from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from funicular._funicular import Equilibrium, Robot
    from funicular._results import Equilibria, Modes
    from funicular._sweeps import Sweep

# Rows of a table that a notebook shows.
_SHOWN = 40


def _table(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _notes(warnings: Iterable[str]) -> str:
    return "".join(f"<p>Warning: {escape(warning)}</p>" for warning in warnings)


def _point(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.4f}" for value in values)


def robot(of: "Robot") -> str:
    rows = [
        (name, _point(anchor), _point(attachment))
        for name, anchor, attachment in zip(of.cable_names, of.anchors_m, of.attachments_m, strict=True)
    ]
    return (
        f"<p><b>{escape(of.name)}</b>: {of.mass_kg:g} kg, {escape(of.motion)}, {len(rows)} cables</p>"
        f"{_table(('cable', 'anchor [m]', 'attachment [m]'), rows)}<p>{escape(of.source)}</p>"
    )


def equilibrium(of: "Equilibrium") -> str:
    rows = [
        (name, f"{length:.4f}", f"{chord:.4f}", f"{tension:.3f}", f"{anchor:.3f}", f"{sag:.5f}")
        for name, length, chord, tension, anchor, sag in zip(
            of.robot.cable_names, of.lengths, of.chords, of.tensions, of.anchor_tensions, of.sag_ratio, strict=True
        )
    ]
    heads = ("cable", "unstrained [m]", "chord [m]", "T platform [N]", "T anchor [N]", "sag/chord")
    stability = {True: "stable", False: "NOT STABLE", None: "rigid"}[of.stable]
    return (
        f"<p><b>{escape(of.robot.name)}</b> at rest, {of.model} cables: position ({_point(of.pose.position_m)}) m, "
        f"roll, pitch, yaw ({_point(of.pose.roll_pitch_yaw_deg)})°, {stability}</p>"
        f"{_table(heads, rows)}{_notes(of.warnings)}"
    )


def modes(of: "Modes") -> str:
    rows = [
        (
            f"{of.frequency_hz[i]:.4f}",
            f"{100 * of.damping_ratio[i]:.3g}",
            f"{100 * of.platform_energy_fraction[i]:.1f}",
            of.kind[i],
        )
        for i in range(min(len(of), _SHOWN))
    ]
    more = f"<p>and {len(of) - _SHOWN} more</p>" if len(of) > _SHOWN else ""
    certificate = "certified: none is missing" if of.certified else "NOT certified"
    return (
        f"<p><b>{escape(of.robot)}</b>: {len(of)} natural frequencies below {of.below_hz:g} Hz, {certificate}</p>"
        f"{_table(('f [Hz]', 'damping [%]', 'platform [%]', 'kind'), rows)}{more}{_notes(of.warnings)}"
    )


def equilibria(of: "Equilibria") -> str:
    rows = [
        (i, of.status[i], _point(of.position_m[i]), f"{of.tensions[i].min():.3f}", f"{of.tensions[i].max():.3f}")
        for i in range(min(len(of), _SHOWN))
    ]
    more = f"<p>and {len(of) - _SHOWN} more</p>" if len(of) > _SHOWN else ""
    heads = ("state", "status", "position [m]", "least tension [N]", "greatest tension [N]")
    return f"<p>{int(of.ok.sum())} of {len(of)} states have an equilibrium</p>{_table(heads, rows)}{more}"


def sweep(of: "Sweep") -> str:
    units = of.units
    heads = [f"{name} [{units[name]}]" if units[name] else name for name in of.columns]

    def shown(value: object) -> object:
        if value is None or value != value:
            return ""
        return f"{value:.6g}" if isinstance(value, float) else value

    rows = [[shown(column[i]) for column in of.columns.values()] for i in range(min(len(of), _SHOWN))]
    more = f"<p>and {len(of) - _SHOWN} more</p>" if len(of) > _SHOWN else ""
    return f"<p>{int(of.feasible.sum())} of {len(of)} rows are feasible</p>{_table(heads, rows)}{more}"
