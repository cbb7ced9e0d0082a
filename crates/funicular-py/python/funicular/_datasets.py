"""Results as datasets of xarray, which writes them as NetCDF."""

import json
import math
import warnings
from typing import Any

import numpy as np

from funicular import _show
from funicular._errors import InputError, needs
from funicular._funicular import unit_of_name
from funicular._results import Modes, Results
from funicular._sweeps import Sweep

_MOTIONS = ("x", "y", "z", "rx", "ry", "rz")
# Keys of results whose rows the other keys of the same length belong to.
_ALONG = ("frequency_hz", "time_s", "t_s")


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise needs("a dataset", "xarray") from error
    return xarray


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
            unit = of.peak_unit or "" if name == "peak" else unit_of_name(name)
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
    made = _Dataset(of)
    for key, value in of.items():
        made.put_key(key, value)
    if not made.variables:
        raise InputError(f"the results of {of.get('command', 'this command')} hold no rows: read their keys")
    if made.left_out:
        warnings.warn(
            f"the dataset leaves out {', '.join(made.left_out)}: these values fit into no array; read them by their keys",
            UserWarning,
            stacklevel=3,
        )
    coords = {dim: of_dim for dim, of_dim in made.coords.items() if any(dim in along for along, *_ in made.variables.values())}
    return _xarray().Dataset(made.variables, coords, made.attrs)


# Labels of the components of vectors, by the end of their key and their number.
_COMPONENTS = {
    ("quaternion_wxyz", 4): ("quaternion", ("w", "x", "y", "z")),
    ("roll_pitch_yaw_deg", 3): ("angle", ("roll", "pitch", "yaw")),
    ("interval_95", 2): ("bound", ("minimum", "maximum")),
    ("range", 2): ("bound", ("minimum", "maximum")),
    ("interval", 2): ("bound", ("minimum", "maximum")),
}
# Words in the keys of values that belong to the axes x, y, z, and in those of values that belong to cables.
_VECTORS = ("position", "velocity", "acceleration", "force", "moment", "point", "center", "direction", "rotation", "translation")
_OF_CABLES = ("tension", "length", "cable", "slack", "torque", "power", "winch", "limit", "rate", "speed")


