"""Script that computes a map by mpi4py.futures: `mpiexec -n 3 python -m mpi4py.futures mpi_script.py FILE`."""

import sys

import funicular
import workers
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        print(workers.ask(funicular.Robot.example(), executor=executor, file=sys.argv[1]), executor.num_workers, "workers")
