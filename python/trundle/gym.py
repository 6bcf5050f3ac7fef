"""Gymnasium environments on trundle's simulator: drive to a goal by laser.

`DriveToGoal` is one environment; `DriveToGoalVector` is a vector of environments that step on all cores. Both give the same
observations, rewards and endings for the same seeds and actions. The import of this module registers both as `trundle/DriveToGoal-v0`.

>>> import gymnasium
>>> env = gymnasium.make("trundle.gym:trundle/DriveToGoal-v0", scene="room")
>>> observation, info = env.reset(seed=1)
>>> observation["ranges"].shape, observation["goal"].shape, env.action_space.shape
((682,), (3,), (2,))
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
>>> sorted(info)
['clearance', 'contacts', 'distance', 'pose']
"""

from __future__ import annotations

from typing import Any, cast

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._native import RobotConfig, SimulatorPool

#: Distance within which a goal counts as reached, m. Source: ours.
REACHED_M = 0.3
#: Reward for reaching the goal. Progress counts 1 per metre. Source: ours.
GOAL_REWARD = 10.0
#: Reward for each contact with an obstacle. Source: ours.
CONTACT_REWARD = -1.0

Observation = dict[str, NDArray[np.float32]]


class DriveToGoal(gymnasium.Env[Observation, NDArray[np.float32]]):
    """A simulated Kobuki with a laser drives to the goal of its scene.

    Action, float32 of shape (2,): v m/s, omega rad/s for one period.

    Observation, a dictionary of float32: `ranges` (beams,) m, with `range_max` for a beam without a hit and 0 for an unknown range;
    `goal` (3,), the goal in the base frame, x m, y m, theta rad; `twist` (2,), the last action.

    Reward: metres of progress to the goal, `GOAL_REWARD` at the goal, `CONTACT_REWARD` for each contact. Terminated at the goal, truncated at
    the time limit. `info`: `distance` m, `contacts`, and the true `pose` (3,) and `clearance` m.
    """

    metadata: dict[str, Any] = {"render_modes": [], "render_fps": 10}

    def __init__(
        self,
        scene: str = "room",
        laser: str = "urg-04lx",
        *,
        noise: bool = True,
        period: float = 0.1,
        time_limit: float = 60.0,
        render_mode: str | None = None,
    ) -> None:
        """Scene and laser as for `trundle.Simulator`; `period` s is the duration of an action, `time_limit` s the time until truncation."""
        if render_mode is not None:
            raise ValueError(f"render_mode is {render_mode!r}, expected None")
        self.render_mode = None
        self._worlds = _Worlds(1, scene, laser, noise, period, time_limit)
        self.observation_space = cast(Any, self._worlds.observation_space)
        self.action_space = self._worlds.action_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Restarts the environment; `seed` is the seed of scene and noise."""
        super().reset(seed=seed)
        self._worlds.reset(np.array([0]), [_world_seed(self.np_random)])
        return self._worlds.observation(0), self._worlds.info(0)

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Drives for one period."""
        rewards, terminated, truncated = self._worlds.step(np.asarray(action, np.float32).reshape(1, -1), np.array([True]))
        observation, info = self._worlds.observation(0), self._worlds.info(0)
        return observation, float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info


