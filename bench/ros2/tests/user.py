"""An rclpy user drives trundle in MuJoCo by Nav2's interfaces: actions, cancel, preemption, refusals, maps, parameters, TF, services.

user.py --trundle PATH [--only goal cancel ...]. Every part drives in one run of the flat, in the order of PARTS. Exit 0: all checks hold.
"""
import argparse
import math
import pathlib
import sys
import tempfile

import goals
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, PoseStamped
from harness import Checks, planar, relative, seconds
from map_checks import clear_costmaps, late_joiner, load_map, save_map
from mujoco_robot import worlds
from nav2_msgs.srv import ManageLifecycleNodes
from nav2_user import FAR, NEAR, User, outcome, status
from nav_msgs.msg import Path
from node_checks import TransformWatch, lifecycle_states, parameters, transforms
from unreachable import CODES, ends_soon

# A place inside the wall between living room and kitchen, world frame.
WALL = (4.5, 0.9, 0.0)
# Distance within which FollowPath passes the poses of the path, m.
PASSED_M = 0.3
# Distance of the corner of a detour from the direct way, m.
DETOUR_M = 0.6


def allowance(limit):
    return Duration(sec=limit)


def is_moving(user):
    return user.speed() > 0.05


def goal(checks, user, options):
    """A goal with feedback that counts down, and its score."""
    sent = user.go(NEAR)
    result = sent.wait()
    user.wait_simulated(0.5)
    distance, angle = user.error_to(NEAR)
    checks.check("goal succeeds", status(result) == "SUCCEEDED", outcome(result))
    checks.check("goal within 5 cm and 3 deg of the truth", distance <= goals.DISTANCE_M and angle <= goals.ANGLE_DEG,
                 f"{100 * distance:.1f} cm, {angle:.2f} deg")
    left = [f.distance_remaining for f in sent.feedback]
    checks.check("feedback counts down", len(left) > 3 and min(left) < 0.5 * max(left), f"{len(left)} messages, {left[:1]} to {left[-1:]} m")
    times = [seconds(f.navigation_time) for f in sent.feedback]
    checks.check("navigation_time grows", times == sorted(times) and times[-1:] > [0.0], f"{times[-1:]} s")


def cancel(checks, user, options):
    """Cancel in mid-drive: accepted, CANCELED, and the robot stands."""
    sent = user.go(FAR)
    checks.check("cancel: the robot drives", user.until(lambda: is_moving(user), 60))
    user.wait_simulated(1.0)
    answer = sent.cancel()
    checks.check("cancel is accepted", answer is not None and answer.return_code == 0 and len(answer.goals_canceling) == 1)
    result = sent.wait(60)
    checks.check("cancelled goal ends as CANCELED", status(result) == "CANCELED", outcome(result))
    user.wait_simulated(1.5)
    checks.check("the robot stands after the cancel", not is_moving(user), f"{user.speed():.3f} m/s")
    again = sent.cancel()
    checks.check("a second cancel is refused", again is not None and not again.goals_canceling)


def preempt(checks, user, options):
    """A new goal in mid-drive takes over."""
    first = user.go(FAR)
    user.until(lambda: is_moving(user), 60)
    user.wait_simulated(1.0)
    second = user.go(NEAR)
    ended, result = first.wait(60), second.wait()
    checks.check("the preempted goal ends as ABORTED or CANCELED", status(ended) in ("ABORTED", "CANCELED"), outcome(ended))
    checks.check("the new goal succeeds", status(result) == "SUCCEEDED", outcome(result))


def wrong_frame(checks, user, options):
    """A goal in an unknown frame is rejected, or aborted with TF_ERROR."""
    sent = user.send("navigate_to_pose", pose=user.map_pose(NEAR, "nowhere"))
    result = sent.wait(30)
    good = not sent.accepted or (status(result) == "ABORTED" and result.result.error_code == 9002)
    checks.check("wrong frame is refused with TF_ERROR", good, outcome(result) if sent.accepted else "rejected")


def in_a_wall(checks, user, options):
    """A goal inside a wall that the camera has seen."""
    ends_soon(checks, user, "a goal inside a wall", WALL)


def unreachable(checks, user, options):
    """A goal behind the walls: aborted with the planner's code."""
    sent = user.go(worlds.build("flat", options.seed).unreachable)
    result = sent.wait(120)
    good = status(result) == "ABORTED" and result.result.error_code in CODES
    checks.check("unreachable goal aborts with the planner's code", good, outcome(result))
    checks.check("unreachable goal has a message", result is not None and bool(result.result.error_msg), outcome(result))


