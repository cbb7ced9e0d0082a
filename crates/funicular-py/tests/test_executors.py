"""All executors compute the same rows, and no row is lost when a worker dies."""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import funicular
import pytest
import workers
from funicular import _executors


@pytest.fixture(scope="module")
def local(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Bytes of the file that one process writes."""
    path = tmp_path_factory.mktemp("local") / "map.parquet"
    workers.ask(funicular.Robot.example(), file=path)
    return path.read_bytes()


@pytest.fixture
def deadly(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Makes one worker kill itself; the file exists after that."""
    monkeypatch.setenv("FUNICULAR_TEST_MARK", str(tmp_path / "died"))
    monkeypatch.setattr(_executors, "compute", workers.dies_once)
    return tmp_path / "died"


@pytest.mark.parametrize("chunks_per_task", [None, 7])
def test_processes_write_the_file_of_one(
    chunks_per_task: int | None, local: bytes, robot: funicular.Robot, tmp_path: Path
) -> None:
    path, seen = tmp_path / "map.parquet", []
    with ProcessPoolExecutor(2) as executor:
        rows = workers.ask(
            robot, file=path, executor=executor, chunks_per_task=chunks_per_task, progress=lambda *rows: seen.append(rows)
        )
    assert path.read_bytes() == local and not Path(f"{path}.partial").exists()
    assert len(rows) == 68 and seen[-1] == (68, 68) and seen == sorted(seen)


def test_rows_in_memory_are_those_of_the_file(local: bytes, robot: funicular.Robot, tmp_path: Path) -> None:
    with ThreadPoolExecutor(3) as executor:
        workers.ask(robot, executor=executor).to_parquet(tmp_path / "threads.parquet")
    assert (tmp_path / "threads.parquet").read_bytes() == local


@pytest.mark.parametrize("in_file", [True, False])
def test_a_pool_that_dies_is_replaced(
    in_file: bool, deadly: Path, local: bytes, robot: funicular.Robot, tmp_path: Path
) -> None:
    path = tmp_path / "map.parquet"
    if in_file:
        workers.ask(robot, file=path, executor=workers.pool)
    else:
        workers.ask(robot, executor=workers.pool).to_parquet(path)
    assert deadly.exists() and path.read_bytes() == local


@pytest.mark.parametrize("in_file", [True, False])
def test_the_error_of_a_dead_pool_goes_on_with_another(
    in_file: bool, deadly: Path, local: bytes, robot: funicular.Robot, tmp_path: Path
) -> None:
    path = tmp_path / "map.parquet"
    with ProcessPoolExecutor(2) as executor, pytest.raises(funicular.ExecutorError, match="rows are kept") as error:
        workers.ask(robot, file=path if in_file else None, executor=executor, chunks_per_task=3)
    assert deadly.exists()
    if in_file:
        assert "`resume=True` continues" in error.value.__notes__[0] and not path.read_bytes() == local
    with ThreadPoolExecutor(2) as executor:
        rows = error.value.resume(executor)
    if not in_file:
        rows.to_parquet(path)
    assert path.read_bytes() == local


def test_another_process_goes_on_with_the_file(
    deadly: Path, local: bytes, robot: funicular.Robot, tmp_path: Path
) -> None:
    path = tmp_path / "map.parquet"
    with ProcessPoolExecutor(2) as executor, pytest.raises(funicular.ExecutorError):
        workers.ask(robot, file=path, executor=executor, chunks_per_task=3)
    first: list[int] = []
    workers.ask(robot, file=path, resume=True, progress=lambda done, _: first.append(done))
    assert path.read_bytes() == local


def test_a_class_of_executors_makes_them(local: bytes, robot: funicular.Robot, tmp_path: Path) -> None:
    workers.ask(robot, executor=ThreadPoolExecutor).to_parquet(tmp_path / "threads.parquet")
    assert (tmp_path / "threads.parquet").read_bytes() == local


def test_a_function_that_makes_executors_of_dask_is_one(local: bytes, robot: funicular.Robot, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    path = tmp_path / "map.parquet"
    with distributed.Client(processes=False, n_workers=1, threads_per_worker=2, dashboard_address=None) as client:
        workers.ask(robot, file=path, executor=lambda: client.get_executor())
    assert path.read_bytes() == local


class _Refuses(ThreadPoolExecutor):
    def submit(self, *_: object, **__: object) -> object:  # type: ignore[override]
        raise ConnectionError("nobody is there")


def test_an_executor_that_takes_nothing_ends_it(robot: funicular.Robot) -> None:
    made = []

    def make() -> Executor:
        made.append(_Refuses())
        return made[-1]

    with pytest.raises(funicular.ExecutorError, match="ConnectionError: nobody is there.* 0 of 68 rows"):
        workers.ask(robot, executor=make)
    assert len(made) == 3


def test_dask_survives_a_worker(local: bytes, robot: funicular.Robot, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    path, killed = tmp_path / "map.parquet", []
    with (
        distributed.LocalCluster(
            n_workers=2, processes=True, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = list(client.run(os.getpid).values())

        def progress(done: int, rows: int) -> None:
            if not killed and 10 < done < rows:
                os.kill(pids[0], signal.SIGKILL)
                killed.append(done)

        workers.ask(robot, file=path, executor=client.get_executor(), chunks_per_task=2, progress=progress)
    assert killed and path.read_bytes() == local


def test_mpi_writes_the_file_of_one(local: bytes, tmp_path: Path) -> None:
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec")
    if mpiexec is None:
        pytest.skip("mpiexec is not there")
    path = tmp_path / "map.parquet"
    line = [mpiexec, "--oversubscribe", "-n", "3", sys.executable, "-m", "mpi4py.futures", "mpi_script.py", str(path)]
    if os.getuid() == 0:
        line.insert(1, "--allow-run-as-root")
    told = subprocess.run(line, cwd=Path(__file__).parent, capture_output=True, text=True, timeout=300, check=False)
    assert told.returncode == 0, told.stderr
    assert "2 workers" in told.stdout and path.read_bytes() == local


@pytest.mark.parametrize("with_executor", [False, True])
def test_ctrl_c_leaves_rows_that_can_be_resumed(with_executor: bool, robot: funicular.Robot, tmp_path: Path) -> None:
    path, whole = tmp_path / "map.parquet", tmp_path / "whole.parquet"
    sent: list[float] = []

    def progress(done: int, rows: int) -> None:
        if not sent and 0 < done < rows:
            sent.append(time.monotonic())
            threading.Thread(target=signal.raise_signal, args=(signal.SIGINT,)).start()

    executor = ThreadPoolExecutor(1) if with_executor else None
    with pytest.raises(KeyboardInterrupt) as error:
        workers.ask_long(
            robot,
            file=path,
            executor=executor,
            progress=progress,
            threads=None if with_executor else 1,
            chunks_per_task=1 if with_executor else None,
        )
    assert time.monotonic() - sent[0] < 5
    assert "rows are safe" in error.value.__notes__[0]
    part = funicular.Sweep.read(path)
    assert not part.complete and 0 < len(part) < workers.LONG
    workers.ask_long(robot, file=path, resume=True)
    workers.ask_long(robot, file=whole)
    assert path.read_bytes() == whole.read_bytes()
