"""Trundle in MuJoCo when things break: either side killed and started again, floods, wrong types, clocks, two networks.

faults.py --trundle PATH [--only restart_trundle ...]. Each part starts its own robot and trundle. Exit 0: all checks hold.
"""
import argparse
import contextlib
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import goals
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from harness import Checks, start_robot, start_trundle
from nav2_user import ACTIONS, User, outcome, status
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, CompressedImage
from std_msgs.msg import String
from user import FAR, NEAR, is_moving

# Longest silence of commands after which the simulated base stands, s: its timeout and the ramp down.
STOP_S = 1.2
# Goals that one participant sends in a second.
FLOOD = 10_000
# Goals by action at once.
ASKED = 200


@contextlib.contextmanager
def drive(checks, options, folder, world="flat"):
    """Robot and trundle, and a user that hears diagnostics; they end with the block."""
    with goals.running(options, folder, world, 0) as processes, contextlib.closing(User()) as user:
        user.listen(DiagnosticArray, "/diagnostics", 100, keep=True)
        checks.check("trundle is active", user.wait_until_active())
        yield processes, user


def named(user, *words):
    """Texts of diagnostics of level WARN or above that hold one of the words."""
    found = []
    for array in user.kept.get("/diagnostics", []):
        for entry in array.status:
            text = f"{entry.name}: {entry.message} " + " ".join(f"{v.key}={v.value}" for v in entry.values)
            if entry.level >= DiagnosticStatus.WARN and any(w in text for w in words):
                found.append(text)
    return found


def kill(process):
    process.child.kill()
    process.child.wait()


def restart_trundle(checks, options, folder):
    """Trundle is killed in mid-drive: the base stops by itself; a new one takes goals."""
    with drive(checks, options, folder) as (processes, user):
        user.go(FAR)
        checks.check("the robot drives", user.until(lambda: is_moving(user), 60))
        kill(processes[1])
        user.wait_simulated(STOP_S)
        checks.check("the base stops when trundle dies", not is_moving(user), f"{user.speed():.3f} m/s")
        processes[1] = start_trundle(options, folder, "trundle-again")
        user.spin(2.0)
        checks.check("a new trundle is active", user.wait_until_active())
        result = user.go(NEAR).wait()
        checks.check("the new trundle reaches a goal", status(result) == "SUCCEEDED", outcome(result))


def restart_robot(checks, options, folder):
    """The robot is killed in mid-drive and comes back with its clock at zero: trundle lives, says what is silent, and does not drive blind."""
    with drive(checks, options, folder) as (processes, user):
        user.go(FAR)
        user.until(lambda: is_moving(user), 60)
        kill(processes[0])
        found = user.until(lambda: named(user, "odom", "clock", "camera"), 20)
        checks.check("diagnostics name the silent topic", found, "; ".join(named(user, "odom", "clock", "camera")[:1]))
        processes[0] = start_robot(folder, "--world", "flat", "--lock-step", str(options.lock_step))
        user.spin(5.0)
        checks.check("trundle lives", processes[1].child.poll() is None)
        checks.check("no contact after the restart", user.contacts() == 0, str(user.contacts()))
        checks.check("trundle is active again, or says why not", user.wait_until_active(60) or named(user, "clock", "time"))


def flood(checks, options, folder):
    """10,000 goals in a second by topic and 200 by action: trundle lives, and the next goal succeeds."""
    with drive(checks, options, folder) as (processes, user):
        publisher = user.node.create_publisher(PoseStamped, "goal_pose", 1)
        user.until(lambda: publisher.get_subscription_count() > 0, 20)
        begin, pose = time.monotonic(), user.map_pose(NEAR)
        for _ in range(FLOOD):
            publisher.publish(pose)
        print(f"     {FLOOD} goals in {time.monotonic() - begin:.2f} s", flush=True)
        # rclpy keeps 10 answers that it has not read unless it is asked for more.
        client = ActionClient(user.node, ACTIONS["navigate_to_pose"], "navigate_to_pose", goal_service_qos_profile=QoSProfile(depth=ASKED))
        user.until(client.server_is_ready, 20)
        asked = [client.send_goal_async(ACTIONS["navigate_to_pose"].Goal(pose=pose)) for _ in range(ASKED)]
        answered = user.until(lambda: all(f.done() for f in asked), 60)
        checks.check("every goal of 200 is answered", answered, f"{sum(f.done() for f in asked)} answers")
        checks.check("trundle lives", processes[1].child.poll() is None)
        # More than 20 goals in a second are refused.
        user.spin(1.5)
        result = user.go(NEAR).wait()
        checks.check("a goal after the flood succeeds", status(result) == "SUCCEEDED", outcome(result))


