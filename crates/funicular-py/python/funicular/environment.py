"""Environments of Gymnasium: a robot that vibrates as in `simulate`, driven by the rates of its lengths.

`RobotEnv` is one robot, `VectorRobotEnv` several that advance side by side on threads. The task is to bring the platform
to a pose and to keep it there without swaying; another task is another `reward`. They need the extra `gymnasium`.

>>> import funicular
>>> from funicular.environment import RobotEnv  # doctest: +SKIP
>>> env = RobotEnv(funicular.Robot.example(), poses=([-0.5, -0.5, 1], [0.5, 0.5, 1.5]))  # doctest: +SKIP
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from funicular import InputError, NoSolutionError, Pose, Robot, Simulation, StaticsError
from funicular._words import TensionRule

Floats = npt.NDArray[np.float64]

# Coarse mesh, for speed: an episode of interest is repeated with the mesh of `simulate`.
DEFAULT_MESH: Mapping[str, Any] = {"elements": 1, "degree": 6, "tolerance_m": 1e-5}

# Poses that are drawn before the box of targets counts as one that the cables do not hold.
MAX_DRAWS = 100


class Task(NamedTuple):
    """State of the task after a step, for a reward of one's own."""

    # Position of the target as seen from the platform, world axes [m], and turn to it as a rotation vector [rad].
    to_target_m: Floats
    to_target_rad: Floats
    velocity_m_s: Floats
    angular_velocity_rad_s: Floats
    tension_platform_n: Floats
    # Action of the step, from -1 to 1 per cable.
    action: Floats
    period_s: float


def distance_and_sway(task: Task) -> float:
    """Negative time integral of distance [m], turn [rad], and a tenth of the squared velocity and of the squared action.

    Its size is comparable for all robots of some metres; the sum over an episode falls with the time to arrive.
    """
    speed = float(task.velocity_m_s @ task.velocity_m_s + task.angular_velocity_rad_s @ task.angular_velocity_rad_s)
    away = float(np.linalg.norm(task.to_target_m) + np.linalg.norm(task.to_target_rad))
    return -task.period_s * (away + 0.1 * speed + 0.1 * float(np.mean(task.action**2)))


