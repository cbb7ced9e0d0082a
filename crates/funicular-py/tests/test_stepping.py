"""Simulation in intervals: equal to `simulate`, the same bits from a saved state, refused input."""

import copy
import threading
from typing import Any

import numpy as np
import pytest
from funicular import InputError, NoSolutionError, Robot, Simulation

SETTINGS: dict[str, Any] = {"elements": 1, "degree": 6, "tolerance_m": 1e-6}


@pytest.fixture
def simulation(robot: Robot) -> Simulation:
    return robot.equilibrium().simulation(**SETTINGS, tension_control=["1"])


def values(of: Simulation) -> list[Any]:
    """All values of a simulation."""
    names = [name for name in dir(of) if not name.startswith("_") and not callable(getattr(of, name))]
    return [(name, np.asarray(value).tolist() if name != "pose" else value) for name in names if (value := getattr(of, name)) is not None]


def test_a_thousand_steps_are_one_run(robot: Robot) -> None:
    push = {"at_s": 0.0, "duration_s": 0.3, "force_n": [30.0, 0.0, 0.0]}
    run = robot.simulate({"push": [push]}, 1.0, sample_time_s=0.001, once=True, **SETTINGS)
    simulation = robot.equilibrium().simulation(**SETTINGS)
    simulation.push(0.3, force_n=[30, 0, 0])
    places, tensions = [], []
    for _ in range(1000):
        simulation.step(0.001)
        places.append(simulation.pose.position_m)
        tensions.append(simulation.tension_platform_n)
    # The run drops its factored matrix where it notes its state: the same to the bit until then, later within tolerances.
    rows, wanted = run["rows"][1:], [row["position_m"] for row in run["rows"][1:]]
    assert np.allclose(places[:100], wanted[:100], rtol=0, atol=1e-14)
    assert np.allclose(places, wanted, rtol=0, atol=5e-6)
    assert np.allclose(tensions, [row["tensions_platform_n"] for row in rows], rtol=0, atol=0.5)
    assert abs(simulation.steps["accepted"] - run["steps"]["accepted"]) <= 3


def test_a_saved_state_goes_on_with_the_same_bits(robot: Robot, simulation: Simulation) -> None:
    simulation.release(0.5)
    simulation.step(0.002, force_n=[5, 0, 0], force_rate_n_s=[0, 10, 0])
    simulation.cut("2")
    simulation.cut("3", at_tension_n=900)
    simulation.hold_tensions({"1": 40.0}, 0.01)
    simulation.step(0.0015)
    saved = simulation.save()
    others = [simulation.clone(), copy.copy(simulation), copy.deepcopy(simulation)]
    others.append(robot.equilibrium().simulation(**SETTINGS, tension_control=["1"]))
    others[-1].restore(saved)
    for of in (simulation, *others):
        of.pick(0.2, velocity_m_s=[0, 0, -0.1])
        of.change_lengths({"5": -0.001}, 0.02)
        of.step(0.004)
        of.stop(0.01, ["5"])
        of.step(0.001, moment_n_m=[0, 0, 0.5])
    assert all(values(of) == values(simulation) and of.save() == simulation.save() for of in others)
    assert simulation.cut_cables == ["2"] and simulation.time_s == pytest.approx(0.0085)
    simulation.restore(saved)
    assert simulation.save() == saved


def test_refused_input_changes_nothing(simulation: Simulation) -> None:
    simulation.step(0.001)
    saved, length = simulation.save(), simulation.unstrained_length_m
    steps: list[tuple[dict[str, Any], str]] = [
        ({"dt_s": 0.0}, "`dt_s` is 0"),
        ({"dt_s": -1e-3}, "`dt_s`"),
        ({"dt_s": 10.0}, "give 0.000001 to 1 s"),
        ({"dt_s": float("nan")}, "`dt_s`"),
        ({"dt_s": 1e-3, "lengths_m": length[:3]}, "3 numbers, and the robot has 6 cables"),
        ({"dt_s": 1e-3, "lengths_m": {"seven": 6.0}}, 'no cable "seven"'),
        ({"dt_s": 1e-3, "lengths_m": length + 0.01}, "which is a jump"),
        ({"dt_s": 1e-3, "lengths_m": {"1": float("nan")}}, "finite"),
        ({"dt_s": 1e-3, "rates_m_s": {"1": 0.1}}, "without its length"),
        ({"dt_s": 1e-3, "force_n": [1, 2]}, "x, y, z"),
        ({"dt_s": 1e-3, "force_n": [float("nan"), 0, 0]}, "finite"),
        ({"dt_s": 1e-3, "force_rate_n_s": [1, 0, 0]}, "needs the force itself"),
    ]
    for keywords, says in steps:
        with pytest.raises(InputError, match=says):
            simulation.step(**keywords)
    for event, says in [
        (lambda: simulation.cut("seven"), 'no cable "seven"'),
        (lambda: simulation.release(1e9), "mass"),
        (lambda: simulation.hold_tensions({"2": 40.0}, 0.1), "tension_control"),
        (lambda: simulation.push(0.1), "no force and no moment"),
        (lambda: simulation.restore(b"no state"), "no saved state"),
        (lambda: simulation.restore(saved[:-1] + bytes([saved[-1] ^ 1])), "damaged"),
    ]:
        with pytest.raises(InputError, match=says):
            event()
    with pytest.raises(NoSolutionError):
        simulation.step(0.01, force_n=[1e120, 0, 0])
    assert simulation.save() == saved


def test_states_belong_to_a_robot_and_a_start(robot: Robot, simulation: Simulation) -> None:
    saved = simulation.save()
    for other in (robot.with_(mass_kg=1.1 * robot.mass_kg).equilibrium(), robot.equilibrium(force_n=[1, 0, 0])):
        with pytest.raises(InputError, match="another robot"):
            other.simulation(**SETTINGS, tension_control=["1"]).restore(saved)


def test_two_threads_get_two_simulations_or_a_message(simulation: Simulation) -> None:
    simulation.push(1.0, force_n=[10, 0, 0])
    failed: list[Exception] = []

    def steps() -> None:
        for _ in range(50):
            try:
                simulation.step(0.001)
            except InputError as error:
                failed.append(error)

    threads = [threading.Thread(target=steps) for _ in range(2)]
    [thread.start() for thread in threads]  # type: ignore[func-returns-value]
    [thread.join() for thread in threads]  # type: ignore[func-returns-value]
    assert all("another thread" in str(error) for error in failed)
    assert simulation.time_s == pytest.approx(0.001 * (100 - len(failed)))