def flood_of_images(checks, options, folder):
    """A second participant sends 200 kB of noise as colour images as fast as it can while the robot drives: no contact, and a goal succeeds."""
    with drive(checks, options, folder) as (processes, user):
        sent = user.go(FAR)
        user.until(lambda: is_moving(user), 60)
        with stranger() as node:
            publisher = node.create_publisher(CompressedImage, "camera/color/image_raw/compressed", qos_profile_sensor_data)
            user.kept["/diagnostics"] = []
            noise, end, count = CompressedImage(format="jpeg", data=b"\xff\xd8\xff" + os.urandom(200_000)), time.monotonic() + 5, 0
            while time.monotonic() < end:
                noise.header.stamp, count = user.last["/clock"].clock, count + 1
                publisher.publish(noise)
                user.spin(0.001)
        print(f"     {count} images, {count / 25:.0f} MB/s", flush=True)
        checks.check("trundle lives", processes[1].child.poll() is None)
        checks.check("diagnostics name the images", bool(named(user, "color")), "; ".join(named(user, "color")[:1]))
        sent.wait(120)
        result = user.go(NEAR).wait()
        checks.check("a goal after the flood succeeds", status(result) == "SUCCEEDED", outcome(result))
        checks.check("no contact", user.contacts() == 0, str(user.contacts()))


@contextlib.contextmanager
def stranger():
    """A node of another participant."""
    context = rclpy.context.Context()
    rclpy.init(context=context)
    node = rclpy.create_node("stranger", context=context)
    try:
        yield node
    finally:
        node.destroy_node()
        rclpy.shutdown(context=context)


def wrong_messages(checks, options, folder):
    """Another type under a known name, garbage numbers, and an odometry a year ahead, while the robot drives."""
    with drive(checks, options, folder) as (processes, user):
        user.go(FAR)
        user.until(lambda: is_moving(user), 60)
        # One participant may not have two types under a name: the wrong one comes from another.
        with stranger() as node:
            text = node.create_publisher(String, "camera/color/camera_info", 10)
            info = user.node.create_publisher(CameraInfo, "camera/color/camera_info", 10)
            odom = user.node.create_publisher(Odometry, "odom", 10)
            future = Odometry()
            future.header.stamp.sec = user.last["/clock"].clock.sec + 31_536_000
            future.header.frame_id, future.child_frame_id, future.pose.pose.position.x = "odom", "base_link", math.nan
            for _ in range(20):
                text.publish(String(data="not a camera"))
                info.publish(CameraInfo(width=3, height=1))
                odom.publish(future)
                user.spin(0.1)
        checks.check("trundle lives", processes[1].child.poll() is None)
        for words in (("camera_info",), ("odom",)):
            checks.check(f"diagnostics name {words[0]}", bool(named(user, *words)), "; ".join(named(user, *words)[:1]))
        checks.check("no contact", user.contacts() == 0, str(user.contacts()))


def networks(checks, options, folder):
    """A network namespace with loopback only, and one with a second interface: goals work, and no stream stalls at 128 samples."""
    for name, second in (("trundle-lo", False), ("trundle-two", True)):
        made = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
        if made.returncode != 0:
            print(f"skipped: networks: cannot create a network namespace: {made.stderr.strip()}")
            return
        try:
            inside = ["ip", "netns", "exec", name]
            subprocess.run([*inside, "ip", "link", "set", "lo", "up"], check=True)
            if second and not add_interface(inside):
                print("skipped: networks: the kernel makes no dummy, veth or tap interface")
                continue
            command = [*inside, sys.executable, pathlib.Path(__file__).with_name("user.py"), "--trundle", options.trundle,
                     "--trundle-arguments", options.trundle_arguments, "--only", "goal", "transforms", "--out", folder / name]
            done = subprocess.run([str(a) for a in command], capture_output=True, text=True)
            failed = [line for line in done.stdout.splitlines() if line.startswith("FAIL")]
            checks.check(f"goal and 30 s of TF in a namespace with {'two interfaces' if second else 'loopback only'}",
                         done.returncode == 0, "; ".join(failed) or done.stderr[-200:] if done.returncode else "")
        finally:
            subprocess.run(["ip", "netns", "del", name])


def add_interface(inside):
    """A second interface with an address, of the first kind that the kernel knows."""
    kinds = (["ip", "link", "add", "other", "type", "dummy"], ["ip", "link", "add", "other", "type", "veth", "peer", "name", "far"],
             ["ip", "tuntap", "add", "dev", "other", "mode", "tap"])
    if not any(subprocess.run([*inside, *kind], capture_output=True).returncode == 0 for kind in kinds):
        return False
    subprocess.run([*inside, "ip", "addr", "add", "10.77.0.1/24", "dev", "other"], check=True)
    subprocess.run([*inside, "ip", "link", "set", "other", "up", "multicast", "on"], check=True)
    return True


PARTS = [restart_trundle, restart_robot, flood, flood_of_images, wrong_messages, networks]


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--only", nargs="+", choices=[p.__name__ for p in PARTS])
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
    checks = Checks("faults")
    for part in [p for p in PARTS if not options.only or p.__name__ in options.only]:
        print(f"-- {part.__name__}", flush=True)
        try:
            part(checks, options, out / part.__name__)
        except Exception as error:
            checks.check(part.__name__, False, f"{type(error).__name__}: {error}")
    print(f"logs: {out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
