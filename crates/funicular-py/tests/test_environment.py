"""Environments for control and learning: Gymnasium's own checks, seeds, threads, episodes that end."""

import math
import resource
from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import ROOT
from funicular import InputError, NoSolutionError, Pose, Robot
from funicular.environment import RobotEnv, Task, VectorRobotEnv, _rotation_vector
from gymnasium.utils.env_checker import check_env

BOX = ([-0.2, -0.2, 1.1], [0.2, 0.2, 1.4])
MESH = {"elements": 1, "degree": 4, "tolerance_m": 1e-4}


def cogiro(**more: Any) -> RobotEnv:
    robot = Robot.from_file(ROOT / "robots/cogiro.toml")
    return RobotEnv(robot, ([-0.5, -0.5, 1.5, 0, 0, -5], [0.5, 0.5, 2, 0, 0, 5]), start=[0, 0, 2], mesh=MESH, **more)


@pytest.mark.filterwarnings("ignore:.*Box (observation|action) space.*infinity")
def test_gymnasium_accepts_the_environments(robot: Robot) -> None:
    for env in (RobotEnv(robot, BOX, mesh=MESH), cogiro(payload_kg=(1, 20), force_n=50)):
        check_env(env, skip_render_check=True)


def test_the_same_seed_gives_the_same_episode() -> None:
    env, other = cogiro(payload_kg=(1, 20), force_n=50), cogiro(payload_kg=(1, 20), force_n=50)
    for seed in (3, 3, 4):
        episodes = []
        for of in (env, other):
            of.action_space.seed(7)
            rows = [of.reset(seed=seed)[0]]
            rows.extend(of.step(of.action_space.sample())[0] for _ in range(30))
            episodes.append(np.array(rows))
        assert np.array_equal(*episodes)


def test_feed_forward_by_lengths_arrives(robot: Robot) -> None:
    """Independent of the environment: lengths of the target by statics, run along a course of the fifth degree."""
    env = RobotEnv(robot, BOX, duration_s=4, max_rate_m_s=0.5, mesh=MESH)
    first, info = env.reset(seed=1)
    change = robot.equilibrium(pose=info["target"]).unstrained_length_m - env.simulation.unstrained_length_m
    seconds, rewards = 2.5, 0.0
    for k in range(400):
        u = min((k + 1) * env.period_s / seconds, 1)
        rates = change * 30 * u**2 * (1 - u) ** 2 / seconds
        observation, reward, terminated, truncated, _ = env.step(rates / 0.5)
        rewards += reward
        assert not terminated and truncated == (k == 399)
    reached = np.linalg.norm(observation[:3])
    assert reached < 0.03 * np.linalg.norm(first[:3]), (reached, first[:3])
    # The sum of the rewards is the integral of distance and turn, and little more.
    assert -4 * np.linalg.norm(first[:6]) < rewards < -0.8 * np.linalg.norm(first[:3])


def test_an_episode_ends_where_a_cable_breaks_its_limit() -> None:
    env = cogiro()
    env.reset(seed=1)
    pull = np.zeros(8)
    pull[0] = 1.0
    for _ in range(500):
        *_, reward, terminated, _, info = env.step(pull)
        if terminated:
            break
    assert terminated and reward == -10 and "beyond its minimum of 100 N" in info["failed"]
    free = cogiro(keep_tensions=False)
    free.reset(seed=1)
    assert not any(free.step(pull)[2] for _ in range(60))


def test_rates_follow_the_action_as_fast_as_the_winch() -> None:
    env = cogiro(max_rate_m_s=0.2, max_acceleration_m_s2=4)
    env.reset(seed=0)
    for k in range(8):
        observation, *_ = env.step(np.full(8, -1.0))
        assert np.allclose(observation[-8:], max(-(k + 1) * 0.2, -1), atol=1e-9)
    assert np.allclose(observation[-16:-8], -(0.2 * 0.08 - 0.5 * 0.2 * 0.05), atol=1e-9)


