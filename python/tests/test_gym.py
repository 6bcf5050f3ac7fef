"""The Gymnasium environments."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import trundle.gym
from trundle.gym import DriveToGoal, DriveToGoalVector


def test_the_checker_finds_nothing():
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        check_env(DriveToGoal("room"), skip_render_check=True)
    # The checker advises bounds of 1 for actions, but these bounds are in m/s and rad/s.
    texts = [str(warning.message) for warning in found if "normalized" not in str(warning.message)]
    assert not [text for text in texts if "infinity" not in text], texts


def test_it_is_registered():
    env = gymnasium.make("trundle/DriveToGoal-v0", scene="corridor-a")
    observation, info = env.reset(seed=3)
    assert observation in env.observation_space and info["contacts"] == 0
    vector = gymnasium.make_vec("trundle/DriveToGoal-v0", num_envs=2, vectorization_mode="vector_entry_point", scene="room")
    assert vector.reset(seed=1)[0]["ranges"].shape == (2, 682)


def test_the_same_seed_gives_the_same_episode():
    def episode(seed):
        env = DriveToGoal("room")
        observation, _ = env.reset(seed=seed)
        rewards = []
        for i in range(15):
            observation, reward, *_ = env.step(np.array([0.3, 0.2 * (-1) ** i], np.float32))
            rewards.append(reward)
        return observation, rewards

    (first, rewards), (second, again), (other, _) = episode(5), episode(5), episode(6)
    assert rewards == again
    for key in first:
        np.testing.assert_array_equal(first[key], second[key])
    assert not np.array_equal(first["ranges"], other["ranges"])


def test_the_vector_is_its_single_environments():
    count, steps, limit = 3, 12, 0.8
    vector = DriveToGoalVector(count, "room", time_limit=limit)
    singles = [DriveToGoal("room", time_limit=limit) for _ in range(count)]
    together, _ = vector.reset(seed=10)
    alone = [env.reset(seed=10 + i)[0] for i, env in enumerate(singles)]
    chance, ended = np.random.default_rng(1), np.zeros(count, bool)
    for _ in range(steps):
        for key in together:
            np.testing.assert_array_equal(together[key], np.stack([one[key] for one in alone]))
        actions = chance.uniform(-0.4, 0.4, (count, 2)).astype(np.float32)
        together, rewards, terminated, truncated, infos = vector.step(actions)
        for i, env in enumerate(singles):
            if ended[i]:
                alone[i], reward = env.reset()[0], 0.0
            else:
                alone[i], reward, over, late, info = env.step(actions[i])
                assert (over, late) == (terminated[i], truncated[i])
                assert info["distance"] == infos["distance"][i]
            assert reward == rewards[i]
        ended = terminated | truncated
    assert steps * 0.1 > limit, "at least one new start is part of it"


def test_a_robot_that_drives_to_the_goal_is_rewarded():
    env = DriveToGoal("corridor-a", time_limit=60)
    observation, info = env.reset(seed=1)
    total, start = 0.0, info["distance"]
    for _ in range(600):
        x, y, _ = observation["goal"]
        bearing = np.arctan2(y, x)
        action = np.array([0.3 if abs(bearing) < 0.3 else 0.0, np.clip(2 * bearing, -1, 1)], np.float32)
        observation, reward, terminated, truncated, info = env.step(action)
        total += reward
        if terminated or truncated or info["contacts"]:
            break
    assert info["distance"] < start
    expected = start - info["distance"] - info["contacts"] + 10.0 * terminated
    assert total == pytest.approx(expected, abs=1e-6)


def test_wrong_actions_are_refused():
    env = DriveToGoal("room")
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(np.zeros(2, np.float32))
    env.reset(seed=1)
    with pytest.raises(ValueError, match="shape"):
        env.step(np.zeros(3, np.float32))
    with pytest.raises(ValueError, match="NaN"):
        env.step(np.array([np.nan, 0], np.float32))
    for wrong in [dict(period=0.0), dict(scene="nowhere"), dict(laser="none"), dict(render_mode="human")]:
        with pytest.raises(ValueError):
            DriveToGoal(**wrong)
    with pytest.raises(ValueError, match="num_envs"):
        trundle.gym.DriveToGoalVector(0)
