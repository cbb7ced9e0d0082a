"""Computation of all rows of a map or sweep, here or by an executor; `Robot.map` and `Robot.sweep` call it."""

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path

from funicular._errors import InputError
from funicular._executors import SharedSweep, note_safe_rows
from funicular._funicular import SweepPlan
from funicular._sweeps import Sweep

Progress = Callable[[int, int], object]


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
    """Computes all rows of a plan."""
    if executor is not None and threads is not None:
        raise InputError("`threads` belong to this process, and `executor` has its own: give one of them")
    if executor is None and chunks_per_task is not None:
        raise InputError("`chunks_per_task` goes with `executor`")
    if chunks_per_task is not None and chunks_per_task < 1:
        raise InputError(f"`chunks_per_task` is {chunks_per_task}: give at least one")

    work = plan.begin(file, resume, discard, level=4)
    if work is None:
        return Sweep(None, file)
    if executor is not None:
        return Sweep(SharedSweep(plan, work, file, chunks_per_task, progress).run(executor), file)

    try:
        work.run(threads, progress)
    except BaseException as error:
        note_safe_rows(error, work)
        raise
    return Sweep(work.finish(), file)