def test_many_environments_are_those_of_one_by_one(robot: Robot) -> None:
    many = VectorRobotEnv(5, robot, BOX, threads=2, duration_s=0.05, mesh=MESH)
    alone = [RobotEnv(robot, BOX, duration_s=0.05, mesh=MESH) for _ in range(5)]
    seen, info = many.reset(seed=10)
    begun = [env.reset(seed=10 + k) for k, env in enumerate(alone)]
    assert np.array_equal(seen, [of for of, _ in begun]) and info["_target"].all()
    rng = np.random.default_rng(0)
    for k in range(12):
        actions = rng.uniform(-1, 1, (5, 6))
        seen, rewards, terminated, truncated, _ = many.step(actions)
        if k in (5, 11):
            # The step after an end begins the next episode.
            wanted = [env.reset()[0] for env in alone]
            assert np.array_equal(seen, wanted) and not rewards.any() and not truncated.any()
            continue
        wanted_steps = [env.step(action) for env, action in zip(alone, actions, strict=True)]
        assert np.array_equal(seen, [of[0] for of in wanted_steps])
        assert np.array_equal(rewards, [of[1] for of in wanted_steps])
        assert not terminated.any() and truncated.all() == (k in (4, 10))
    many.close()


def test_memory_does_not_grow(robot: Robot) -> None:
    many = VectorRobotEnv(8, robot, BOX, duration_s=0.3, mesh=MESH)
    many.reset(seed=0)
    many.action_space.seed(1)

    def run(steps: int) -> int:
        for _ in range(steps):
            many.step(0.2 * many.action_space.sample())
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    first = run(100)
    assert run(300) - first < 8000
    many.close()


def test_a_reward_of_ones_own_and_a_given_target(robot: Robot) -> None:
    tasks: list[Task] = []
    env = RobotEnv(robot, BOX, reward=lambda task: tasks.append(task) or 1.5, mesh=MESH)
    target = Pose([0.1, 0, 1.3], [0, 0, 10])
    observation, info = env.reset(options={"target": target})
    assert info["target"] == target == env.target
    assert math.isclose(np.linalg.norm(observation[3:6]), math.radians(10), rel_tol=0.2)
    assert env.step(np.zeros(6))[1] == 1.5 and tasks[0].period_s == 0.01


def test_wrong_arguments_are_named(robot: Robot) -> None:
    for keywords, words in [
        ({"period_s": 0}, "period_s"),
        ({"duration_s": math.nan}, "duration_s"),
        ({"max_acceleration_m_s2": 2000}, "at most 1000"),
        ({"payload_kg": (3, 1)}, "payload_kg"),
    ]:
        with pytest.raises(InputError, match=words):
            RobotEnv(robot, BOX, **keywords)
    with pytest.raises(InputError, match="lowest and the highest"):
        RobotEnv(robot, (BOX[1], BOX[0]))
    with pytest.raises(InputError, match="num_envs"):
        VectorRobotEnv(0, robot, BOX)
    env = RobotEnv(robot, ([0, 0, 50], [0, 0, 60]), mesh=MESH)
    with pytest.raises(NoSolutionError, match="give another box"):
        env.reset(seed=0)
    env = RobotEnv(robot, BOX, mesh=MESH)
    env.reset(seed=0)
    with pytest.raises(InputError, match="6 finite numbers"):
        env.step(np.full(6, np.nan))


def test_a_turn_is_the_rotation_vector() -> None:
    rng = np.random.default_rng(1)
    for angle in (0, 1e-12, 1e-6, 0.3, 2, math.pi - 1e-7, math.pi):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        rotation = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
        found = _rotation_vector(rotation)
        assert min(np.abs(found - angle * axis).max(), np.abs(found + angle * axis).max() if angle > 3 else math.inf) < 1e-7


def test_it_is_an_environment_of_gymnasium(robot: Robot) -> None:
    assert isinstance(RobotEnv(robot, BOX, mesh=MESH), gymnasium.Env)
