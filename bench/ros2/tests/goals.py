"""Score trundle's goals in MuJoCo against the truth: within 5 cm and 3 degrees, no contact.

goals.py --trundle PATH [--worlds flat corridor-a ...] [--seeds 0 1 2 3 4]. Each run starts the robot and `trundle ros2` anew, sends the
world's goals one after the other by NavigateToPose and writes a line of JSON to OUT/goals.jsonl. Exit 0: every goal was reached.
"""
import argparse
import json
import os
import pathlib
import sys
import tempfile

from harness import Checks, Process, start_robot
from mujoco_robot import worlds
from nav2_user import User, outcome, status

# Largest distance, m, and angle, deg, of the robot's truth from a goal (issue of the ROS 2 bridge).
DISTANCE_M, ANGLE_DEG = 0.05, 3.0
# Simulated time for one goal, s.
GOAL_LIMIT_S = 180


def options_of(parser):
    """Options that every drive of trundle has."""
    parser.add_argument("--trundle", required=True, help="path of the binary")
    parser.add_argument("--trundle-arguments", default="ros2 --ros-args -p use_sim_time:=true -r imu:=imu", help="what follows the binary")
    parser.add_argument("--out", type=pathlib.Path, default=None)
    parser.add_argument("--real-time-factor", type=float, default=1.0)
    parser.add_argument("--lock-step", type=float, default=0.5, help="seconds for which simulated time waits for a command")
    return parser


def start(options, folder, world, seed):
    """The robot and trundle; a list to end in reverse."""
    robot = start_robot(folder, "--world", world, "--seed", str(seed), "--real-time-factor", str(options.real_time_factor),
                        "--lock-step", str(options.lock_step))
    trundle = Process("trundle", [os.path.abspath(options.trundle), *options.trundle_arguments.split()], folder)
    return [robot, trundle]


def drive(user, goal):
    """Send one goal; the result, or None when the simulated time is up."""
    sent = user.go(goal)
    if not sent.accepted:
        return None
    end = user.now() + GOAL_LIMIT_S
    user.until(lambda: sent.done.done() or user.now() > end, GOAL_LIMIT_S * 10)
    if not sent.done.done():
        sent.cancel()
    return sent.wait(10)


def score(checks, options, world, seed, folder):
    processes = start(options, folder, world, seed)
    user, lines = User(), []
    try:
        if not checks.check(f"{world} {seed}: trundle is active", user.wait_until_active()):
            return lines
        for number, goal in enumerate(worlds.build(world, seed).goals):
            begin, result = user.now(), drive(user, goal)
            took = user.now() - begin
            user.wait_simulated(0.5)
            distance, angle = user.error_to(goal)
            good = status(result) == "SUCCEEDED" and distance <= DISTANCE_M and angle <= ANGLE_DEG
            checks.check(f"{world} {seed} goal {number}", good, f"{outcome(result)}, {100 * distance:.1f} cm, {angle:.2f} deg, {took:.1f} s")
            lines.append({"world": world, "seed": seed, "goal": number, "outcome": outcome(result), "distance_m": round(distance, 4),
                          "angle_deg": round(angle, 3), "simulated_s": round(took, 2)})
        checks.check(f"{world} {seed}: no contact", user.contacts() == 0, str(user.contacts()))
    finally:
        for process in reversed(processes):
            process.end()
        user.node.destroy_node()
    return [line | {"contacts": user.contacts()} for line in lines]


def main():
    parser = options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--worlds", nargs="+", choices=worlds.NAMES, default=["flat"])
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="goals-"))
    checks = Checks("goals")
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "goals.jsonl", "w") as file:
        for world in options.worlds:
            for seed in options.seeds:
                for line in score(checks, options, world, seed, out / f"{world}-{seed}"):
                    print(json.dumps(line), file=file, flush=True)
    print(f"written: {out}/goals.jsonl")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
