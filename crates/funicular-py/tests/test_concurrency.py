"""Threads, processes and Ctrl-C."""

import multiprocessing
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import funicular
import numpy as np
import pytest
from conftest import plain_grid

POSES = np.c_[np.random.default_rng(0).uniform(-0.5, 0.5, (20_000, 2)), np.full(20_000, 0.6)]


def test_other_threads_run_while_states_are_computed(robot: funicular.Robot) -> None:
    computing = threading.Thread(target=lambda: robot.equilibria(poses=POSES, threads=1))
    computing.start()
    began = last = time.perf_counter()
    longest = 0.0
    while computing.is_alive():
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
        time.sleep(0.001)
    # If the work held the lock, there would be one pause as long as the work.
    assert longest < 0.5 * (last - began)


@plain_grid
def test_threads_share_robots_and_results(robot: funicular.Robot, rest: funicular.Equilibrium) -> None:
    hz = np.linspace(0.1, 10, 500)
    expected = (rest.frf(hz, "fz", "az"), robot.modes(5), robot.equilibria(poses=POSES[:300]))
    with ThreadPoolExecutor(8) as pool:
        tasks = [
            pool.submit(lambda: (rest.frf(hz, "fz", "az"), robot.modes(5), robot.equilibria(poses=POSES[:300])))
            for _ in range(16)
        ]
        for task in tasks:
            response, modes, states = task.result()
            assert response.tobytes() == expected[0].tobytes() and modes == expected[1] and states == expected[2]


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_get_robots_and_give_results(method: str, robot: funicular.Robot) -> None:
    expected = robot.equilibria(poses=POSES[:500])  # before the fork: threads of the parent must not disturb the children
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as pool:
        assert pool.submit(robot.equilibria, POSES[:500]).result(timeout=60) == expected
        assert pool.submit(robot.modes, 5.0).result(timeout=60) == robot.modes(5)
        assert pool.submit(robot.equilibrium).result(timeout=60) == robot.equilibrium()
        with pytest.raises(funicular.StaticsError, match="tension"):
            pool.submit(robot.equilibrium, [0, 0, 9]).result(timeout=60)


@pytest.mark.parametrize(
    "long",
    [
        "robot.equilibria(poses=numpy.full((1_000_000, 3), [0, 0, 0.5]), threads=1)",
        "robot.modes(260)",
        "robot.frf(numpy.linspace(0.1, 20, 30_000_000), 'fz', 'az')",
        "robot.equilibrium().cable('1', numpy.linspace(1, 30, 3_000_000))",
        "robot.stiffness(numpy.linspace(1, 30, 10_000_000))",
        "robot.state_space(below_hz=50, tolerance=1e-4)",
        "robot.reduce(below_hz=50, tolerance=1e-9)",
        "funicular.run(robot.request('reduce', below_hz=50, tolerance=1e-4))",
    ],
)
def test_ctrl_c_ends_long_work(long: str) -> None:
    script = f"import funicular, numpy\nrobot = funicular.Robot.example()\nprint('go', flush=True)\n{long}\nprint('done')"
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None and child.stderr is not None
        assert child.stdout.readline() == "go\n"
        time.sleep(1.0)
        child.send_signal(signal.SIGINT)
        sent = time.perf_counter()
        rest, error = child.stdout.read(), child.stderr.read()
        # Not stopped, most of these take 15 s and more; on a busy machine the reading of 30 million numbers alone takes 7.
        assert time.perf_counter() - sent < 12 and "done" not in rest and "KeyboardInterrupt" in error


def test_a_reduction_does_not_go_on_after_ctrl_c() -> None:
    script = """
import funicular, time
robot = funicular.Robot.example()
print("go", flush=True)
try:
    robot.state_space(below_hz=50, tolerance=1e-4)
except KeyboardInterrupt:
    print("stopped", flush=True)
time.sleep(3)
before = time.process_time()
time.sleep(1)
print(time.process_time() - before)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "go\n"
        time.sleep(2.0)
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "stopped\n"
        # The thread of the work has ended; before, it took a whole second per second.
        assert float(child.stdout.read()) < 0.2
