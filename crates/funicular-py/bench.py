"""Times of calls from Python, for comparison with `cargo bench -p funicular` at the same time on the same machine.

    python crates/funicular-py/bench.py
"""

import timeit
from collections.abc import Callable

import funicular
import numpy as np

ROBOT = funicular.Robot.example()
REST = ROBOT.equilibrium()
HZ = 0.002 * np.arange(1, 10_001)  # as in `cargo bench`
POSES = np.c_[np.random.default_rng(0).uniform(-0.5, 0.5, (10_000, 2)), np.full(10_000, 0.6)]
CABLE = {"unstrained_length_m": 4.2, "weight_n_per_m": 0.66, "axial_stiffness_n": 2.5e5}


def best(call: Callable[[], object]) -> float:
    """Time of a call [s], the best of several series."""
    timer = timeit.Timer(call)
    count, _ = timer.autorange()
    return min(timer.repeat(7, count)) / count


def main() -> None:
    jobs: dict[str, tuple[Callable[[], object], int]] = {
        "an attribute: rest.residual": (lambda: REST.residual, 1),
        "an array: rest.tension_platform_n": (lambda: REST.tension_platform_n, 1),
        "a cable: Catenary(…).tension_start_n": (lambda: funicular.Catenary(4, 1, **CABLE).tension_start_n, 1),
        "lengths to pose": (ROBOT.equilibrium, 1),
        "pose to lengths": (lambda: ROBOT.equilibrium([0, 0, 0.5]), 1),
        "a pose of 10,000, one thread": (lambda: ROBOT.equilibria(poses=POSES, threads=1), len(POSES)),
        "a pose of 10,000, all processors": (lambda: ROBOT.equilibria(poses=POSES), len(POSES)),
        "shallow-dynamic: 10,000 frequencies, one input and output": (
            lambda: REST.frf(HZ, "fz", "z", cable_model="shallow-dynamic"),
            1,
        ),
        "shallow-dynamic: 10,000 frequencies, all 36 entries": (
            lambda: REST.receptance(HZ, cable_model="shallow-dynamic"),
            1,
        ),
        "catenary-dynamic: 10,000 frequencies, all 36 entries, with statics and set-up": (
            lambda: ROBOT.receptance(HZ),
            1,
        ),
        "catenary-dynamic: modes below 20 Hz, with statics and set-up": (lambda: ROBOT.modes(20), 1),
    }
    for name, (call, parts) in jobs.items():
        print(f"{name:78} {1e6 * best(call) / parts:12.2f} µs")


if __name__ == "__main__":
    main()
