"""A robot of other habits: raw images with depth in metres, Twist, its own odom -> base_link, an odometry that starts elsewhere.

peer.py --trundle PATH. A goal in `map` and one in `odom` are reached; trundle leaves odom -> base_link to the robot. Exit 0: all checks hold.
"""
import argparse
import collections
import math
import pathlib
import sys
import tempfile

import goals
from geometry_msgs.msg import Twist
from harness import Checks, compose, planar, relative
from nav2_user import NEAR, User, outcome, status
from tf2_msgs.msg import TFMessage

# The robot's habits. The first pose of its odometry is in m and rad.
ROBOT = ["--images", "raw", "--depth", "32FC1", "--cmd-vel", "twist", "--tf", "--odom-start", "3", "2", "1.5"]
TRUNDLE = ("ros2 --color camera/color/image_raw --depth camera/depth/image_raw "
           "--ros-args -p use_sim_time:=true -p enable_stamped_cmd_vel:=false -r imu:=imu")
# A second place near the first one, world frame.
NEXT = (2.8, 1.4, 0.5)


def goal_in_odom(user, place):
    """A pose of the world in the frame of the robot's odometry, by its pose there now."""
    message = user.map_pose(place, "odom")
    x, y, heading = compose(planar(user.last["odom"].pose.pose), relative(user.truth(), place))
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation.z, message.pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)
    return message


def reach(checks, user, name, place, message):
    result = user.send("navigate_to_pose", pose=message).wait()
    user.wait_simulated(0.5)
    distance, angle = user.error_to(place)
    good = status(result) == "SUCCEEDED" and distance <= goals.DISTANCE_M and angle <= goals.ANGLE_DEG
    checks.check(f"{name} is reached", good, f"{outcome(result)}, {100 * distance:.1f} cm, {angle:.2f} deg")


def drive(checks, user):
    user.listen(Twist, "cmd_vel", keep=True)
    user.node.create_subscription(TFMessage, "/tf", lambda m: user.kept.setdefault("tf", []).extend(m.transforms), 1000)
    reach(checks, user, "a goal in map", NEAR, user.map_pose(NEAR))
    reach(checks, user, "a goal in odom, which started at (3, 2) m", NEXT, goal_in_odom(user, NEXT))
    fastest = max((abs(twist.linear.x) for twist in user.kept.get("cmd_vel", [])), default=0.0)
    checks.check("commands are of the type Twist", fastest > 0.05, f"at most {fastest:.2f} m/s")
    stamps = collections.Counter((t.header.stamp.sec, t.header.stamp.nanosec) for t in user.kept["tf"] if t.child_frame_id == "base_link")
    checks.check("the robot alone publishes odom -> base_link", stamps and max(stamps.values()) == 1,
                 f"{len(stamps)} stamps, at most {max(stamps.values(), default=0)} transforms each")
    checks.check("no contact", user.contacts() == 0, str(user.contacts()))


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.set_defaults(trundle_arguments=TRUNDLE)
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="peer-"))
    checks, user = Checks("peer"), User()
    with goals.running(options, out, "flat", 0, *ROBOT):
        if checks.check("trundle is active", user.wait_until_active()):
            drive(checks, user)
    print(f"logs: {out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
