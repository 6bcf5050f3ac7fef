"""Latency, loss and CPU of trundle's ROS 2 side at 30 image pairs a second of 640 x 480, against rclpy to rclpy in the same run.

latency.py [--trundle PATH] [--seconds 20]. A standing robot is played from this process: one picture of the flat at 640 x 480, odometry
and gyro at 50 Hz, /clock by the wall. Measured: odometry out to cmd_vel in; image pair out to its scan in (trundle) or to its echo in
(rclpy); pairs without an answer; CPU of the peer. Prints a table and writes OUT/latency.json. Without --trundle only rclpy is measured.
"""
import argparse
import json
import os
import pathlib
import sys
import tempfile
import time

os.environ.setdefault("MUJOCO_GL", "egl")
os.environ.setdefault("LP_NUM_THREADS", "1")

import numpy as np
from harness import Checks, Listener, Process
from geometry_msgs.msg import TwistStamped
from mujoco_robot import messages, scene, sensors, simulation, worlds
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, CompressedImage, Imu, LaserScan
from tf2_msgs.msg import TFMessage

# Rate of image pairs, Hz, and of odometry and gyro, Hz.
PAIRS_HZ, BASE_HZ = 30, 50
WIDTH_PX, HEIGHT_PX = 640, 480


def pictures():
    """Compressed bytes of one colour and one depth picture, and the camera_info."""
    scene.WIDTH_PX, scene.HEIGHT_PX = WIDTH_PX, HEIGHT_PX
    color, depth = simulation.Simulation(worlds.build("flat", 0), 0).read_camera()
    return messages.compressed_color(color, 0, 90), messages.compressed_depth(depth, 0), messages.camera_info(0)


class Player(Listener):
    """Plays the robot and keeps when each stamp was sent and answered, by the wall clock."""

    def __init__(self, name):
        super().__init__(name)
        publish = lambda kind, topic, qos=qos_profile_sensor_data: self.node.create_publisher(kind, topic, qos)
        self.color, self.depth, self.info = pictures()
        self.out = {"color": publish(CompressedImage, "camera/color/image_raw/compressed"),
                    "depth": publish(CompressedImage, "camera/depth/image_raw/compressedDepth"),
                    "info": publish(CameraInfo, "camera/color/camera_info"), "depth_info": publish(CameraInfo, "camera/depth/camera_info"),
                    "odom": publish(Odometry, "odom", 10), "imu": publish(Imu, "imu"), "clock": publish(Clock, "/clock")}
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
        self.out["tf_static"] = publish(TFMessage, "/tf_static", kept)
        self.out["tf_static"].publish(TFMessage(transforms=[messages.camera_mount(0)]))
        self.sent, self.answered = {"base": {}, "pair": {}}, {"base": {}, "pair": {}}
        self.node.create_subscription(TwistStamped, "cmd_vel", self.on_command, 10)
        for kind, topic, qos in ((LaserScan, "scan", qos_profile_sensor_data), (TwistStamped, "pair_echo", 10)):
            self.node.create_subscription(kind, topic, lambda m: self.on_answer("pair", m), qos)

    def key(self, stamp):
        return round(stamp.sec * 1000 + stamp.nanosec / 1e6)

    def on_answer(self, kind, message):
        self.answered[kind].setdefault(self.key(message.header.stamp), time.monotonic())

    def on_command(self, message):
        """A command answers the newest odometry that is not newer than its stamp."""
        older = [k for k in self.sent["base"] if k <= self.key(message.header.stamp)]
        if older:
            self.answered["base"].setdefault(max(older), time.monotonic())

    def play(self, duration):
        """Send at both rates for `duration` seconds of the wall; answers are taken while waiting."""
        wheels, begin = sensors.WheelOdometry(), time.monotonic()
        bases = pairs = 0
        while (now := time.monotonic() - begin) < duration:
            now_ms = round(now * 1000)
            if now >= bases / BASE_HZ:
                bases += 1
                self.send_base(wheels, now_ms)
            if now >= pairs / PAIRS_HZ:
                pairs += 1
                self.send_pair(now_ms)
            due = min(bases / BASE_HZ, pairs / PAIRS_HZ) - (time.monotonic() - begin)
            self.executor.spin_once(timeout_sec=max(0.0, due))
        self.spin(1.0)

    def send_base(self, wheels, now_ms):
        self.out["clock"].publish(Clock(clock=messages.stamp(now_ms)))
        self.out["imu"].publish(messages.imu(0.0, now_ms))
        self.sent["base"][now_ms] = time.monotonic()
        self.out["odom"].publish(messages.odometry(wheels, now_ms))

    def send_pair(self, now_ms):
        for message in (self.color, self.depth, self.info):
            message.header.stamp = messages.stamp(now_ms)
        self.sent["pair"][now_ms] = time.monotonic()
        self.out["info"].publish(self.info)
        self.out["depth_info"].publish(self.info)
        self.out["color"].publish(self.color)
        self.out["depth"].publish(self.depth)

    def figures(self, kind, after_s):
        """Median and 95 % of the latency, ms, and the share without an answer, of what was sent after the warm-up."""
        first = min(self.sent[kind].values()) + after_s
        sent = {k: t for k, t in self.sent[kind].items() if t >= first}
        delays = sorted(1000 * (self.answered[kind][k] - t) for k, t in sent.items() if k in self.answered[kind])
        if not delays:
            return {"sent": len(sent), "answered": 0, "lost": 1.0}
        return {"sent": len(sent), "answered": len(delays), "lost": round(1 - len(delays) / len(sent), 4),
                "median_ms": round(float(np.median(delays)), 2), "p95_ms": round(float(np.percentile(delays, 95)), 2)}


def cpu_seconds(pid):
    """User and system time of a process, s."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(name, arguments, options, folder):
    """Figures of one peer."""
    player = Player(f"latency_{name}")
    process = Process(name, arguments, folder)
    try:
        player.until(lambda: player.out["odom"].get_subscription_count() > 0, 60)
        player.spin(1.0)
        before = cpu_seconds(process.child.pid)
        player.play(options.seconds)
        spent = cpu_seconds(process.child.pid) - before
    finally:
        process.end()
        player.node.destroy_node()
    warm = min(3.0, options.seconds / 4)
    return {"peer": name, "odom_to_cmd_vel": player.figures("base", warm), "pair_to_answer": player.figures("pair", warm),
            "cpu_s_per_s": round(spent / options.seconds, 3), "bytes_a_pair": len(player.color.data) + len(player.depth.data)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trundle", help="path of the binary")
    parser.add_argument("--trundle-arguments", default="ros2 --ros-args -p use_sim_time:=true -r imu:=imu")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(tempfile.mkdtemp(prefix="latency-")))
    options = parser.parse_args()
    peers = [("rclpy", [sys.executable, pathlib.Path(__file__).parent / "echo_peer.py"])]
    if options.trundle:
        peers.append(("trundle", [os.path.abspath(options.trundle), *options.trundle_arguments.split()]))
    checks, lines = Checks("latency"), []
    for name, arguments in peers:
        lines.append(measure(name, arguments, options, options.out))
        print(json.dumps(lines[-1]), flush=True)
        checks.check(f"{name} answers pairs and odometry", all(lines[-1][k]["answered"] for k in ("odom_to_cmd_vel", "pair_to_answer")))
    (options.out / "latency.json").write_text(json.dumps(lines, indent=1))
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
