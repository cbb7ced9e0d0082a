"""Workers that die: functions and executors that the tests of executors share."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import funicular
from funicular import _executors

compute = _executors.compute


def dies_once(plan: object, first: int, end: int) -> tuple[bytes, float]:
    """`compute`, killed at chunk 20 the first time that any process comes there."""
    mark = Path(os.environ["FUNICULAR_TEST_MARK"])
    if first <= 20 < end and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return compute(plan, first, end)  # type: ignore[arg-type]


def pool() -> ProcessPoolExecutor:
    return ProcessPoolExecutor(2)


def ask(robot: funicular.Robot, **keywords: object) -> funicular.Sweep:
    """68 chunks of a row, of which some have no equilibrium."""
    grid = {"x": (-4, 4, 17), "y": (-2, 2, 4), "z": [0.5]}
    return robot.map(grid, quantities=["tension-max", "first-frequency"], **keywords)  # type: ignore[arg-type]


# Rows of `ask_long`, which take a second or more: long beside the time between two calls of `progress`.
LONG = 40 * 40 * 25


def ask_long(robot: funicular.Robot, **keywords: object) -> funicular.Sweep:
    grid = {"x": (-2, 2, 40), "y": (-1, 1, 40), "z": (0, 2, 25)}
    return robot.map(grid, quantities=["tension-max"], **keywords)  # type: ignore[arg-type]
