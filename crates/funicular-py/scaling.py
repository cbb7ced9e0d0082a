"""Speed-up of a map with more threads or workers, as a table for docs/sweeps.md.

    python crates/funicular-py/scaling.py [WORKERS…]

Without numbers: for 1, 2 and so on up to all processors. The rows of Dask need dask and distributed, those of MPI need
mpiexec and mpi4py. Workers start before the clock. Each figure is the best of three.
"""

import contextlib
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, wait
from pathlib import Path

import funicular

ROBOT = Path(__file__).parents[2] / "robots" / "cogiro.toml"
GRID = {"x": (-5, 5, 81), "y": (-3.5, 3.5, 57), "z": (0.5, 3.5, 25)}
ROWS = 81 * 57 * 25


def seconds(executor: Executor | None, count: int) -> float:
    """Time of a map [s], the best of three."""
    robot = funicular.Robot.from_file(ROBOT)
    if executor is not None:
        wait([executor.submit(time.sleep, 0.2) for _ in range(4 * count)])
    best = float("inf")
    for _ in range(3):
        begun = time.perf_counter()
        threads = count if executor is None else None
        rows = robot.map(GRID, ["tension-max", "first-frequency"], threads=threads, executor=executor)
        best = min(best, time.perf_counter() - begun)
        assert len(rows) == ROWS
    return best


@contextlib.contextmanager
def dask(count: int) -> Iterator[Executor]:
    from dask.distributed import Client, LocalCluster

    with LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        yield client.get_executor()


def in_this_process(count: int) -> float:
    return seconds(None, count)


def by(make: Callable[[int], contextlib.AbstractContextManager[Executor]]) -> Callable[[int], float]:
    def run(count: int) -> float:
        with make(count) as executor:
            return seconds(executor, count)

    return run


def by_mpi(count: int) -> float:
    line = ["mpiexec", "--oversubscribe", "-n", str(count + 1), sys.executable, "-m", "mpi4py.futures", __file__, "mpi"]
    if os.getuid() == 0:
        line.insert(1, "--allow-run-as-root")
    return float(subprocess.run(line, capture_output=True, text=True, check=True).stdout)


def main() -> None:
    counts = [int(count) for count in sys.argv[1:]] or list(range(1, (os.cpu_count() or 1) + 1))
    ways: dict[str, Callable[[int], float]] = {"threads": in_this_process, "processes": by(ProcessPoolExecutor)}
    with contextlib.suppress(ImportError):
        import distributed  # noqa: F401

        ways["Dask"] = by(dask)
    if shutil.which("mpiexec"):
        ways["MPI"] = by_mpi
    print(f"{ROWS} poses of CoGiRo, tensions and first frequency\n")
    print("| | " + " | ".join(f"{count}" for count in counts) + " |")
    print("|---|" + "---:|" * len(counts))
    for name, way in ways.items():
        times = [way(count) for count in counts]
        cells = [f"{1e6 * took / ROWS:.1f} µs ({times[0] / took:.2f})" for took in times]
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["mpi"]:
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as pool:
            print(seconds(pool, pool.num_workers))
    else:
        main()
