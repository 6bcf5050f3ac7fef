"""Latency, loss and CPU of trundle's ROS 2 side at 30 image pairs per second of 640 x 480, against rclpy to rclpy in the same run.

latency.py --trundle PATH [--seconds 20]. A standing robot is played from this process. Measured: odometry out to cmd_vel in; image pair
out to its scan in (trundle) or to its echo in (rclpy); image pair out to the first cmd_vel in after that answer; pairs that were not
received, and pairs that a newer one replaced; CPU of the peer. Writes OUT/latency.json.
"""
import argparse
import bisect
import json
import math
import os
import pathlib
import sys
import tempfile
import time

import goals
import numpy as np
from geometry_msgs.msg import TwistStamped
from harness import Checks, Process, start_trundle
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from standing_robot import StandingRobot

# Beginnings of the names of threads that carry messages of ROS 2: of trundle, and of the DDS library.
BRIDGE_THREADS = ("ros2", "RustDDS", "cmd-vel", "dds")
# Largest share of messages that may get no answer (ours; a loaded machine delays some beyond the end).
MAX_LOST_SHARE = 0.2


class Player(StandingRobot):
    """Keeps when each stamp was answered, by the wall clock."""

    def __init__(self, name):
        super().__init__(name)
        self.answered, self.commands = {"base": {}, "pair": {}}, []
        # Pairs so far, and those before the first command: the peer's run begins with it.
        self.pairs, self.pairs_before_run = 0, None
        self.node.create_subscription(TwistStamped, "cmd_vel", self.on_command, 10)
        for kind, topic, qos in ((LaserScan, "scan", qos_profile_sensor_data), (TwistStamped, "pair_echo", 10)):
            self.node.create_subscription(kind, topic, lambda m: self.on_answer("pair", m), qos)

    def key(self, stamp):
        return round(stamp.sec * 1000 + stamp.nanosec / 1e6)

    def on_answer(self, kind, message):
        self.answered[kind].setdefault(self.key(message.header.stamp), time.monotonic())

    def send_pair(self, now_ms):
        self.pairs += 1
        super().send_pair(now_ms)

    def on_command(self, message):
        """A command answers the newest odometry that is not newer than its stamp. One with the stamp of a pair answers that alone."""
        self.commands.append(time.monotonic())
        if self.pairs_before_run is None:
            self.pairs_before_run = self.pairs
        key = self.key(message.header.stamp)
        if key in self.sent["pair"] and key not in self.sent["base"]:
            return
        older = [k for k in self.sent["base"] if k <= self.key(message.header.stamp)]
        if older:
            self.answered["base"].setdefault(max(older), time.monotonic())

    def twists(self):
        """When the first command after a pair's answer came, by the pair's stamp."""
        first = {k: bisect.bisect_left(self.commands, t) for k, t in self.answered["pair"].items()}
        return {k: self.commands[i] for k, i in first.items() if i < len(self.commands)}

    def figures(self, kind, answered):
        """Median and 95 % of the latency, ms, and the share without an answer."""
        sent = self.sent[kind]
        delays = sorted(1000 * (answered[k] - t) for k, t in sent.items() if k in answered)
        if not delays:
            return {"sent": len(sent), "answered": 0, "lost": 1.0}
        return {"sent": len(sent), "answered": len(delays), "lost": round(1 - len(delays) / len(sent), 4),
                "median_ms": round(float(np.median(delays)), 2), "p95_ms": round(float(np.percentile(delays, 95)), 2)}


def cpu_seconds(pid):
    """User and system time of a process so far, s: of the threads that carry ROS 2 messages, of those that convert images, of all."""
    spent = {"bridge": 0.0, "camera": 0.0, "all": 0.0}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        name, fields = (task / "stat").read_text().split("(", 1)[1].rsplit(")", 1)
        used = (int(fields.split()[11]) + int(fields.split()[12])) / os.sysconf("SC_CLK_TCK")
        kind = "bridge" if name.startswith(BRIDGE_THREADS) else "camera" if name.startswith("camera") else None
        for key in filter(None, (kind, "all")):
            spent[key] += used
    return spent


def measure(name, start, options):
    """Figures of one peer."""
    player = Player(f"latency_{name}")
    process = start()
    try:
        player.until(lambda: player.out["odom"].get_subscription_count() > 0, 60)
        # The peer is ready when it answers images.
        player.play(60, lambda: bool(player.answered["pair"]))
        player.sent, player.answered = {"base": {}, "pair": {}}, {"base": {}, "pair": {}}
        before = cpu_seconds(process.child.pid)
        player.play(options.seconds)
        spent = {k: round((v - before[k]) / options.seconds, 3) for k, v in cpu_seconds(process.child.pid).items()}
        player.spin(1.0)
    finally:
        process.end()
        player.node.destroy_node()
    size = sum(len(m.data) for pair in player.pictures for m in pair) // len(player.pictures)
    answered = player.answered
    return {"peer": name, "odom_to_cmd_vel": player.figures("base", answered["base"]), "pair_to_answer": player.figures("pair", answered["pair"]),
            "pair_to_cmd_vel": player.figures("pair", player.twists()), "cpu_s_per_s": spent, "bytes_a_pair": size,
            "pairs_of_run": player.pairs - (player.pairs_before_run or 0)}


def images_of_run(folder):
    """Image pairs that trundle's run received, and those that were replaced by a newer one before they were looked at."""
    run = json.loads((folder / "out/ros2/summary.json").read_text())
    return {"received": run["wall_clock"]["real_time"]["world"]["images"], "replaced": run["images_dropped"]}


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="latency-"))
    echo = [sys.executable, pathlib.Path(__file__).parent / "echo_peer.py"]
    peers = {"rclpy": lambda: Process("rclpy", echo, out), "trundle": lambda: start_trundle(options, out)}
    checks, lines = Checks("latency"), []
    for name, start in peers.items():
        lines.append(measure(name, start, options))
        if name == "trundle":
            lines[-1] |= images_of_run(out)
        answer = lines[-1]["pair_to_answer"]
        lines[-1]["pairs_lost"] = answer["lost"] if name == "rclpy" else max(0.0, 1 - lines[-1]["received"] / lines[-1]["pairs_of_run"])
        print(json.dumps(lines[-1]), flush=True)
        checks.check(f"{name} answers pairs and odometry", all(lines[-1][k]["answered"] for k in ("odom_to_cmd_vel", "pair_to_cmd_vel")))
        checks.within(f"{name}: share of odometry without an answer", lines[-1]["odom_to_cmd_vel"]["lost"], MAX_LOST_SHARE)
        checks.within(f"{name}: share of pairs that were not received", lines[-1]["pairs_lost"], MAX_LOST_SHARE)
    for line in lines:
        for kind, what in (("odom_to_cmd_vel", "odometry to command"), ("pair_to_answer", "image pair to answer"),
                           ("pair_to_cmd_vel", "image pair to twist")):
            print(f"{line['peer']}, {what}, median: {line[kind].get('median_ms', math.nan)} ms; 95 %: {line[kind].get('p95_ms', math.nan)} ms; "
                  f"lost: {100 * line[kind]['lost']:.2f} %")
        print(f"{line['peer']}, odometry without a command: {100 * line['odom_to_cmd_vel']['lost']:.2f} %")
        print(f"{line['peer']}, pairs that were not received: {100 * line['pairs_lost']:.2f} %")
        print(f"{line['peer']}, CPU of the bridge: {line['cpu_s_per_s']['bridge' if line['peer'] == 'trundle' else 'all']} s/s")
    (out / "latency.json").write_text(json.dumps(lines, indent=1))
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
