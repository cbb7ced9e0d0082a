"""Results as tables of pandas."""

from typing import Any

import numpy as np

from funicular import _show
from funicular._errors import InputError, needs
from funicular._funicular import Answered, Equilibrium
from funicular._pages import Answer
from funicular._results import Equilibria, Modes, Results
from funicular._sweeps import Sweep

_MOTIONS = ("x", "y", "z", "rx_per_m", "ry_per_m", "rz_per_m")


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise needs("a table", "pandas") from error
    return pandas


@_show.table.register
def _cables(of: Equilibrium) -> Any:
    rows = []
    for cable in of.cables:
        force = cable.pop("force_on_platform_n")
        components = zip("xyz", force, strict=True)
        drive = cable.pop("drive", None)
        rows.append(cable | {f"force_on_platform_{axis}_n": component for axis, component in components})
        if drive is not None:
            point, direction = drive.pop("exit_m"), drive.pop("swivel_direction", None)
            rows[-1] |= {f"exit_{axis}_m": component for axis, component in zip("xyz", point, strict=True)}
            if direction is not None:
                rows[-1] |= {f"swivel_{axis}": component for axis, component in zip("xyz", direction, strict=True)}
            rows[-1] |= drive
    return _pandas().DataFrame(rows).set_index("name")


@_show.table.register
def _modes(of: Modes) -> Any:
    columns: dict[str, Any] = {
        "frequency_hz": of.frequency_hz,
        "multiplicity": of.multiplicity,
        "damping_ratio": of.damping_ratio,
        "decay_time_s": of.decay_time_s,
    }
    if of.eigenvalue_per_s is not None:
        columns["eigenvalue_per_s"] = of.eigenvalue_per_s

    columns |= {"kind": of.kind, "platform_energy_fraction": of.platform_energy_fraction}
    columns |= {f"shape_{motion}": of.shape[:, i] for i, motion in enumerate(_MOTIONS)}
    columns |= {"modal_mass_kg": of.modal_mass_kg, "residual": of.residual}
    if of.peak is not None:
        columns |= {"residue_per_kg": of.residue_per_kg, "peak": of.peak}

    columns |= {
        f"energy_fraction_cable_{name}": of.cable_energy_fractions[:, i] for i, name in enumerate(of.cable_names)
    }
    if of.drive_energy_fractions.any():
        columns |= {
            f"energy_fraction_drive_{name}": of.drive_energy_fractions[:, i] for i, name in enumerate(of.cable_names)
        }
    columns |= {
        f"energy_fraction_support_{name}": of.support_energy_fractions[:, i] for i, name in enumerate(of.support_names)
    }
    if of.stretching_share is not None:
        columns |= {f"stretching_share_cable_{name}": of.stretching_share[:, i] for i, name in enumerate(of.cable_names)}
    return _pandas().DataFrame(columns)


@_show.table.register
def _equilibria(of: Equilibria) -> Any:
    columns: dict[str, Any] = {"status": of.status, "reason": np.asarray(of.reason, dtype=object)}
    columns |= {f"position_{axis}_m": of.position_m[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"{angle}_deg": of.roll_pitch_yaw_deg[:, i] for i, angle in enumerate(("roll", "pitch", "yaw"))}

    # The number of the cable stands before the unit, as in the columns of a sweep.
    for name, unit, values in (
        ("unstrained_length", "_m", of.unstrained_length_m),
        ("tension_platform", "_n", of.tension_platform_n),
        ("tension_anchor", "_n", of.tension_anchor_n),
        ("sag_ratio", "", of.sag_ratio),
    ):
        columns |= {f"{name}_{i + 1}{unit}": values[:, i] for i in range(values.shape[1])}

    columns["residual"] = of.residual
    if of.stable is not None:
        columns["stable"] = of.stable
    columns |= {
        "stiffness_min_n_per_m": of.stiffness_min_n_per_m,
        "nearest_pose_distance_m": of.nearest_pose_distance_m,
    }
    return _pandas().DataFrame(columns)


@_show.table.register
def _answer(of: Answer) -> Any:
    return _columns(of._answered)


@_show.table.register
def _results(of: Results) -> Any:
    if of._answered is None:
        raise InputError(f"the results of {of.get('command', 'this command')} have no table: read their keys")
    return _columns(of._answered)


def _columns(answered: Answered) -> Any:
    """Columns of the program's CSV."""
    columns = answered.table()
    table = _pandas().DataFrame({name: values for name, _, values in columns})
    table.attrs["units"] = {name: unit for name, unit, _ in columns if unit}
    return table


@_show.table.register
def _sweep(of: Sweep) -> Any:
    table = _pandas().DataFrame(dict(of.columns))
    table.attrs["units"] = of.units
    return table
