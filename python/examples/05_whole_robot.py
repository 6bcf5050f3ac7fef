"""The whole robot on a simulated body: a drive through an unknown room to a goal, and the map of the room.

python 05_whole_robot.py [SCENE]. Replace `Simulator` by your robot: give `Robot.step` each reading, and the base each twist.
"""

import sys

import numpy as np

import trundle

if __name__ == "__main__":
    body = trundle.Simulator(sys.argv[1] if len(sys.argv) > 1 else "demo", seed=1)
    robot = trundle.Robot(trundle.RobotConfig(seed=1))
    robot.drive_to((0.5, 0.0, 0.0))
    state = ""
    while body.stamp < 30.0:
        step = robot.step(body.next_event())
        if step.twist is not None:
            body.command(step.twist)
        if step.state != state:
            state = step.state
            print(f"{step.stamp:6.2f} s {state} {step.reason or ''}")
        if step.is_finished:
            break
    driven = np.hypot(*(body.truth()["pose"] - body.start)[:2])
    robot.grid().save("map.yaml", image="png")
    print(f"estimate {robot.pose.round(3)}, truly {driven:.3f} m driven, {body.truth()['contacts']} contacts; map.png")
    assert state == "arrived" and body.truth()["contacts"] == 0
