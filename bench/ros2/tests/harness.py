"""What the drives of this folder share: processes, a node that collects messages, poses, a list of checks."""
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

FOLDER = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(FOLDER))
# Traffic stays on this machine, in a domain that no robot uses by default.
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
os.environ.setdefault("ROS_DOMAIN_ID", "71")

import rclpy  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.signals import SignalHandlerOptions  # noqa: E402


class Process:
    """A program with its output in a file; ended by SIGINT, then SIGTERM, then SIGKILL."""

    def __init__(self, name, arguments, folder):
        """The program runs in `folder`."""
        folder.mkdir(parents=True, exist_ok=True)
        self.name, self.log = name, folder / f"{name}.log"
        with open(self.log, "w") as log:
            self.child = subprocess.Popen([str(a) for a in arguments], stdout=log, stderr=subprocess.STDOUT, cwd=folder,
                                          env=os.environ | {"PYTHONPATH": str(FOLDER)})

    def wait_for(self, text, seconds=120):
        """Until the output holds `text`; an error names the program and its last lines."""
        deadline = time.monotonic() + seconds
        while text not in self.log.read_text():
            if self.child.poll() is not None:
                raise RuntimeError(f"{self.name} ended with {self.child.returncode}:\n{self.log.read_text()[-2000:]}")
            if time.monotonic() > deadline:
                raise RuntimeError(f"{self.name} did not print '{text}' within {seconds} s:\n{self.log.read_text()[-2000:]}")
            time.sleep(0.1)

    def end(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self.child.poll() is not None:
                break
            self.child.send_signal(number)
            try:
                self.child.wait(10)
            except subprocess.TimeoutExpired:
                pass
        return self.child.returncode


def start_robot(folder, *options):
    """The MuJoCo robot, ready to drive; `options` are its own."""
    robot = Process("robot", [sys.executable, "-m", "mujoco_robot", *options], folder)
    robot.wait_for("ready")
    return robot


def start_trundle(options, folder, name="trundle"):
    """`trundle ros2`, or what the options say; its results go to `folder`/out."""
    return Process(name, [os.path.abspath(options.trundle), *options.trundle_arguments.split()], folder)


class Checks:
    """Results of one program; `report` prints them and gives the exit code."""

    def __init__(self, name):
        self.name, self.results = name, []

    def check(self, what, good, detail=""):
        self.results.append(bool(good))
        print(f"{'ok  ' if good else 'FAIL'} {what}{': ' if detail else ''}{detail}", flush=True)
        return good

    def within(self, what, value, limit, unit=""):
        return self.check(what, abs(value) <= limit, f"{value:.4g} {unit} (limit {limit:g})".replace("  ", " "))

    def report(self):
        failed = self.results.count(False)
        print(f"{self.name}: {len(self.results)} checks, {failed} failed", flush=True)
        return 1 if failed or not self.results else 0


class Listener:
    """A node that keeps the messages of topics and spins until something holds."""

    def __init__(self, name):
        if not rclpy.ok():
            # Signals end this program by an exception, so that the programs it started are ended too.
            rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
            signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
        self.node = rclpy.create_node(name, enable_rosout=False)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.kept, self.last = {}, {}

    def close(self):
        self.node.destroy_node()

    def listen(self, kind, topic, qos=10, keep=False):
        """Keep the last message of a topic, or all of them."""
        def take(message):
            self.last[topic] = message
            if keep:
                self.kept.setdefault(topic, []).append(message)
        return self.node.create_subscription(kind, topic, take, qos)

    def until(self, condition, seconds):
        """Spin until the condition holds; False when it does not within `seconds` of wall time."""
        deadline = time.monotonic() + seconds
        while not condition():
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            self.executor.spin_once(timeout_sec=min(left, 0.1))
        return True

    def spin(self, seconds):
        self.until(lambda: False, seconds)

    def result(self, future, seconds):
        """The result of a future, `None` if it does not come."""
        return future.result() if self.until(future.done, seconds) else None


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def yaw(orientation):
    """Heading of a quaternion, rad."""
    q = orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def planar(pose):
    """(x, y, yaw) of a geometry_msgs/Pose."""
    return pose.position.x, pose.position.y, yaw(pose.orientation)


def relative(origin, pose):
    """A pose as seen from another, both (x, y, yaw)."""
    dx, dy, c, s = pose[0] - origin[0], pose[1] - origin[1], math.cos(origin[2]), math.sin(origin[2])
    return c * dx + s * dy, -s * dx + c * dy, math.remainder(pose[2] - origin[2], math.tau)


def compose(origin, pose):
    """The pose in the frame in which the origin is given."""
    c, s = math.cos(origin[2]), math.sin(origin[2])
    return origin[0] + c * pose[0] - s * pose[1], origin[1] + s * pose[0] + c * pose[1], math.remainder(origin[2] + pose[2], math.tau)