def not_finite(checks, user, options):
    """A goal of NaN is rejected or aborted, and the robot stands."""
    pose = user.map_pose(NEAR)
    pose.pose.position.x = math.nan
    sent = user.send("navigate_to_pose", pose=pose)
    result = sent.wait(30)
    checks.check("NaN is refused", not sent.accepted or status(result) == "ABORTED", outcome(result) if sent.accepted else "rejected")
    user.wait_simulated(0.5)
    checks.check("the robot stands after NaN", not is_moving(user))


def compute_and_follow(checks, user, options):
    """A path from the robot to a pose, and driving along it."""
    user.listen(Path, "plan", keep=True)
    user.wait_simulated(0.5)
    sent = user.send("compute_path_to_pose", goal=user.map_pose(FAR), use_start=False)
    result = sent.wait(30)
    path = result.result.path if result else Path()
    wholes = user.kept.setdefault("plan", [])
    user.until(lambda: wholes, 5)
    counts = [len(whole.poses) for whole in wholes]
    checks.check("the topic plan has the whole path", path.poses and max(counts, default=0) > len(path.poses) and
                 math.dist(planar(wholes[-1].poses[-1].pose)[:2], planar(path.poses[-1].pose)[:2]) < 0.01,
                 f"{counts} poses, {len(path.poses)} in the result")
    if not checks.check("compute_path_to_pose gives a path", status(result) == "SUCCEEDED" and len(path.poses) > 2, outcome(result)):
        return
    ends = [math.dist(planar(path.poses[i].pose)[:2], relative(user.start, place)[:2]) for i, place in ((0, user.truth()), (-1, FAR))]
    checks.check("the path leads from the robot to the pose", path.header.frame_id == "map" and max(ends) < 0.15,
                 f"ends {ends[0]:.2f} and {ends[1]:.2f} m off")
    corners, driven = [planar(pose.pose)[:2] for pose in path.poses], []
    sent = user.send("follow_path", path=path)
    user.until(lambda: driven.append(relative(user.start, user.truth())[:2]) or sent.done.done(), 300)
    result = sent.wait()
    distance, _ = user.error_to(FAR)
    checks.check("follow_path drives to the path's end", status(result) == "SUCCEEDED" and distance < 0.25,
                 f"{outcome(result)}, {100 * distance:.1f} cm")
    off = max(min(from_segment(at, a, b) for a, b in zip(corners, corners[1:])) for at in driven)
    checks.check("follow_path keeps to the path", off < PASSED_M + 0.05, f"at most {100 * off:.0f} cm off it")
    detour_path(checks, user)


def detour_path(checks, user):
    """A path that leaves the direct way by more than the robot may leave the path."""
    (x, y, _), (u, v, _) = user.truth(), NEAR
    length = math.hypot(u - x, v - y)
    corner = ((x + u) / 2 - DETOUR_M * (v - y) / length, (y + v) / 2 + DETOUR_M * (u - x) / length, 0.0)
    path = Path(header=user.map_pose(NEAR).header, poses=[user.map_pose(p) for p in ((x, y, 0.0), corner, NEAR)])
    sent, driven = user.send("follow_path", path=path), []
    user.until(lambda: driven.append(math.dist(user.truth()[:2], corner[:2])) or sent.done.done(), 300)
    result = sent.wait()
    checks.check("follow_path takes a detour", status(result) == "SUCCEEDED" and min(driven) < PASSED_M + 0.05,
                 f"{outcome(result)}, {100 * min(driven):.0f} cm from its corner")


def from_segment(at, a, b):
    """Distance of a point from a line segment, m."""
    length = math.dist(a, b)
    part = 0 if length == 0 else sum((at[i] - a[i]) * (b[i] - a[i]) for i in (0, 1)) / length**2
    return math.dist(at, [a[i] + min(max(part, 0), 1) * (b[i] - a[i]) for i in (0, 1)])


def waypoints(checks, user, options):
    """FollowWaypoints and NavigateThroughPoses over two places."""
    places = [user.map_pose(p) for p in (FAR, NEAR)]
    sent = user.send("follow_waypoints", poses=places)
    result = sent.wait(600)
    missed = len(result.result.missed_waypoints) if result else None
    seen = {f.current_waypoint for f in sent.feedback}
    checks.check("follow_waypoints misses none", status(result) == "SUCCEEDED" and missed == 0 and {0, 1} <= seen,
                 f"{outcome(result)}, missed {missed}, feedback {sorted(seen)}")
    message = goals_message(user, (FAR, NEAR))
    result = user.send("navigate_through_poses", poses=message).wait(600)
    distance, _ = user.error_to(NEAR)
    checks.check("navigate_through_poses ends at the last", status(result) == "SUCCEEDED" and distance < 0.1,
                 f"{outcome(result)}, {100 * distance:.1f} cm")


def goals_message(user, places):
    from nav_msgs.msg import Goals
    message = Goals(goals=[user.map_pose(p) for p in places])
    message.header.frame_id = "map"
    return message