class RobotEnv(gymnasium.Env[Floats, Floats]):
    """Platform on cables that sag and vibrate; the action is the rate of every length.

    An action holds one number from -1 to 1 per cable: the rate that its winch reaches at the end of the period, over
    `max_rate_m_s`; between two actions the rate is linear in time, so that lengths have no corner. An observation holds,
    in this order: position of the target as seen from the platform [m] (3), turn to it as a rotation vector [rad] (3),
    velocity of the platform [m/s] (3), its angular velocity [rad/s] (3), all in world axes, and per cable the tension at
    the platform over `tension_unit_n`, the change of its length since the start [m], and its rate over `max_rate_m_s`.

    An episode is truncated after `duration_s`. It terminates, with the reward `failure_reward`, if a tension at the
    platform leaves the limits of the robot file (with `keep_tensions`), or if no step follows the motion.

    Parameters
    ----------
    robot
        Robot.
    poses
        Lowest and highest pose of the box from which targets are drawn: positions [m], or positions with roll, pitch,
        yaw [degrees]. Poses that the cables do not hold are drawn again.
    start
        Pose at the beginning of every episode; that of the file's lengths if not given.
    period_s
        Time between two actions [s].
    duration_s
        Time after which an episode is truncated [s].
    max_rate_m_s
        Rate of a length that belongs to the action 1 [m/s].
    max_acceleration_m_s2
        Change of a rate over the period that is possible [m/s²]; an action beyond it is cut, as by a winch. It is at
        most 1000.
    payload_kg
        Least and largest mass that is picked up at the beginning, drawn anew for each episode; none if not given.
    force_n
        Largest force of a push of 0.1 s in a random direction that comes at a random time of the episode [N].
    tension_rule
        Rule for the tensions at `start` and at the targets; that of `Robot.equilibrium` if not given.
    tension_unit_n
        Tension that stands for 1 in an observation [N]; the mean one at the start if not given.
    reward
        Function from `Task` to the reward of a step; `distance_and_sway` if not given.
    failure_reward
        Reward of the step at which an episode terminates.
    keep_tensions
        True if an episode ends where a tension leaves the limits of the robot file.
    mesh
        Keywords of `Equilibrium.simulation`: elements, degree, tolerance and damping of the ropes.

    Raises
    ------
    InputError
        An argument is out of its range.
    NoSolutionError
        The cables do not hold the start, or no pose of the box was found that they hold.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        robot: Robot,
        poses: tuple[Sequence[float], Sequence[float]],
        *,
        start: Sequence[float] | Pose | None = None,
        period_s: float = 0.01,
        duration_s: float = 5.0,
        max_rate_m_s: float = 0.5,
        max_acceleration_m_s2: float = 10.0,
        payload_kg: tuple[float, float] | None = None,
        force_n: float = 0.0,
        tension_rule: TensionRule | None = None,
        tension_unit_n: float | None = None,
        reward: Callable[[Task], float] = distance_and_sway,
        failure_reward: float = -10.0,
        keep_tensions: bool = True,
        mesh: Mapping[str, Any] = DEFAULT_MESH,
    ) -> None:
        super().__init__()
        for name, value, highest in [
            ("period_s", period_s, 1.0),
            ("duration_s", duration_s, math.inf),
            ("max_rate_m_s", max_rate_m_s, 50.0),
            ("max_acceleration_m_s2", max_acceleration_m_s2, 1000.0),
        ]:
            if not 0 < value <= highest or not math.isfinite(value):
                limit = "above 0" if math.isinf(highest) else f"above 0 and at most {highest:g}"
                raise InputError(f"`{name}` is {value:g}: give a number {limit}")
        low, high = (np.asarray(of, dtype=float) for of in poses)
        if low.shape != high.shape or low.shape not in [(3,), (6,)] or not np.all(low <= high):
            raise InputError("`poses` are the lowest and the highest pose of a box: two rows of three numbers, or of six, the first not above the second")
        if payload_kg is not None and not 0 < payload_kg[0] <= payload_kg[1]:
            raise InputError("`payload_kg` is the least and the largest mass: two positive numbers, the first not above the second")

        self.robot, self.period_s, self.max_rate_m_s = robot, period_s, max_rate_m_s
        self._poses = (low, high)
        self._rule = tension_rule
        self._max_change = max_acceleration_m_s2 * period_s
        self._payload, self._force = payload_kg, force_n
        self._reward, self._failure_reward, self._keeps = reward, failure_reward, keep_tensions
        self._periods = max(1, round(duration_s / period_s))

        rest = robot.equilibrium() if start is None else robot.equilibrium(pose=start, tension_rule=tension_rule)
        self._simulation: Simulation = rest.simulation(**mesh)
        self._at_rest = self._simulation.save()
        self._lengths = np.array(self._simulation.unstrained_length_m)
        cables = rest.to_dict()["cables"]
        self._minimum = np.array([cable.get("minimum_tension_n", 0.0) for cable in cables])
        self._maximum = np.array([cable.get("maximum_tension_n", math.inf) for cable in cables])
        self._unit = float(np.mean(rest.tension_platform_n)) if tension_unit_n is None else tension_unit_n
        self._done, self._target, self._push = 0, rest.pose, (math.inf, np.zeros(3))

        count = len(robot.cable_names)
        size = 12 + 3 * count
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (size,), np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (count,), np.float64)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begins an episode at the start, with a target drawn from the box.

        `options={"target": pose}` gives the target instead.
        """
        super().reset(seed=seed)
        self._simulation.restore(self._at_rest)
        self._done = 0
        given = (options or {}).get("target")
        self._target = self._drawn() if given is None else _pose_of(given)
        if self._payload is not None:
            self._simulation.pick(float(self.np_random.uniform(*self._payload)))
        self._push = (math.inf, np.zeros(3))
        if self._force > 0:
            direction = self.np_random.normal(size=3)
            at = float(self.np_random.uniform(0, self._periods * self.period_s))
            self._push = (at, self._force * direction / np.linalg.norm(direction))
        return self._observation(), {"target": self._target}

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Advances by one period with the rates that the action asks for."""
        action = np.clip(np.asarray(action, dtype=float), -1.0, 1.0)
        if action.shape != self._lengths.shape or not np.all(np.isfinite(action)):
            raise InputError(f"an action holds {len(self._lengths)} finite numbers, one per cable")
        simulation = self._simulation
        before = np.array(simulation.length_rate_m_s)
        change = np.clip(self.max_rate_m_s * action - before, -self._max_change, self._max_change)
        lengths = np.array(simulation.unstrained_length_m) + self.period_s * (before + 0.5 * change)

        at, force_w = self._push
        if simulation.time_s >= at:
            simulation.push(0.1, force_n=force_w)
            self._push = (math.inf, np.zeros(3))
        try:
            simulation.step(self.period_s, lengths_m=lengths, rates_m_s=before + change)
        except NoSolutionError as failed:
            return self._observation(), self._failure_reward, True, False, {"failed": str(failed)}

        self._done += 1
        failed_why = self._broken_limit()
        reward = self._failure_reward if failed_why else self._reward(self._task(action))
        info = {"failed": failed_why} if failed_why else {}
        return self._observation(), reward, bool(failed_why), self._done >= self._periods, info

    @property
    def simulation(self) -> Simulation:
        """Simulation of the episode, for events of one's own and to look at."""
        return self._simulation

    @property
    def target(self) -> Pose:
        """Pose at which the platform shall arrive."""
        return self._target

    def _drawn(self) -> Pose:
        low, high = self._poses
        for _ in range(MAX_DRAWS):
            pose = _pose_of(self.np_random.uniform(low, high))
            try:
                self.robot.equilibrium(pose=pose, tension_rule=self._rule)
            except StaticsError:
                continue
            return pose
        raise NoSolutionError(f"of {MAX_DRAWS} poses drawn from `poses` the cables hold none: give another box")

    def _task(self, action: Floats) -> Task:
        pose, simulation = self._simulation.pose, self._simulation
        turn = _rotation_vector(self._target.rotation @ pose.rotation.T)
        return Task(
            np.asarray(self._target.position_m) - np.asarray(pose.position_m),
            turn,
            np.array(simulation.velocity_m_s),
            np.array(simulation.angular_velocity_rad_s),
            np.array(simulation.tension_platform_n),
            action,
            self.period_s,
        )

    def _observation(self) -> Floats:
        task = self._task(np.zeros(0))
        lengths = np.array(self._simulation.unstrained_length_m) - self._lengths
        rates = np.array(self._simulation.length_rate_m_s) / self.max_rate_m_s
        parts = [task.to_target_m, task.to_target_rad, task.velocity_m_s, task.angular_velocity_rad_s]
        return np.concatenate([*parts, task.tension_platform_n / self._unit, lengths, rates])

    def _broken_limit(self) -> str:
        if not self._keeps:
            return ""
        tensions, names = np.array(self._simulation.tension_platform_n), self._simulation.cable_names
        for limit, sign, word in [(self._minimum, 1, "minimum"), (self._maximum, -1, "maximum")]:
            beyond = sign * (limit - tensions)
            worst = int(np.argmax(beyond))
            if beyond[worst] > 0:
                return f'cable "{names[worst]}" has {tensions[worst]:.4g} N, beyond its {word} of {limit[worst]:.4g} N'
        return ""


