"""Score trundle's goals in MuJoCo against the truth: within 5 cm and 3 degrees, no contact.

goals.py --trundle PATH [--worlds flat corridor-a ...] [--seeds 0 1 2 3 4]. Each run starts the robot and `trundle ros2` anew, sends the
world's goals one after the other by NavigateToPose and writes a line of JSON to OUT/goals.jsonl. Exit 0: every goal was reached.
"""
import argparse
import contextlib
import json
import pathlib
import sys
import tempfile

from harness import Checks, start_robot, start_trundle
from mujoco_robot import worlds
from nav2_user import User, outcome, status

# Largest distance, m, and angle, deg, of the robot's truth from a goal (issue of the ROS 2 bridge).
DISTANCE_M, ANGLE_DEG = 0.05, 3.0
# Runs of the results page.
ALL_RUNS = [("flat", seed) for seed in range(5)] + [(world, 0) for world in worlds.NAMES if world != "flat"]
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


def start(options, folder, world, seed, *robot_options):
    """The robot and trundle; a list to end in reverse. `robot_options` are further options of the robot."""
    robot = start_robot(folder, "--world", world, "--seed", str(seed), "--real-time-factor", str(options.real_time_factor),
                        "--lock-step", str(options.lock_step), *robot_options)
    return [robot, start_trundle(options, folder)]


@contextlib.contextmanager
def running(options, folder, world, seed, *robot_options):
    """The robot and trundle of `start`, until the end of the block."""
    processes = start(options, folder, world, seed, *robot_options)
    try:
        yield processes
    finally:
        for process in reversed(processes):
            process.end()


def drive(user, goal):
    """Send one goal; the result, or `None` if the simulated time is up."""
    sent = user.go(goal)
    if not sent.accepted:
        return None
    end = user.now() + GOAL_LIMIT_S
    user.until(lambda: sent.done.done() or user.now() > end, GOAL_LIMIT_S * 10)
    if not sent.done.done():
        sent.cancel()
    return sent.wait(10)


def score(checks, options, world, seed, folder):
    lines = []
    with running(options, folder, world, seed), contextlib.closing(User()) as user:
        if not checks.check(f"{world} {seed}: trundle is active", user.wait_until_active()):
            return lines
        for number, goal in enumerate(worlds.build(world, seed).goals):
            begin, result = user.now(), drive(user, goal)
            took = user.now() - begin
            user.wait_simulated(0.5)
            distance, angle = user.error_to(goal)
            good = status(result) == "SUCCEEDED" and distance <= DISTANCE_M and angle <= ANGLE_DEG
            checks.check(f"{world} {seed} goal {number}", good, f"{outcome(result)}, {100 * distance:.1f} cm, {angle:.2f} deg, {took:.1f} s")
            lines.append({"world": world, "seed": seed, "goal": number, "good": good, "outcome": outcome(result), "distance_m": round(distance, 4),
                          "angle_deg": round(angle, 3), "simulated_s": round(took, 2)})
        checks.check(f"{world} {seed}: no contact", user.contacts() == 0, str(user.contacts()))
    return [line | {"contacts": user.contacts()} for line in lines]


def summary(lines):
    """Figures of the results page."""
    good = [line for line in lines if line["good"] and not line["contacts"]]
    print(f"goals within 5 cm and 3 deg without contact: {len(good)} of {len(lines)}")
    print(f"largest distance: {100 * max((line['distance_m'] for line in lines), default=0):.2f} cm")
    print(f"largest angle: {max((line['angle_deg'] for line in lines), default=0):.2f} deg")
    print(f"contacts: {sum({(line['world'], line['seed']): line['contacts'] for line in lines}.values())}")


def main():
    parser = options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--worlds", nargs="+", choices=worlds.NAMES, default=["flat"])
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    parser.add_argument("--all", action="store_true", help="the flat with seeds 0 to 4, each corridor with seed 0")
    options = parser.parse_args()
    runs = ALL_RUNS if options.all else [(world, seed) for world in options.worlds for seed in options.seeds]
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="goals-"))
    checks, lines = Checks("goals"), []
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "goals.jsonl", "w") as file:
        for world, seed in runs:
            scored = score(checks, options, world, seed, out / f"{world}-{seed}")
            lines += scored
            for line in scored:
                print(json.dumps(line), file=file, flush=True)
    print(f"written: {out}/goals.jsonl")
    summary(lines)
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
