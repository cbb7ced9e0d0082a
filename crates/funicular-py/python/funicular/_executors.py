"""Chunks of rows computed by the workers of an executor, whatever becomes of them."""

import contextlib
import math
import os
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from funicular._errors import Error
from funicular._funicular import SweepPlan, SweepTable, SweepWork

if TYPE_CHECKING:
    from funicular._sweeps import Sweep

# What a task should take [s]: long beside the way to a worker and back, short beside what anyone minds to lose.
_SECONDS = 2.0
# Tasks for each worker, so that none waits for its next.
_AHEAD = 2
# Finished tasks for each worker that may wait for an earlier one.
_WAITING = 32
# How often a task is tried, and an executor made anew, with nothing gained.
_TRIES = 3
# Time between two looks at the executor [s].
_LOOK = 0.5

Makes = Executor | Callable[[], Executor]


class Task(NamedTuple):
    """Chunks from the first to before the end."""

    first: int
    end: int


class ExecutorError(Error):
    """Workers died, or could not begin, more often than it makes sense to try.

    Nothing that was finished is lost: `resume` goes on in the same process, `resume=True` with the same `file` in another.
    """

    __module__ = "funicular"

    def __init__(self, message: str, shared: "Shared | None" = None) -> None:
        super().__init__(message)
        self._shared = shared

    def resume(self, executor: Makes) -> "Sweep":
        """Goes on with another executor."""
        from funicular._sweeps import Sweep

        if self._shared is None:
            raise ValueError("a copy of this error has no rows: resume from the one that was raised")
        return Sweep(self._shared.run(executor), self._shared.file)

    def __reduce__(self) -> tuple[type["ExecutorError"], tuple[str]]:
        return ExecutorError, (str(self),)


def compute(plan: SweepPlan, first: int, end: int) -> tuple[bytes, float]:
    """What a worker does: chunks as bytes, and how long it took [s]."""
    began = time.perf_counter()
    return plan.compute(first, end), time.perf_counter() - began


def note_what_is_safe(error: BaseException, work: SweepWork) -> None:
    """Ends it early; says in the exception what is safe."""
    try:
        safe = work.interrupt()
    except (Error, ValueError):
        return  # It has ended, or the exception at hand says more.
    if safe is not None:
        error.add_note(safe)


def _workers(executor: Executor) -> int:
    """How many tasks an executor runs at once; there is no common way to ask."""
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
        # Dask's does not have it, and cancels without being asked if it is not to wait.
        executor.shutdown(wait=wait)


class _Broken(Exception):
    """An executor that takes no tasks any more."""


class Shared:
    """A sweep that is shared among workers: tasks that are finished, and those that are still to do."""

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
        # Finished, but an earlier one is not.
        self.waiting: dict[int, tuple[Task, bytes]] = {}
        self.again: list[Task] = []
        self.chunks_done = self.fresh
        self.failures: dict[Task, int] = {}
        self.seconds_per_chunk: float | None = None

    def run(self, executor: Makes) -> SweepTable | None:
        """All that is missing; the table of rows, if it is not in a Parquet file."""
        self._reopen()
        assert self.work is not None
        try:
            self._run(executor)
            return self.work.finish()
        except BaseException as error:
            # In memory the work stays open for `ExecutorError.resume`; a file is closed, so that others can go on with it.
            with contextlib.suppress(Error, ValueError):
                self._deliver()
            if self.file is not None:
                note_what_is_safe(error, self.work)
                self.work = None
            raise

    def _reopen(self) -> None:
        """Goes on with a file that was closed; what waits in memory still fits."""
        if self.work is None:
            self.work = self.plan.begin(self.file, True, False)
            if self.work is None:
                raise ExecutorError(f"{self.file} was finished by another run: read it")
            begun = self.work.next_chunk
            self.waiting = {first: kept for first, kept in self.waiting.items() if first >= begun}
            # What is neither in the file nor here, whichever way it was lost.
            known = [task for task, _ in self.waiting.values()]
            self.again, at = [], begun
            for task in sorted([*known, Task(max(self.fresh, begun), self.plan.chunks)]):
                if at < task.first:
                    self.again.append(Task(at, task.first))
                at = task.end
            self.fresh = max(self.fresh, begun)
            self.chunks_done = begun + sum(task.end - task.first for task in known)
        self.failures.clear()

    def _run(self, executor: Makes) -> None:
        # A class has the method, too, but makes what has it.
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
                if not made_here or in_vain >= _TRIES:
                    raise self._error(broken.__cause__) from broken.__cause__
            finally:
                if made_here:
                    _shut_down(pool, clean)

    def _error(self, cause: BaseException | None) -> ExecutorError:
        rows = min((self.chunks_done - self.plan.first_chunk) * self.plan.chunk_rows, self.plan.rows)
        return ExecutorError(
            f"the executor's workers fail ({type(cause).__name__}: {cause}); {rows} of {self.plan.rows} rows are kept: "
            "`resume(executor)` of this exception goes on with another executor; a function that makes executors as "
            "`executor` goes on by itself",
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
                done, _ = wait(running, timeout=_LOOK, return_when=FIRST_COMPLETED)
                for future in done:
                    self._settle(future, running.pop(future))
                self._deliver()
        finally:
            # What others have finished meanwhile counts; what they have not is to be done again.
            for future, task in running.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    self._keep(task, *future.result())
                else:
                    future.cancel()
                    self.again.append(task)

    def _submit(self, pool: Executor, workers: int, running: dict[Future[tuple[bytes, float]], Task]) -> None:
        most = workers if self.seconds_per_chunk is None and self.chunks_per_task is None else _AHEAD * workers
        while len(running) < most:
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
            # The earliest, which all others wait for.
            self.again.sort(reverse=True)
            return self.again.pop()
        left = self.plan.chunks - self.fresh
        if left == 0 or len(self.waiting) > _WAITING * workers:
            return None
        count = self.chunks_per_task
        if count is None:
            # At the end smaller ones, so that all workers end together.
            fair = math.ceil(left / (_AHEAD * workers))
            count = 1 if self.seconds_per_chunk is None else min(fair, int(_SECONDS / self.seconds_per_chunk))
        task = Task(self.fresh, self.fresh + max(1, min(count, left)))
        self.fresh = task.end
        return task

    def _settle(self, future: Future[tuple[bytes, float]], task: Task) -> None:
        """Takes what a worker has finished, or puts the task back."""
        try:
            self._keep(task, *future.result())
        except Error:
            self.again.append(task)
            raise  # Of the sweep itself: it would be the same anywhere.
        except BrokenExecutor as error:
            self.again.append(task)
            raise _Broken from error
        except (KeyboardInterrupt, SystemExit):
            self.again.append(task)
            raise
        except BaseException as error:
            self.again.append(task)
            self.failures[task] = self.failures.get(task, 0) + 1
            if self.failures[task] >= _TRIES:
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