class DriveToGoalVector(VectorEnv[Observation, NDArray[np.float32], NDArray[Any]]):
    """A vector of `DriveToGoal`, stepped by all cores without the interpreter's lock.

    An ended environment restarts in the next step and ignores the action of that step (`AutoresetMode.NEXT_STEP`). Environment i of a
    reset with seed s equals a `DriveToGoal` with seed s + i.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        scene: str = "room",
        laser: str = "urg-04lx",
        *,
        noise: bool = True,
        period: float = 0.1,
        time_limit: float = 60.0,
        render_mode: str | None = None,
    ) -> None:
        """The arguments are those of `DriveToGoal`; `num_envs` is the number of environments."""
        super().__init__()
        if render_mode is not None:
            raise ValueError(f"render_mode is {render_mode!r}, expected None")
        self.render_mode = None
        self.num_envs = num_envs
        self._worlds = _Worlds(num_envs, scene, laser, noise, period, time_limit)
        self.single_observation_space = self._worlds.observation_space
        self.single_action_space = self._worlds.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._chance = [np.random.default_rng(i) for i in range(num_envs)]
        self._ended = np.zeros(num_envs, bool)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Restarts all environments; environment i has the seed `seed + i`, or `seed[i]`."""
        seeds: list[int | None] = [None] * self.num_envs
        if isinstance(seed, int):
            seeds = [seed + i for i in range(self.num_envs)]
        elif seed is not None:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"{len(seeds)} seeds, expected {self.num_envs}")
        for i, own in enumerate(seeds):
            if own is not None or not self._worlds.has_started:
                self._chance[i] = gymnasium.utils.seeding.np_random(own)[0]
        everywhere = np.arange(self.num_envs)
        self._worlds.reset(everywhere, [_world_seed(chance) for chance in self._chance])
        self._ended[:] = False
        return self._worlds.observations(), self._worlds.infos()

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[Observation, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Drives all robots for one period."""
        ended = self._ended.copy()
        rewards, terminated, truncated = self._worlds.step(np.asarray(actions, np.float32), ~ended)
        if ended.any():
            fresh = np.flatnonzero(ended)
            self._worlds.reset(fresh, [_world_seed(self._chance[i]) for i in fresh])
        self._ended = terminated | truncated
        return self._worlds.observations(), rewards, terminated, truncated, self._worlds.infos()


class _Worlds:
    """The simulators of both environments, with rewards and endings."""

    def __init__(self, count: int, scene: str, laser: str, noise: bool, period: float, time_limit: float) -> None:
        if count < 1:
            raise ValueError(f"num_envs is {count}, expected 1 or more")
        if not 0.001 <= period <= time_limit:
            raise ValueError(f"period is {period} s, expected 0.001 s to the time_limit of {time_limit} s")
        self.pool = SimulatorPool(scene, list(range(count)), laser, noise=noise)
        self.period, self.max_steps = period, round(time_limit / period)
        self.range_max = np.float32(self.pool.range_max)
        self.steps, self.contacts = np.zeros(count, int), np.zeros(count, int)
        self.twists, self.distances = np.zeros((count, 2), np.float32), np.zeros(count)
        self.has_started = False
        robot, box = RobotConfig(), gymnasium.spaces.Box
        limits = np.array([robot.max_speed, robot.max_turn_rate], np.float32)
        self.action_space = box(-limits, limits, dtype=np.float32)
        far, half_turn = np.float32(np.inf), np.float32(np.pi) + np.float32(1e-6)
        self.observation_space = gymnasium.spaces.Dict(
            {
                "ranges": box(np.float32(0), self.range_max, (self.pool.ranges().shape[1],), np.float32),
                "goal": box(np.array([-far, -far, -half_turn]), np.array([far, far, half_turn]), dtype=np.float32),
                "twist": box(-limits, limits, dtype=np.float32),
            }
        )

    def reset(self, indices: NDArray[Any], seeds: list[int]) -> None:
        """Restarts some worlds, and waits for one period for the first scan."""
        self.pool.reset([int(i) for i in indices], seeds)
        waiting = np.full((len(self.steps), 2), np.nan)
        waiting[indices] = 0.0
        self.pool.step(waiting, self.period)
        self.steps[indices], self.twists[indices] = 0, 0.0
        self.contacts[indices] = self.pool.contacts()[indices]
        self.distances[indices] = self._distances()[indices]
        self.has_started = True

    def step(self, actions: NDArray[np.float32], active: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Drives the active robots; returns rewards, whether each is at its goal, and whether its time is over."""
        if not self.has_started:
            raise gymnasium.error.ResetNeeded("step before reset")
        if actions.shape != self.twists.shape:
            raise ValueError(f"action has shape {actions.shape}, expected {self.twists.shape}")
        if not np.isfinite(actions).all():
            raise ValueError("action holds NaN or infinity, expected v m/s and omega rad/s")
        twists = np.clip(actions, self.action_space.low, self.action_space.high)
        self.pool.step(np.where(active[:, None], twists, np.nan).astype(float), self.period)
        self.twists[active] = twists[active]
        self.steps[active] += 1
        distances, contacts = self._distances(), self.pool.contacts().astype(int)
        reached = active & (distances < REACHED_M)
        rewards = self.distances - distances + CONTACT_REWARD * (contacts - self.contacts) + GOAL_REWARD * reached
        self.distances, self.contacts = distances, contacts
        return np.where(active, rewards, 0.0), reached, active & ~reached & (self.steps >= self.max_steps)

    def observations(self) -> Observation:
        """Observations of all robots, stacked."""
        ranges = np.nan_to_num(self.pool.ranges(), nan=0.0, posinf=float(self.range_max)).clip(0, self.range_max)
        poses, goals = self.pool.poses(), self.pool.goals()
        ahead, left = (goals[:, :2] - poses[:, :2]).T
        cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        turn = (goals[:, 2] - poses[:, 2] + np.pi) % (2 * np.pi) - np.pi
        goal = np.column_stack([cos * ahead + sin * left, cos * left - sin * ahead, turn]).astype(np.float32)
        return {"ranges": ranges, "goal": goal, "twist": self.twists.copy()}

    def observation(self, index: int) -> Observation:
        """Observation of one robot."""
        return {key: values[index] for key, values in self.observations().items()}

    def infos(self) -> dict[str, Any]:
        """Information on all robots, stacked."""
        return {
            "distance": self.distances.copy(),
            "contacts": self.contacts.copy(),
            "pose": self.pool.poses(),
            "clearance": self.pool.clearances(),
        }

    def info(self, index: int) -> dict[str, Any]:
        """Information on one robot."""
        return {key: values[index] for key, values in self.infos().items()}

    def _distances(self) -> NDArray[Any]:
        difference = self.pool.goals()[:, :2] - self.pool.poses()[:, :2]
        return np.hypot(difference[:, 0], difference[:, 1])


def _world_seed(chance: np.random.Generator) -> int:
    return int(chance.integers(2**32))


gymnasium.register(
    id="trundle/DriveToGoal-v0",
    entry_point="trundle.gym:DriveToGoal",
    vector_entry_point="trundle.gym:DriveToGoalVector",
)
