"""The simulator, and the whole robot on the simulator and on a body in Python."""

import numpy as np
import pytest
import trundle


def drive(seed, seconds):
    simulator = trundle.Simulator("demo", seed)
    robot = trundle.Robot()
    robot.drive_to((0.4, 0, 0))
    poses, twists = [], []
    while simulator.stamp < seconds:
        step = robot.step(simulator.next_event())
        if step.twist is not None:
            simulator.command(step.twist)
            twists.append(step.twist)
        poses.append(step.pose)
        if step.is_finished:
            break
    return simulator, robot, step, np.array(poses), np.array(twists)


def test_the_robot_reaches_its_goal():
    simulator, robot, step, poses, twists = drive(1, 30.0)
    assert step.is_finished and step.state == "arrived", step
    assert simulator.truth()["contacts"] == 0
    np.testing.assert_allclose(poses[-1], [0.4, 0, 0], atol=0.05)
    assert (robot.grid().cells == 100).any() and robot.scan() is not None
    assert robot.covariance.shape == (3, 3) and twists.shape[1] == 2
    start, truth = simulator.start, simulator.truth()["pose"]
    assert abs(np.hypot(*(truth - start)[:2]) - 0.4) < 0.03


def test_the_same_seed_gives_the_same_bytes():
    first, second = drive(7, 1.5), drive(7, 1.5)
    np.testing.assert_array_equal(first[3], second[3])
    np.testing.assert_array_equal(first[4], second[4])


def test_a_robot_without_sight_stands():
    robot = trundle.Robot()
    robot.drive_to((1, 0, 0))
    for i in range(100):
        robot.step(trundle.Gyro(i * 0.02, 0.0))
        step = robot.step(trundle.Wheels(i * 0.02 + 0.01, 0, 0))
        assert step.twist is not None and not step.twist.any()
    assert step.state == "initializing" and step.reason is None
    robot.stop()


def test_every_kind_of_event_is_taken(images):
    robot = trundle.Robot()
    events = [
        trundle.Wheels(0.0, 10, 65535),
        trundle.Gyro(0.01, -0.5),
        images[1][0],
        trundle.Touch(1.0, True),
        trundle.Cliff(1.1, False),
        trundle.Odometry(1.2, (0, 0, 0), (0, 0), np.eye(3) * 1e-4),
        trundle.BodyCondition.silence(1.3),
        trundle.BodyCondition.link(1.4, "camera", False),
        trundle.BodyCondition.wheel_drop(1.5, True, False),
        trundle.BodyCondition.over_current(1.5, False, True),
        trundle.BodyCondition.battery(1.5, 15.2, charge=0.8, source="charging_station", is_charging=True),
        trundle.BodyCondition.button(1.5, 0, True),
        trundle.BodyCondition.dock_infrared(1.5, ["near_left"], ["far_center"], []),
        trundle.Scan(1.6, np.full(10, 2.0), 0.0, 0.1, range_max=10.0),
    ]
    for event in events:
        assert robot.step(event).stamp == event.stamp
        assert type(event).__name__ in repr(event)


def test_a_simulator_steps_in_whole_milliseconds():
    simulator = trundle.Simulator("room", 1, camera=None, laser="lds-01")
    events = simulator.step([0.1, 0.0], 0.25)
    assert simulator.stamp == 0.25
    stamps = [event.stamp for event in events]
    assert stamps == sorted(stamps) and {type(event) for event in events} >= {trundle.Wheels, trundle.Gyro, trundle.Scan}
    assert simulator.rgbd() is None and simulator.scan() is not None
    truth = simulator.truth()
    assert 0 < truth["path_length"] < 0.025 and truth["clearance"] > 0
    with pytest.raises(ValueError, match="duration is 0 s"):
        simulator.step([0, 0], 0)


def test_seeds_and_scenes():
    assert "warehouse" in trundle.Simulator.scenes()
    with pytest.raises(ValueError, match="one of demo, room"):
        trundle.Simulator("no-such-scene")
    with pytest.raises(ValueError, match="rplidar-a1"):
        trundle.Simulator("room", laser="no-such-laser")
    ranges = [trundle.Simulator("room", seed, camera=None, laser="lds-01").step([0, 0], 0.3) for seed in (1, 1, 2)]
    scans = [[event.ranges for event in events if isinstance(event, trundle.Scan)][-1] for events in ranges]
    np.testing.assert_array_equal(scans[0], scans[1])
    assert not np.array_equal(scans[0], scans[2])
