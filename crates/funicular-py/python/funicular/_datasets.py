"""Results as datasets of xarray, which writes them as NetCDF."""

import json
import math
from typing import Any

import numpy as np

from funicular import _show
from funicular._errors import InputError, needs
from funicular._results import Modes, Results
from funicular._sweeps import Sweep

_MOTIONS = ("x", "y", "z", "rx", "ry", "rz")
# Keys of results whose rows the other keys of the same length belong to.
_ALONG = ("frequency_hz", "time_s", "t_s")
# Units by the endings of keys, the longest first.
_UNITS = {
    "_n_m_per_rad": "N m/rad", "_n_per_m": "N/m", "_kg_m2": "kg m2", "_m_s2": "m/s2", "_rad_s": "rad/s", "_per_kg": "1/kg",
    "_percent": "%", "_per_s": "1/s", "_m_s": "m/s", "_n_m": "N m", "_rad": "rad", "_deg": "deg", "_hz": "Hz", "_kg": "kg",
    "_db": "dB", "_n": "N", "_m": "m", "_s": "s", "_w": "W", "_j": "J",
}  # fmt: skip


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise needs("a dataset", "xarray") from error
    return xarray


def _unit(name: str) -> str:
    """Unit that the ending of a name gives; empty for a number without unit."""
    return next((unit for ending, unit in _UNITS.items() if name.endswith(ending)), "")


def _attributes(unit: str, about: str = "") -> dict[str, str]:
    """Attributes of a variable, with the names of the conventions for climate and forecast (CF)."""
    return {key: text for key, text in (("units", unit), ("long_name", about)) if text}


def _texts(values: Any) -> Any:
    """Texts as NetCDF holds them: a missing one is empty."""
    return np.array(["" if value is None else str(value) for value in values], dtype=str)


@_show.dataset.register
def _sweep(of: Sweep) -> Any:
    plan, columns = of.plan, of.columns
    names = list(columns)
    coordinates = names[: names.index("feasible")]
    axes = plan.get("grid", plan.get("vary", []))
    attrs = {"title": plan["robot"], "source": f"funicular {plan['command']}", "plan": json.dumps(plan), "robot": of.robot.to_toml()}

    if not axes:
        shape, dims = (len(of),), ("row",)
        coords: dict[str, Any] = {name: (dims, columns[name], _attributes(of.units[name], of.about[name])) for name in coordinates}
    else:
        counts = [axis["count"] if "count" in axis else len(axis["values"]) for axis in axes]
        of._check_grid(math.prod(counts))
        # The first axis runs fastest.
        varied = [(axis["axis"], count) for axis, count in zip(axes, counts, strict=True) if count > 1]
        dims, shape = tuple(axis for axis, _ in reversed(varied)), tuple(count for _, count in reversed(varied))
        coords = {}
        for axis, count, name in zip(axes, counts, coordinates, strict=True):
            dim = axis["axis"]
            if count > 1:
                values = np.moveaxis(columns[name].reshape(shape), dims.index(dim), 0).reshape(count, -1)[:, 0]
            else:
                values = columns[name][0]
            coords[dim] = (dim if count > 1 else (), values, _attributes(of.units[name], of.about[name]))

    variables = {}
    for name in names[len(coordinates) :]:
        values = columns[name]
        values = _texts(values) if values.dtype == object else values
        variables[name] = (dims, values.reshape(shape), _attributes(of.units[name], of.about[name]))
    return _xarray().Dataset(variables, coords, attrs)


@_show.dataset.register
def _modes(of: Modes) -> Any:
    cables, supports = ("mode", "cable"), ("mode", "support")
    dims: dict[str, tuple[str, ...]] = {
        "frequency_hz": ("mode",), "multiplicity": ("mode",), "damping_ratio": ("mode",), "decay_time_s": ("mode",), "kind": ("mode",),
        "platform_energy_fraction": ("mode",), "cable_energy_fractions": cables, "drive_energy_fractions": cables,
        "support_energy_fractions": supports, "stretching_share": cables, "shape": ("mode", "motion"), "modal_mass_kg": ("mode",),
        "residual": ("mode",), "residue_per_kg": ("mode",), "peak": ("mode",), "station_arc_length_m": ("cable", "station"),
        "station_position_m": ("cable", "station", "axis"), "cable_axes": ("cable", "direction", "axis"),
        "cable_shapes": ("mode", "cable", "station", "direction"),
    }  # fmt: skip
    variables = {}
    for name, along in dims.items():
        values = getattr(of, name)
        if values is not None and values.size > 0:
            unit = of.peak_unit or "" if name == "peak" else _unit(name)
            variables[name] = (along, _texts(values) if values.dtype.kind == "U" else values, _attributes(unit))
    # NetCDF has no complex numbers.
    if of.eigenvalue_per_s is not None:
        variables["eigenvalue_real_per_s"] = (("mode",), of.eigenvalue_per_s.real, _attributes("1/s"))
        variables["eigenvalue_imag_per_s"] = (("mode",), of.eigenvalue_per_s.imag, _attributes("1/s"))

    used = {dim for along, *_ in variables.values() for dim in along}
    labels = {
        "mode": np.arange(1, len(of) + 1), "cable": _texts(of.cable_names), "support": _texts(of.support_names),
        "motion": _texts(_MOTIONS), "axis": _texts("xyz"), "direction": _texts(("chord", "in plane", "out of plane")),
    }  # fmt: skip
    coords = {dim: values for dim, values in labels.items() if dim in used}
    attrs = {
        "title": of.robot, "source": "funicular modes", "static_model": of.static_model, "cable_model": of.cable_model,
        "below_hz": of.below_hz, "count_below": of.count_below, "certified": int(of.certified),
    }  # fmt: skip
    return _xarray().Dataset(variables, coords, attrs)


@_show.dataset.register
def _results(of: Results) -> Any:
    along = next((key for key in _ALONG if np.ndim(of.get(key, 0)) == 1), None)
    variables: dict[str, Any] = {}
    attrs: dict[str, Any] = {"title": str(of.get("robot", "")), "source": f"funicular {of.get('command', '')}".strip()}

    def add(name: str, dims: tuple[str, ...], values: list[Any], unit: str) -> None:
        array = _texts(values) if all(isinstance(value, str) for value in values) else np.array(values)
        variables[name] = (dims, array, _attributes(unit))

    for key, value in of.items():
        listed = list(value) if isinstance(value, list | np.ndarray) else []
        if listed and isinstance(listed[0], dict):
            # Rows: one variable per column. Responses have their own names, since they are the result itself.
            prefix, dim = ("", "response") if key == "responses" else (f"{key}_", key)
            for column in listed[0]:
                cells = [row.get(column) for row in listed]
                if all(isinstance(cell, str | int | float) for cell in cells):
                    add(prefix + column, (dim,), cells, _unit(column))
                elif along is not None and all(np.shape(cell) == np.shape(of[along]) for cell in cells if not isinstance(cell, dict)):
                    add(prefix + column, (dim, along), cells, "")
        elif listed and along is not None and np.shape(value) == np.shape(of[along]):
            add(key, (along,), listed, _unit(key) or str(of.get("unit", "")) * (key in ("real", "imag", "magnitude")))
        elif isinstance(value, str | int | float) and key not in ("schema", "command", "robot"):
            attrs[key] = int(value) if isinstance(value, bool) else value
        elif listed and np.array(listed).dtype.kind in "if":
            attrs[key] = np.ravel(np.array(listed))
    if not variables:
        raise InputError(f"the results of {of.get('command', 'this command')} hold no rows: read their keys")
    return _xarray().Dataset(variables, attrs=attrs)
