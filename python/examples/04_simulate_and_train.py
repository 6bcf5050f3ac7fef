"""The simulator as a Gymnasium environment, with a policy improved by random search.

python 04_simulate_and_train.py; a few seconds on two cores.
"""

import numpy as np

from trundle.gym import DriveToGoalVector

ROBOTS, STEPS, ROUNDS = 16, 60, 3


def act(policy: np.ndarray, observation: dict[str, np.ndarray]) -> np.ndarray:
    """A policy that turns to the goal and away from near obstacles: three gains per robot, shape (robots, 3)."""
    ahead, left = observation["goal"][:, 0], observation["goal"][:, 1]
    bearing = np.arctan2(left, ahead)
    ranges = observation["ranges"]
    half = ranges.shape[1] // 2
    right_room, left_room = ranges[:, :half].min(axis=1), ranges[:, half:].min(axis=1)
    speed = policy[:, 0] * np.minimum(ranges[:, half - 60 : half + 60].min(axis=1), 1.0)
    turn = policy[:, 1] * bearing + policy[:, 2] * (left_room - right_room)
    return np.column_stack([np.clip(speed, 0.0, 0.4), np.clip(turn, -1.5, 1.5)]).astype(np.float32)


def returns(env: DriveToGoalVector, policies: np.ndarray) -> np.ndarray:
    """Sum of rewards of each policy, with all robots in the same room."""
    observation, _ = env.reset(seed=[1] * ROBOTS)
    total = np.zeros(ROBOTS)
    for _ in range(STEPS):
        observation, rewards, *_ = env.step(act(policies, observation))
        total += rewards
    return total


if __name__ == "__main__":
    env, chance = DriveToGoalVector(ROBOTS, "corridor-a", time_limit=600.0), np.random.default_rng(1)
    best, best_return = np.array([0.05, 0.2, 0.0]), -np.inf
    for turn in range(ROUNDS):
        candidates = best + chance.normal(0.0, 0.3, (ROBOTS, 3))
        candidates[0] = best
        found = returns(env, candidates)
        first = found[0]
        best, best_return = candidates[found.argmax()], found.max()
        print(f"round {turn}: {first:.2f} before, {best_return:.2f} now, policy {best.round(2)}")
        assert best_return >= first
