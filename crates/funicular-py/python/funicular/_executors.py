"""Computation of the chunks of a sweep by the workers of an executor; workers may die."""

import contextlib
import math
import os
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from pathlib import Path
from typing import NamedTuple

from funicular._errors import Error
from funicular._funicular import SweepPlan, SweepTable, SweepWork
from funicular._sweeps import Sweep

# Target duration of a task [s]: long compared with the transport to a worker and back, but its loss does not matter.
_TASK_SECONDS = 2.0
# Number of submitted tasks per worker: with two, no worker waits for its next task.
_TASKS_AHEAD = 2
# Maximum number of finished tasks per worker that wait for an earlier one.
_MAX_WAITING = 32
# Maximum number of attempts for a task, and of executors that finish no task.
_MAX_TRIES = 3
# Maximum time without a check of the executor [s].
_POLL_SECONDS = 0.5

ExecutorSource = Executor | Callable[[], Executor]


class Task(NamedTuple):
    """Chunks from `first` (included) to `end` (excluded)."""

    first: int
    end: int


class ExecutorError(Error):
    """Workers died or could not start, several times in a row.

    Finished rows are kept: `resume` continues in the same process, `resume=True` with the same `file` in another.
    """

    __module__ = "funicular"

    def __init__(self, message: str, shared: "SharedSweep | None" = None) -> None:
        super().__init__(message)
        self._shared = shared

    def resume(self, executor: ExecutorSource) -> Sweep:
        """Continues with another executor."""
        if self._shared is None:
            raise ValueError("a copy of this error has no rows: resume from the one that was raised")
        return Sweep(self._shared.run(executor), self._shared.file)

    def __reduce__(self) -> tuple[type["ExecutorError"], tuple[str]]:
        return ExecutorError, (str(self),)


def compute(plan: SweepPlan, first: int, end: int) -> tuple[bytes, float]:
    """Computes chunks in a worker; returns their bytes and the time taken [s]."""
    began = time.perf_counter()
    return plan.compute(first, end), time.perf_counter() - began


def note_safe_rows(error: BaseException, work: SweepWork) -> None:
    """Ends the work early and notes in the exception which rows are safe."""
    try:
        safe = work.interrupt()
    except (Error, ValueError):
        return  # The work has ended already, or the first exception says more.
    if safe is not None:
        error.add_note(safe)


def _workers(executor: Executor) -> int:
    """Number of tasks that an executor runs at once; executors have no common attribute for it."""
    for name in ("num_workers", "_max_workers"):
        count = getattr(executor, name, None)
        if isinstance(count, int) and count > 0:
            return count
    client = getattr(executor, "_client", None)
    if client is not None:
        return max(1, sum(int(threads) for threads in client.nthreads().values()))
    return os.cpu_count() or 1


def _shut_down(executor: Executor, wait: bool) -> None:
    try:
        executor.shutdown(wait=wait, cancel_futures=True)
    except TypeError:
        # Dask's executor has no such argument; it cancels pending tasks if it does not wait.
        executor.shutdown(wait=wait)


class _Broken(Exception):
    """Executor that accepts no more tasks."""


