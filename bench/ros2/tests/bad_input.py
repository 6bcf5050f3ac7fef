"""What a ROS 2 robot or user may send wrong, to trundle with a standing robot: named with topic and cause, and no command moves the robot.

bad_input.py --trundle PATH [--only depth_size ...]. Exit 0: all checks hold.
"""
import argparse
import copy
import math
import pathlib
import sys
import tempfile

import goals
import numpy as np
from action_msgs.srv import CancelGoal
from diagnostic_msgs.msg import DiagnosticArray
from faults import named
from geometry_msgs.msg import TwistStamped
from harness import Checks, Process, start_trundle
from mujoco_robot import kobuki, messages
from nav2_msgs.action import NavigateToPose
from sensor_msgs.msg import CompressedImage
from standing_robot import HEIGHT_PX, WIDTH_PX, StandingRobot
from tf2_msgs.msg import TFMessage
from unique_identifier_msgs.msg import UUID

# Time for which a fault is played, s: diagnostics come once per second.
FAULT_S = 2.5
# A year, s.
YEAR_S = 31_536_000


def later(message, seconds):
    changed = copy.deepcopy(message)
    changed.header.stamp.sec += seconds
    return changed


def smaller(message):
    """A picture of half the size, without change of camera_info."""
    return messages.compressed_color(np.zeros((HEIGHT_PX // 2, WIDTH_PX // 2, 3), np.uint8), 0, 90).data


def with_data(data, layout=None):
    def change(message):
        changed = CompressedImage(header=message.header, format=layout or message.format)
        changed.data = data(message) if callable(data) else data
        return changed
    return change


def with_field(*path_and_value):
    *path, value = path_and_value

    def change(message):
        changed = copy.deepcopy(message)
        part = changed
        for name in path[:-1]:
            part = getattr(part, name)
        setattr(part, path[-1], value)
        return changed
    return change


# Name of the fault, what is spoilt and how, and words of which a diagnostic of the topic holds one.
FAULTS = [
    ("color_size", "color", with_data(smaller), "color", ("320 x 240",)),
    ("color_garbage", "color", with_data(b"not a picture"), "color", ("JPEG", "jpeg", "decode", "image")),
    ("color_encoding", "color", with_data(b"GIF89a" + bytes(60), "gif"), "color", ("JPEG", "jpeg", "gif", "format")),
    ("depth_cut", "depth", with_data(lambda m: bytes(m.data)[:2000]), "depth", ("PNG", "png", "end", "cut", "decode")),
    ("info_nan", "info", with_field("k", [math.nan] * 9), "camera", ("fx", "focal", "finite", "NaN", "px")),
    ("images_old", "color", lambda m: later(m, -YEAR_S), "color", ("behind",)),
    ("odom_ahead", "odom", lambda m: later(m, YEAR_S), "odom", ("ahead",)),
    ("odom_nan", "odom", with_field("pose", "pose", "position", "x", math.nan), "odom", ("NaN", "finite")),
    ("odom_jump", "odom", with_field("pose", "pose", "position", "x", 100.0), "odom", ("jump",)),
    ("odom_rotation", "odom", with_field("pose", "pose", "orientation", "w", 0.0), "odom", ("orientation", "quaternion", "rotation")),
    ("imu_nan", "imu", with_field("angular_velocity", "z", math.nan), "imu", ("NaN", "finite")),
    ("imu_frame", "imu", with_field("header", "frame_id", "nowhere"), "imu", ("nowhere",)),
]


def transform(x, stamp_s):
    message = messages.gyro_mount(stamp_s * 1000)
    message.transform.translation.x = x
    return TFMessage(transforms=[message])


class Case:
    """Trundle with a standing robot that it takes up."""

    def __init__(self, options, folder):
        self.robot = StandingRobot("standing_robot")
        self.robot.listen(DiagnosticArray, "/diagnostics", 100, keep=True)
        self.robot.listen(TwistStamped, "cmd_vel", 10, keep=True)
        self.trundle = start_trundle(options, folder)

    def is_active(self):
        return "cmd_vel" in self.robot.last

    def end(self):
        self.trundle.end()
        self.robot.node.destroy_node()

    def reports(self, topic, words):
        """Diagnostics of the topic that hold one of the words."""
        return [text for text in named(self.robot, topic) if any(word in text for word in words)]


def play_faults(checks, case, wanted):
    for name, topic, change, place, words in FAULTS:
        if wanted and name not in wanted:
            continue
        case.robot.kept["/diagnostics"] = []
        case.robot.spoil = lambda t, m: change(m) if t == topic else m
        case.robot.play(FAULT_S, lambda: bool(case.reports(place, words)))
        found = case.reports(place, words) or named(case.robot, place)
        checks.check(f"{name} is named", bool(case.reports(place, words)), "; ".join(found[:1]))
        case.robot.spoil = lambda t, m: m
        case.robot.play(1.0)


def play_transforms(checks, case):
    """The gyro's transform: one of the next year, one of NaN, one that jumps."""
    def send(x, stamp_s, *words):
        """Diagnostics of the gyro's transform that hold one of the words; all of them without words."""
        case.robot.kept["/diagnostics"] = []
        case.robot.publish("tf_static", transform(x, stamp_s))
        case.robot.publish("tf", transform(x, stamp_s))
        case.robot.play(FAULT_S)
        found = case.reports("/tf", (f"transform base_link -> {messages.GYRO_FRAME}",))
        return [text for text in found if not words or any(word in text for word in words)]

    found = send(kobuki.GYRO_XYZ_M[0], YEAR_S)
    checks.check("a static transform of the next year is harmless", not found, "; ".join(found[:1]))
    found = send(math.nan, 0, "NaN", "finite")
    checks.check("a transform of NaN is named", bool(found), "; ".join(found[:1]))
    found = send(50.0, 0, "off its first value")
    checks.check("a static transform that jumps is named", bool(found), "; ".join(found[:1]))


def garbage_ids(checks, case):
    """Cancel and result of goals that do not exist: answered as unknown, and named with the id."""
    robot, id = case.robot, UUID(uuid=np.full(16, 7, np.uint8))
    for kind, service, request, what in (
            (CancelGoal, "cancel_goal", CancelGoal.Request(goal_info=messages_goal(id)), "a request to cancel is refused"),
            (NavigateToPose.Impl.GetResultService, "get_result", NavigateToPose.Impl.GetResultService.Request(goal_id=id),
             "a request for a result is refused")):
        client = robot.node.create_client(kind, f"navigate_to_pose/_action/{service}")
        robot.play(20, client.service_is_ready)
        robot.kept["/diagnostics"] = []
        future = client.call_async(request)
        robot.play(20, future.done)
        answer = future.result() if future.done() else None
        good = answer is not None and (answer.return_code != 0 if service == "cancel_goal" else answer.status == 0)
        checks.check(f"{service} of an unknown id is answered as unknown", good, str(answer)[:80])
        named_it = lambda: [text for text in case.reports("navigate_to_pose", (what,)) if "07" * 16 in text]
        robot.play(FAULT_S, lambda: bool(named_it()))
        checks.check(f"{service} of an unknown id is named", bool(named_it()), "; ".join(named_it()[:1]))


def messages_goal(id):
    from action_msgs.msg import GoalInfo
    return GoalInfo(goal_id=id)


def without_camera_info(checks, options, folder):
    """Trundle names the missing camera_info and ends."""
    robot = StandingRobot("standing_robot")
    robot.spoil = lambda topic, message: None if topic == "info" else message
    first, *rest = options.trundle_arguments.split()
    trundle = Process("trundle", [pathlib.Path(options.trundle).resolve(), first, "--wait", "5", *rest], folder)
    robot.play(40, lambda: trundle.child.poll() is not None)
    said = trundle.log.read_text()
    checks.check("images without camera_info are named", "camera_info" in said and trundle.end() not in (0, None), said.strip()[-200:])
    robot.node.destroy_node()


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--only", nargs="+", choices=[f[0] for f in FAULTS], help="these faults alone")
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="bad-input-"))
    checks = Checks("bad_input")
    if not options.only:
        without_camera_info(checks, options, out / "without-camera-info")
    case = Case(options, out / "faults")
    try:
        case.robot.play(90, case.is_active)
        checks.check("trundle commands the robot", case.is_active())
        play_faults(checks, case, options.only)
        play_transforms(checks, case)
        garbage_ids(checks, case)
        checks.check("trundle lives", case.trundle.child.poll() is None)
        fastest = max(max(abs(m.twist.linear.x), abs(m.twist.angular.z)) for m in case.robot.kept["cmd_vel"])
        checks.check("no command moves the robot", fastest == 0.0, f"{fastest:.3f}")
    finally:
        case.end()
    print(f"logs: {out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
