"""Functions and executors with workers that die, for the tests of executors."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import funicular
from funicular import _executors

compute = _executors.compute


def dies_once(plan: object, first: int, end: int) -> tuple[bytes, float]:
    """Computes as `compute`, but the first process that reaches chunk 20 kills itself."""
    mark = Path(os.environ["FUNICULAR_TEST_MARK"])
    if first <= 20 < end and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return compute(plan, first, end)  # type: ignore[arg-type]


def pool() -> ProcessPoolExecutor:
    return ProcessPoolExecutor(2)


def ask(robot: funicular.Robot, **keywords: object) -> funicular.Sweep:
    """Computes 68 chunks of one row; some rows have no equilibrium."""
    grid = {"x": (-4, 4, 17), "y": (-2, 2, 4), "z": [0.5]}
    return robot.map(grid, quantities=["tension-max", "first-frequency"], **keywords)  # type: ignore[arg-type]


# Number of rows of `ask_long`. They take a second or more, much longer than the time between two calls of `progress`.
LONG = 40 * 40 * 25


def ask_long(robot: funicular.Robot, **keywords: object) -> funicular.Sweep:
    grid = {"x": (-2, 2, 40), "y": (-1, 1, 40), "z": (0, 2, 25)}
    return robot.map(grid, quantities=["tension-max"], **keywords)  # type: ignore[arg-type]