class SharedSweep:
    """Sweep that is shared among workers: its finished tasks and its open tasks."""

    def __init__(
        self,
        plan: SweepPlan,
        work: SweepWork,
        file: Path | None,
        chunks_per_task: int | None,
        progress: Callable[[int, int], object] | None,
    ) -> None:
        self.plan, self.file, self.chunks_per_task, self.progress = plan, file, chunks_per_task, progress
        self.work: SweepWork | None = work
        self.fresh = work.next_chunk
        # Finished tasks that wait for an earlier one.
        self.waiting: dict[int, tuple[Task, bytes]] = {}
        self.again: list[Task] = []
        self.chunks_done = self.fresh
        self.failures: dict[Task, int] = {}
        self.seconds_per_chunk: float | None = None

    def run(self, executor: ExecutorSource) -> SweepTable | None:
        """Computes all missing chunks; returns the table of rows, or None if a Parquet file has it."""
        self._reopen()
        assert self.work is not None
        try:
            self._run(executor)
            return self.work.finish()
        except BaseException as error:
            # In memory the work stays open for `ExecutorError.resume`. A file is closed, so that other processes can
            # continue it.
            with contextlib.suppress(Error, ValueError):
                self._deliver()
            if self.file is not None:
                note_safe_rows(error, self.work)
                self.work = None
            raise

    def _reopen(self) -> None:
        """Continues a file that was closed; finished tasks in memory still fit."""
        if self.work is None:
            self.work = self.plan.begin(self.file, True, False)
            if self.work is None:
                raise ExecutorError(f"{self.file} was finished by another run: read it")
            begun = self.work.next_chunk
            self.waiting = {first: kept for first, kept in self.waiting.items() if first >= begun}
            # Chunks that are neither in the file nor in memory are computed again.
            known = [task for task, _ in self.waiting.values()]
            self.again, at = [], begun
            for task in sorted([*known, Task(max(self.fresh, begun), self.plan.chunks)]):
                if at < task.first:
                    self.again.append(Task(at, task.first))
                at = task.end
            self.fresh = max(self.fresh, begun)
            self.chunks_done = begun + sum(task.end - task.first for task in known)
        self.failures.clear()

    def _run(self, executor: ExecutorSource) -> None:
        # A class also has the method `submit`, but it makes executors.
        made_here = isinstance(executor, type) or not hasattr(executor, "submit")
        in_vain = 0
        while True:
            pool: Executor = executor() if made_here else executor  # type: ignore[operator, assignment]
            before, clean = self.chunks_done, False
            try:
                self._share(pool)
                clean = True
                return
            except _Broken as broken:
                in_vain = in_vain + 1 if self.chunks_done == before else 0
                if not made_here or in_vain >= _MAX_TRIES:
                    raise self._error(broken.__cause__) from broken.__cause__
            finally:
                if made_here:
                    _shut_down(pool, clean)

    def _error(self, cause: BaseException | None) -> ExecutorError:
        rows = min((self.chunks_done - self.plan.first_chunk) * self.plan.chunk_rows, self.plan.rows)
        return ExecutorError(
            f"the executor's workers fail ({type(cause).__name__}: {cause}); {rows} of {self.plan.rows} rows are kept: "
            "call `resume(executor)` of this exception to continue with another executor, or give as `executor` a "
            "function that makes executors, which is called again after a failure",
            self,
        )

    def _share(self, pool: Executor) -> None:
        """Gives tasks to one executor until all are done or it breaks."""
        assert self.work is not None
        workers = _workers(pool)
        running: dict[Future[tuple[bytes, float]], Task] = {}
        try:
            while self.work.next_chunk < self.plan.chunks:
                self._submit(pool, workers, running)
                done, _ = wait(running, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED)
                for future in done:
                    self._settle(future, running.pop(future))
                self._deliver()
        finally:
            # Tasks that have finished meanwhile are kept; all others are to be computed again.
            for future, task in running.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    self._keep(task, *future.result())
                else:
                    future.cancel()
                    self.again.append(task)

    def _submit(self, pool: Executor, workers: int, running: dict[Future[tuple[bytes, float]], Task]) -> None:
        untimed = self.seconds_per_chunk is None and self.chunks_per_task is None
        max_running = workers if untimed else _TASKS_AHEAD * workers
        while len(running) < max_running:
            task = self._next(workers)
            if task is None:
                return
            try:
                running[pool.submit(compute, self.plan, task.first, task.end)] = task
            except Exception as error:
                self.again.append(task)
                raise _Broken from error

    def _next(self, workers: int) -> Task | None:
        if self.again:
            # The earliest task: all others wait for it.
            self.again.sort(reverse=True)
            return self.again.pop()
        left = self.plan.chunks - self.fresh
        if left == 0 or len(self.waiting) > _MAX_WAITING * workers:
            return None
        count = self.chunks_per_task
        if count is None:
            # Smaller tasks at the end, so that all workers end together.
            fair = math.ceil(left / (_TASKS_AHEAD * workers))
            count = 1 if self.seconds_per_chunk is None else min(fair, int(_TASK_SECONDS / self.seconds_per_chunk))
        task = Task(self.fresh, self.fresh + max(1, min(count, left)))
        self.fresh = task.end
        return task

    def _settle(self, future: Future[tuple[bytes, float]], task: Task) -> None:
        """Keeps the result of a finished task, or puts the task back."""
        try:
            self._keep(task, *future.result())
        except Error:
            self.again.append(task)
            raise  # An error of the sweep itself would occur in every worker.
        except BrokenExecutor as error:
            self.again.append(task)
            raise _Broken from error
        except (KeyboardInterrupt, SystemExit):
            self.again.append(task)
            raise
        except BaseException as error:
            self.again.append(task)
            self.failures[task] = self.failures.get(task, 0) + 1
            if self.failures[task] >= _MAX_TRIES:
                raise self._error(error) from error

    def _keep(self, task: Task, chunks: bytes, seconds: float) -> None:
        self.waiting[task.first] = (task, chunks)
        self.chunks_done += task.end - task.first
        latest = max(seconds, 1e-6) / (task.end - task.first)
        known = self.seconds_per_chunk
        self.seconds_per_chunk = latest if known is None else (known + latest) / 2

    def _deliver(self) -> None:
        assert self.work is not None
        taken = False
        while (kept := self.waiting.get(self.work.next_chunk)) is not None:
            self.work.add(kept[1])
            del self.waiting[kept[0].first]
            taken = True
        if taken and self.progress is not None:
            self.progress(self.work.done, self.plan.rows)
