"""Rows of maps and sweeps as NumPy arrays, tables and files."""

import json
import math
import tempfile
from collections.abc import Callable, Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from funicular import _show
from funicular._errors import InputError, needs
from funicular._funicular import Robot, SweepTable, plot_page
from funicular._pages import Page, page, try_page


class _LazyColumns(Mapping[str, NDArray[Any]]):
    """Columns as arrays, which are made at their first use."""

    def __init__(self, table: SweepTable) -> None:
        self._table = table
        self._places = {name: place for place, (name, _, _) in enumerate(table.fields)}
        self._made: dict[str, NDArray[Any]] = {}

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._made:
            column = self._table.column(self._places[name])
            array = np.array(column, dtype=object) if isinstance(column, list) else column
            array.flags.writeable = False
            self._made[name] = array
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __repr__(self) -> str:
        return f"<columns: {', '.join(self)}>"


class Sweep:
    """Rows of a map or a sweep: one per point, feasible or not, in the order of the points.

    The rows of a Parquet file are read at their first use.
    """

    __module__ = "funicular"

    def __init__(self, table: SweepTable | None, file: Path | None = None) -> None:
        self._loaded = table
        self._columns: _LazyColumns | None = None
        self.file = file
        """The file that was written or read; None for rows in memory alone."""

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Self:
        """Reads a Parquet file of a map or a sweep, written by Python or by the program, complete or not.

        Raises
        ------
        FileError
            The file cannot be read, it is damaged (its checksum does not fit its bytes), or no sweep wrote it.
        """
        return cls(SweepTable.read(Path(path)), Path(path))

    @property
    def _table(self) -> SweepTable:
        if self._loaded is None:
            assert self.file is not None
            self._loaded = SweepTable.read(self.file)
        return self._loaded

    @property
    def columns(self) -> Mapping[str, NDArray[Any]]:
        """Columns by name: coordinates, `feasible`, `status`, `reason`, then the quantities. A missing number is NaN, a
        missing text None."""
        if self._columns is None:
            self._columns = _LazyColumns(self._table)
        return self._columns

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns; empty for flags and texts."""
        return {name: unit for name, unit, _ in self._table.fields}

    @property
    def about(self) -> dict[str, str]:
        """Meanings of the columns."""
        return {name: about for name, _, about in self._table.fields}

    @property
    def feasible(self) -> NDArray[np.bool_]:
        """True for rows that have an equilibrium with tensions within the limits."""
        return self.columns["feasible"]

    @property
    def complete(self) -> bool:
        """True if every row is there; False for the file of an interrupted run."""
        return self._table.complete

    @property
    def plan(self) -> dict[str, Any]:
        """Points, quantities and options."""
        plan: dict[str, Any] = json.loads(self._table.plan)
        return plan

    @property
    def robot(self) -> Robot:
        """Robot of the file, as it was when the rows were computed."""
        return Robot.from_toml(self._table.robot_file)

    @property
    def axes(self) -> dict[str, NDArray[np.float64]]:
        """Values along the axes of the grid with more than one value, the fastest first; empty for a list of poses."""
        axes = {}
        for axis in self.plan.get("grid", []):
            if "values" in axis:
                values = np.array(axis["values"], dtype=float)
            else:
                first, last, count = axis["from"], axis["to"], axis["count"]
                values = first + (last - first) * (np.arange(count) / (count - 1))
                values[-1] = last
            if len(values) > 1:
                axes[axis["axis"]] = values
        return axes

    def on_grid(self, name: str) -> NDArray[Any]:
        """Column with one dimension per axis, the last first: `[iy, ix]` for x and y, as matplotlib needs it."""
        axes = self.axes
        if not axes:
            raise InputError("these rows are no grid: they have one dimension; use `columns`")
        shape = [len(values) for values in reversed(axes.values())]
        self._check_grid(math.prod(shape))
        return self.columns[name].reshape(shape)

    def _check_grid(self, points: int) -> None:
        """Refuses rows that are not all of the points of their grid."""
        if not self.complete:
            raise InputError(f"the grid is not complete: {len(self)} rows are there")
        if len(self) != points:
            raise InputError(
                f"this is a part of a grid: {len(self)} of {points} rows are there; merge the parts (`funicular.merge`)"
            )

    def to_pandas(self) -> Any:
        """Makes a table of pandas of the rows, with the units in its `attrs`; pandas has to be installed."""
        return _show.table(self)

    def to_xarray(self) -> Any:
        """Makes a dataset of xarray with one dimension per axis of the grid or varied value; xarray has to be installed.

        The last axis comes first, as in `on_grid`; an axis with one value is a coordinate without dimension. A list of
        poses has the dimension `row`. Units and meanings are attributes of the variables, the robot file and the plan
        of the dataset. A missing number is NaN, a missing text is empty, so that `to_netcdf` writes them.

        Raises
        ------
        InputError
            The grid is not complete, or this is a part of it.
        """
        return _show.dataset(self)

    def to_arrow(self) -> Any:
        """Makes a table of pyarrow without copies; pyarrow has to be installed.

        The metadata of the fields contain the units.

        Other libraries take the rows directly: `polars.DataFrame(sweep)`, `duckdb.from_arrow(sweep)`.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise needs("an Arrow table", "pyarrow") from error
        return pyarrow.table(self)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def to_parquet(self, path: str | PathLike[str]) -> None:
        """Writes a Parquet file with units, robot and plan: the bytes of the program's `map` or `sweep`."""
        if Path(path).suffix.lower() != ".parquet":
            raise InputError(f"`path` is {path}: it must end in .parquet")
        self._table.write(Path(path))

    def write(self, path: str | PathLike[str]) -> None:
        """Writes .parquet, .csv or .vti (for ParaView); the file is complete or absent."""
        self._table.write(Path(path))

    def plot(self, path: str | PathLike[str] | None = None) -> Page:
        """Makes a page in HTML with pictures of the rows, which notebooks show, as the program's `plot`.

        With `path` the page is also written to a file.
        """
        try_page(path)
        call = f"funicular.Sweep.read({str(self.file or 'rows.parquet')!r}).plot({str(path)!r})"
        if self.file is not None and self.file.suffix.lower() == ".parquet":
            return page(*plot_page(self.file, str(self.file), call), path)
        with tempfile.TemporaryDirectory() as folder:
            rows = Path(folder) / "rows.parquet"
            self._table.write(rows)
            return page(*plot_page(rows, "rows in memory", call), path)

    def __len__(self) -> int:
        return self._table.rows

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.columns[name]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sweep):
            return NotImplemented
        return self._bytes() == other._bytes()

    __hash__ = None  # type: ignore[assignment]

    def _bytes(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sweep.parquet"
            self._table.write(path)
            return path.read_bytes()

    @classmethod
    def _of_bytes(cls, parquet: bytes) -> "Sweep":
        """Reads the bytes of a Parquet file; pickles call it."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sweep.parquet"
            path.write_bytes(parquet)
            return cls(SweepTable.read(path))

    def __reduce__(self) -> tuple[Callable[[bytes], "Sweep"], tuple[bytes]]:
        return Sweep._of_bytes, (self._bytes(),)

    def __repr__(self) -> str:
        return f"<Sweep: {int(self.feasible.sum())} of {len(self)} rows feasible, {len(self.columns)} columns>"

    def _repr_html_(self) -> str:
        return _show.html(self)
