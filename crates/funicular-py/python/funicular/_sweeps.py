"""Maps and sweeps: rows computed here or by an executor, and what they are to Python."""

import json
import math
import tempfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from funicular._errors import InputError
from funicular._funicular import Robot, SweepPlan, SweepTable, plot_page

if TYPE_CHECKING:
    from funicular._pages import Page

Progress = Callable[[int, int], object]


class _Columns(Mapping[str, NDArray[Any]]):
    """Columns as arrays, made when they are asked for."""

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
    """Rows of a map or a sweep: one a point, feasible or not, in the order of the points.

    Of a Parquet file the rows are read when they are asked for.
    """

    __module__ = "funicular"

    def __init__(self, table: SweepTable | None, file: Path | None = None) -> None:
        self._loaded = table
        self._columns: _Columns | None = None
        self.file = file
        """The file that was written or read; None for rows in memory alone."""

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Self:
        """A Parquet file that a map or a sweep has written, here or by the program, complete or not.

        Raises
        ------
        FileError
            The file cannot be read, it is damaged (its checksum is not that of its bytes), or no sweep wrote it.
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
        """Columns by name: coordinates, `feasible`, `status`, `reason`, then the quantities. Numbers that do not exist are
        NaN, texts that do not exist None."""
        if self._columns is None:
            self._columns = _Columns(self._table)
        return self._columns

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns; empty for flags and texts."""
        return {name: unit for name, unit, _ in self._table.fields}

    @property
    def about(self) -> dict[str, str]:
        """What the columns say."""
        return {name: about for name, _, about in self._table.fields}

    @property
    def feasible(self) -> NDArray[np.bool_]:
        """Which rows have an equilibrium with tensions within the limits."""
        return self.columns["feasible"]

    @property
    def complete(self) -> bool:
        """Whether every row is there; not so in the file of a run that was interrupted."""
        return self._table.complete

    @property
    def plan(self) -> dict[str, Any]:
        """Points, quantities and options."""
        plan: dict[str, Any] = json.loads(self._table.plan)
        return plan

    @property
    def robot(self) -> Robot:
        """The robot, as its file was."""
        return Robot.from_toml(self._table.robot_file)

    @property
    def axes(self) -> dict[str, NDArray[np.float64]]:
        """Values along the axes of the grid that have more than one, the fastest first; none for a list of poses."""
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
        """A column with one dimension for each of `axes`, the last first: `[iy, ix]` of x and y, as matplotlib has it."""
        axes = self.axes
        if not axes:
            raise InputError("these rows are no grid: there is one dimension, that of `columns`")
        if not self.complete:
            raise InputError(f"the grid is not complete: {len(self)} rows are there")
        shape = [len(values) for values in reversed(axes.values())]
        if len(self) != math.prod(shape):
            raise InputError(
                f"this is a part of a grid: {len(self)} of {math.prod(shape)} rows are there; merge the parts "
                "(`funicular.merge`)"
            )
        return self.columns[name].reshape(shape)

    def to_pandas(self) -> Any:
        """The rows as a table of pandas, which has to be installed; units in its `attrs`."""
        from funicular import _tables

        return _tables.sweep_table(self)

    def to_arrow(self) -> Any:
        """The rows as a table of pyarrow, which has to be installed, without copies; units in the fields' metadata.

        Other libraries take the rows as they are: `polars.DataFrame(sweep)`, `duckdb.from_arrow(sweep)`.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("Arrow tables need pyarrow: pip install 'funicular[arrow]'") from error
        return pyarrow.table(self)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def to_parquet(self, path: str | PathLike[str]) -> None:
        """Writes the rows with units, robot and plan: byte for byte the file of the program's `map` or `sweep`."""
        if Path(path).suffix.lower() != ".parquet":
            raise InputError(f"`path` is {path}: it must end in .parquet")
        self._table.write(Path(path))

    def write(self, path: str | PathLike[str]) -> None:
        """Writes .parquet, .csv or .vti (for ParaView), as a whole or not at all."""
        self._table.write(Path(path))

    def plot(self, path: str | PathLike[str] | None = None) -> "Page":
        """A page in HTML with pictures of the rows, which notebooks show: the program's `plot`; `path` writes it, too."""
        from funicular import _pages

        call = f"funicular.Sweep.read({str(self.file or 'rows.parquet')!r}).plot({str(path)!r})"
        if self.file is not None and self.file.suffix.lower() == ".parquet":
            return _pages.page(*plot_page(self.file, str(self.file), call), path)
        with tempfile.TemporaryDirectory() as folder:
            rows = Path(folder) / "rows.parquet"
            self._table.write(rows)
            return _pages.page(*plot_page(rows, "rows in memory", call), path)

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

    def __reduce__(self) -> tuple[Callable[[bytes], "Sweep"], tuple[bytes]]:
        from funicular import _rebuild

        return _rebuild.sweep, (self._bytes(),)

    def __repr__(self) -> str:
        return f"<Sweep: {int(self.feasible.sum())} of {len(self)} rows feasible, {len(self.columns)} columns>"

    def _repr_html_(self) -> str:
        from funicular import _html

        return _html.sweep(self)


def run(
    plan: SweepPlan,
    *,
    file: Path | None,
    resume: bool,
    discard: bool,
    threads: int | None,
    executor: Executor | Callable[[], Executor] | None,
    chunks_per_task: int | None,
    progress: Progress | None,
) -> Sweep:
    """All rows of a plan."""
    from funicular import _executors

    if executor is not None and threads is not None:
        raise InputError("`threads` are of this process, `executor` has its own: give one of them")
    if executor is None and chunks_per_task is not None:
        raise InputError("`chunks_per_task` goes with `executor`")
    if chunks_per_task is not None and chunks_per_task < 1:
        raise InputError(f"`chunks_per_task` is {chunks_per_task}: give at least one")
    work = plan.begin(file, resume, discard)
    if work is None:
        return Sweep(None, file)
    if executor is not None:
        return Sweep(_executors.Shared(plan, work, file, chunks_per_task, progress).run(executor), file)
    try:
        work.run(threads, progress)
    except BaseException as error:
        _executors.note_what_is_safe(error, work)
        raise
    return Sweep(work.finish(), file)
