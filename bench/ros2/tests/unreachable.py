"""Goals of NavigateToPose that cannot be reached: inside a wall. Each ends soon, with the planner's code and a reason.

unreachable.py --trundle PATH. Exit 0: all checks hold.
"""
import argparse
import pathlib
import sys
import tempfile

import goals
from harness import Checks
from nav2_user import NEAR, User, outcome, status

# Simulated time within which a goal without a path ends, s: two seconds of plans, and the robot's stop.
LIMIT_S = 6.0
# Places in the flat's west wall, world frame.
PLACES = {"inside the wall": (0.02, 1.1, 0.0), "half in the wall": (0.12, 1.4, 0.0)}
# GOAL_OUTSIDE_MAP, GOAL_OCCUPIED, NO_VALID_PATH of ComputePathToPose.
CODES = {204, 206, 208}


def ends_soon(checks, user, name, place):
    begin = user.now()
    result = user.go(place).wait(120)
    took = user.now() - begin
    checks.check(f"{name}: aborted with the planner's code", status(result) == "ABORTED" and result.result.error_code in CODES, outcome(result))
    checks.check(f"{name}: the result has a reason", result is not None and bool(result.result.error_msg))
    checks.within(f"{name}: simulated time until the end", took, LIMIT_S, "s")


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="unreachable-"))
    checks, user = Checks("unreachable"), User()
    with goals.running(options, out, "flat", 0):
        if checks.check("trundle is active", user.wait_until_active()):
            checks.check("a goal before them succeeds", status(user.go(NEAR).wait()) == "SUCCEEDED")
            # The camera looks at the wall, so that the map has it.
            user.send("spin", target_yaw=3.1).wait()
            user.send("spin", target_yaw=3.1).wait()
            for name, place in PLACES.items():
                ends_soon(checks, user, name, place)
            checks.check("a goal after them succeeds", status(user.go((1.4, 1.1, 0.0)).wait()) == "SUCCEEDED")
    print(f"logs: {out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