class _Dataset:
    """Variables of a dataset, made of the keys of results."""

    def __init__(self, of: Results) -> None:
        self.variables: dict[str, Any] = {}
        self.coords: dict[str, Any] = {}
        self.attrs: dict[str, Any] = {"title": str(of.get("robot", "")), "source": f"funicular {of.get('command', '')}".strip()}
        self.left_out: list[str] = []
        self._unit = str(of.get("unit", ""))
        along = next((key for key in _ALONG if np.ndim(of.get(key, 0)) == 1), None)
        self._along = None if along is None else (along, len(of[along]))
        self._cables = _names_of_cables(of)

    def put_key(self, key: str, value: Any) -> None:
        """Adds the value of a key of the results."""
        listed = list(value) if isinstance(value, list | np.ndarray) else []
        if key in ("schema", "command", "robot") or value is None:
            return
        if isinstance(value, (str, int, float)):
            self.attrs[key] = int(value) if isinstance(value, bool) else value
        elif key == "warnings":
            self.attrs[key] = "\n".join(map(str, value))
        elif listed and all(isinstance(row, dict) for row in listed):
            dim, labels = self._dim_of_rows(key, listed)
            if labels is not None:
                self.coords[dim] = labels
            # Responses and rows are the result itself, and their columns have no other name.
            prefix = "" if key in ("responses", "rows") else f"{key}_"
            for column in _keys(listed):
                self._put(prefix + column, (dim,), [row.get(column) for row in listed], column)
        else:
            self._put(key, (), [value], key)

    def _dim_of_rows(self, key: str, rows: list[Any]) -> tuple[str, Any]:
        """Dimension of a list of rows, with its labels."""
        if key == "responses":
            return "response", None
        if key == "rows" and "time" not in self.coords and all(isinstance(row.get("t_s"), (int, float)) for row in rows):
            return "time", ("time", np.array([row["t_s"] for row in rows]), _attributes("s"))
        if self._cables and [row.get("cable", row.get("name")) for row in rows] == self._cables:
            return "cable", _texts(self._cables)
        return ("row" if key == "rows" else key), None

    def _dim_of_components(self, name: str, key: str, count: int, dims: tuple[str, ...]) -> str:
        """Dimension of the numbers of a list."""
        if self._along is not None and count == self._along[1] and dims in ((), ("response",)):
            return self._along[0]
        for (end, number), (dim, labels) in _COMPONENTS.items():
            if key.endswith(end) and number == count:
                self.coords[dim] = _texts(labels)
                return dim
        is_of_cables = any(word in key for word in _OF_CABLES)
        is_vector = count == 3 and (any(word in key for word in _VECTORS) or (unit_of_name(key) != "" and not is_of_cables))
        of_cables = self._cables and count == len(self._cables) and is_of_cables
        if of_cables and not (is_vector and not key.startswith(_OF_CABLES)):
            self.coords["cable"] = _texts(self._cables)
            return "cable"
        if is_vector:
            self.coords["axis"] = _texts("xyz")
            return "axis"
        return f"{name}_{count}"

    def _put(self, name: str, dims: tuple[str, ...], cells: list[Any], key: str, shape: tuple[int, ...] | None = None) -> None:
        """Adds the cells of a variable over its dimensions, or the variables of what the cells hold."""
        shape = (len(cells),) if shape is None and dims else shape or ()
        filled = [cell for cell in cells if cell is not None]
        if not filled:
            return
        if all(isinstance(cell, dict) for cell in filled):
            for inner in _keys(filled):
                self._put(f"{name}_{inner}", dims, [None if cell is None else cell.get(inner) for cell in cells], inner, shape)
        elif all(isinstance(cell, (list, tuple, np.ndarray)) for cell in filled):
            self._put_lists(name, dims, cells, key, shape)
        elif all(np.iscomplexobj(cell) for cell in filled):
            for part in ("real", "imag"):
                self._put(f"{name}_{part}", dims, [None if cell is None else getattr(cell, part) for cell in cells], key, shape)
        elif all(isinstance(cell, (str, bool, int, float, np.generic)) for cell in filled):
            self._add(name, dims, _array(cells).reshape(shape), key)
        else:
            self.left_out.append(f"`{name}`")

    def _put_lists(self, name: str, dims: tuple[str, ...], cells: list[Any], key: str, shape: tuple[int, ...]) -> None:
        counts = {len(cell) for cell in cells if cell is not None}
        if counts == {0}:
            return
        if len(counts) > 1:
            self.left_out.append(f"`{name}`")
            return
        count = counts.pop()
        inner = [item for cell in cells for item in ([None] * count if cell is None else list(cell))]
        dim = self._dim_of_components(name, key, count, dims)
        if dim in dims:
            dim = f"{name}_{count}"
        # A matrix has two dimensions of one length.
        dim = f"{dim}_{len(dims)}" if dim in dims else dim
        self._put(name, (*dims, dim), inner, key, (*shape, count))

    def _add(self, name: str, dims: tuple[str, ...], values: Any, key: str) -> None:
        unit = unit_of_name(key) or self._unit * (key in ("real", "imag", "magnitude"))
        while name in self.variables or name in dims and len(dims) > 1:
            name += "_values"
        self.variables[name] = (dims, values, _attributes(unit))


def _keys(rows: list[Any]) -> list[str]:
    """Keys of all rows, in their order."""
    return list(dict.fromkeys(key for row in rows for key in row))


def _array(cells: list[Any]) -> Any:
    """Array of numbers, truth values or texts. Numbers that are missing are NaN, texts empty."""
    filled = [cell for cell in cells if cell is not None]
    if any(isinstance(cell, str) for cell in filled):
        return _texts(cells)
    if len(filled) < len(cells):
        return np.array([np.nan if cell is None else float(cell) for cell in cells])
    return np.array(cells)


def _names_of_cables(of: Results) -> list[str]:
    """Names of the cables in their order, if the results have a list of all of them."""
    for rows, key in ((of.get("cable_names"), ""), (of.get("cables"), "name"), (of.get("cables"), "cable"), (of.get("peaks"), "cable")):
        if not isinstance(rows, list):
            continue
        cells = [row.get(key) if isinstance(row, dict) else row for row in rows]
        names = [cell for cell in cells if isinstance(cell, str)]
        if names and len(names) == len(cells) and len(set(names)) == len(names):
            return names
    return []