class VectorRobotEnv(VectorEnv[Floats, Floats, npt.NDArray[Any]]):
    """Robots that advance side by side on threads: steps hold no lock of Python.

    An environment whose episode has ended begins the next one at the next step, whose action it ignores
    (`AutoresetMode.NEXT_STEP`). Seeds count up from the first one.

    Parameters
    ----------
    num_envs
        Number of environments.
    robot, poses
        As for `RobotEnv`, for all environments.
    threads
        Number of threads; as many as the machine has processors if not given.
    keywords
        Further keywords of `RobotEnv`.
    """

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int,
        robot: Robot,
        poses: tuple[Sequence[float], Sequence[float]],
        *,
        threads: int | None = None,
        **keywords: Any,
    ) -> None:
        super().__init__()
        if num_envs < 1:
            raise InputError(f"`num_envs` is {num_envs}: give a positive number")
        self.envs = [RobotEnv(robot, poses, **keywords) for _ in range(num_envs)]
        self.num_envs = num_envs
        self.single_observation_space = self.envs[0].observation_space
        self.single_action_space = self.envs[0].action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._pool = ThreadPoolExecutor(threads)
        self._ended = np.zeros(num_envs, dtype=bool)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins an episode in every environment; a single seed counts up."""
        seeds = [None if seed is None else seed + k for k in range(self.num_envs)] if seed is None or isinstance(seed, int) else list(seed)
        if len(seeds) != self.num_envs:
            raise InputError(f"`seed` has {len(seeds)} numbers for {self.num_envs} environments")
        begun = list(self._pool.map(lambda pair: pair[0].reset(seed=pair[1], options=options), zip(self.envs, seeds, strict=True)))
        self._ended[:] = False
        return np.stack([of for of, _ in begun]), self._infos([info for _, info in begun])

    def step(self, actions: Floats) -> tuple[Floats, Floats, npt.NDArray[np.bool_], npt.NDArray[np.bool_], dict[str, Any]]:
        """Advances every environment by one period."""

        def one(k: int) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
            if self._ended[k]:
                observation, info = self.envs[k].reset()
                return observation, 0.0, False, False, info
            return self.envs[k].step(actions[k])

        done = list(self._pool.map(one, range(self.num_envs)))
        observations, rewards, terminated, truncated, infos = zip(*done, strict=True)
        ends = np.array(terminated), np.array(truncated)
        self._ended = ends[0] | ends[1]
        return np.stack(observations), np.array(rewards, dtype=float), *ends, self._infos(infos)

    def close_extras(self, **kwargs: Any) -> None:
        """Ends the threads."""
        self._pool.shutdown()

    def _infos(self, infos: Sequence[dict[str, Any]]) -> dict[str, Any]:
        joined: dict[str, Any] = {}
        for k, info in enumerate(infos):
            joined = self._add_info(joined, info, k)
        return joined


def _pose_of(given: Pose | Sequence[float] | Floats) -> Pose:
    """Pose, or position [m] with or without roll, pitch, yaw [degrees], as a pose."""
    return given if isinstance(given, Pose) else Pose(given[:3], given[3:] if len(given) > 3 else [0, 0, 0])


def _rotation_vector(rotation: Floats) -> Floats:
    """Rotation vector of a rotation matrix [rad], by its quaternion: also at half a turn."""
    trace = float(np.trace(rotation))
    axis = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    sine = 0.5 * float(np.linalg.norm(axis))
    angle = math.atan2(sine, 0.5 * (trace - 1.0))
    if sine > 1e-9:
        return axis * (angle / (2.0 * sine))
    if trace > 0:
        return 0.5 * axis
    # Half a turn: the axis is the column of (R + 1)/2 with the largest diagonal entry.
    squares = 0.5 * (rotation + np.eye(3))
    k = int(np.argmax(np.diag(squares)))
    return math.pi * squares[:, k] / math.sqrt(squares[k, k])