def behaviors(checks, user, options):
    """Spin, BackUp and DriveOnHeading against the truth."""
    before = user.truth()
    result = user.send("spin", target_yaw=1.57, time_allowance=allowance(20)).wait()
    user.wait_simulated(0.5)
    turned = math.degrees(relative(before, user.truth())[2])
    checks.check("spin by 90 deg", status(result) == "SUCCEEDED" and abs(turned - 90) < 6, f"{outcome(result)}, {turned:.1f} deg")
    user.send("spin", target_yaw=-1.57, time_allowance=allowance(20)).wait()
    for action, way in (("drive_on_heading", 0.25), ("backup", -0.25)):
        before = user.truth()
        target = Point(x=abs(way) if action == "drive_on_heading" else way)
        result = user.send(action, target=target, speed=math.copysign(0.1, way), time_allowance=allowance(20)).wait()
        user.wait_simulated(0.5)
        moved = relative(before, user.truth())[0]
        checks.check(f"{action} by {way} m", status(result) == "SUCCEEDED" and abs(moved - way) < 0.05, f"{outcome(result)}, {moved:.3f} m")


def docking(checks, user, options):
    """A dock that is not in the data base, and undocking without a dock: Nav2's codes, or success of neither."""
    result = user.send("dock_robot", use_dock_id=True, dock_id="nowhere").wait(60)
    good = result is not None and status(result) == "ABORTED" and result.result.error_code in (901, 902)
    checks.check("dock_robot with an unknown id aborts with 901 or 902", good, outcome(result))
    result = user.send("undock_robot", dock_type="nothing").wait(60)
    good = result is not None and status(result) == "ABORTED" and result.result.error_code in (902, 905, 999)
    checks.check("undock_robot away from a dock aborts with a code", good, outcome(result))


def topics(checks, user, options):
    """goal_pose as RViz sends it."""
    publisher = user.node.create_publisher(PoseStamped, "goal_pose", 1)
    user.until(lambda: publisher.get_subscription_count() > 0, 20)
    publisher.publish(user.map_pose(FAR))
    checks.check("goal_pose makes the robot drive", user.until(lambda: is_moving(user), 60))
    sent = user.go(NEAR)
    checks.check("an action preempts goal_pose", status(sent.wait()) == "SUCCEEDED")


def initial_pose(checks, user, options):
    """set_initial_pose at the true pose is answered and keeps the robot where it is."""
    checks.check("set_initial_pose is answered", user.set_pose(user.truth()) is not None)
    result = user.go(NEAR).wait()
    distance, _ = user.error_to(NEAR)
    checks.check("goals are reached after set_initial_pose", status(result) == "SUCCEEDED" and distance < 0.1, f"{100 * distance:.1f} cm")


def pause(checks, user, options):
    """manage_nodes: PAUSE stops the robot, RESUME lets it drive."""
    name = "lifecycle_manager_navigation/manage_nodes"
    sent = user.go(FAR)
    user.until(lambda: is_moving(user), 60)
    answer = user.call(ManageLifecycleNodes, name, ManageLifecycleNodes.Request(command=ManageLifecycleNodes.Request.PAUSE))
    user.wait_simulated(1.5)
    checks.check("PAUSE stops the robot", answer is not None and answer.success and not is_moving(user), f"{user.speed():.3f} m/s")
    answer = user.call(ManageLifecycleNodes, name, ManageLifecycleNodes.Request(command=ManageLifecycleNodes.Request.RESUME))
    checks.check("RESUME is answered", answer is not None and answer.success)
    if sent.done and not sent.done.done():
        sent.cancel()
    result = user.go(NEAR).wait()
    checks.check("a goal succeeds after RESUME", status(result) == "SUCCEEDED", outcome(result))


PARTS = [goal, late_joiner, save_map, transforms, parameters, lifecycle_states, cancel, preempt, wrong_frame, in_a_wall, unreachable, not_finite,
         compute_and_follow, waypoints, behaviors, topics, clear_costmaps, initial_pose, pause, docking, load_map]


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--only", nargs="+", choices=[p.__name__ for p in PARTS], help="parts to run")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--node", default="/trundle", help="name of trundle's node, for its parameters")
    options = parser.parse_args()
    options.out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="user-"))
    checks, user = Checks("user"), User()
    with goals.running(options, options.out, "flat", options.seed):
        if checks.check("trundle is active", user.wait_until_active()):
            options.watch = TransformWatch(user)
            for part in [p for p in PARTS if not options.only or p.__name__ in options.only]:
                print(f"-- {part.__name__}", flush=True)
                try:
                    part(checks, user, options)
                except Exception as error:
                    checks.check(part.__name__, False, f"{type(error).__name__}: {error}")
            checks.check("no contact", user.contacts() == 0, str(user.contacts()))
    print(f"logs: {options.out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
