"""Drive the MuJoCo robot by cmd_vel alone and compare its odometry with the truth.

The base follows its wheels within 1.3 %, rates and stamps are as stated, a broken command and silence stop nothing but the
robot, and a touch of a wall counts. Needs the packages of get-ros2.sh, not trundle. Exit 0: all checks hold.
"""
import argparse
import math
import pathlib
import sys
import tempfile

from harness import Checks, Listener, planar, relative, seconds, start_robot
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, CompressedImage, Imu
from std_msgs.msg import UInt32

# Largest difference of base and wheels, share of the way and of the turn.
FOLLOWS = 0.013


class Driver(Listener):
    """Answers each odometry with the command in force, stamped with its time."""

    def __init__(self):
        super().__init__("robot_alone")
        self.command, self.origin, self.turned, self.heading = None, None, 0.0, 0.0
        self.out = self.node.create_publisher(TwistStamped, "cmd_vel", 10)
        self.listen(PoseStamped, "ground_truth", keep=True)
        self.listen(UInt32, "contacts")
        self.listen(Clock, "/clock", qos_profile_sensor_data, keep=True)
        self.listen(Imu, "imu", qos_profile_sensor_data, keep=True)
        self.node.create_subscription(Odometry, "odom", self.answer, 10)
        self.odometry = []

    def answer(self, odometry):
        self.odometry.append(odometry)
        if self.command:
            message = TwistStamped()
            message.header.stamp, message.header.frame_id = odometry.header.stamp, "base_link"
            message.twist.linear.x, message.twist.angular.z = self.command
            self.out.publish(message)

    def now(self):
        return seconds(self.odometry[-1].header.stamp) if self.odometry else 0.0

    def drive(self, v, omega, duration):
        """Command for a simulated duration, then stand still for 0.5 s."""
        for command, length in (((v, omega), duration), ((0.0, 0.0), 0.5)):
            self.command, end = command, self.now() + length
            self.until(lambda: self.now() >= end, 120)

    def contact_count(self):
        return self.last["contacts"].data if "contacts" in self.last else 0

    def snapshot(self):
        """Odometry and truth of the same stamp: poses, and truth's turn without wrapping."""
        by_stamp = {seconds(m.header.stamp): m for m in self.kept["ground_truth"]}
        odometry = next(m for m in reversed(self.odometry) if seconds(m.header.stamp) in by_stamp)
        return planar(odometry.pose.pose), planar(by_stamp[seconds(odometry.header.stamp)].pose)

    def turned_by(self, poses):
        """Sum of the turns between poses that follow each other, rad."""
        return sum(math.remainder(b[2] - a[2], math.tau) for a, b in zip(poses, poses[1:]))


def follow(checks, driver):
    """Straight moves and turns: base against wheels."""
    for what, v, omega, duration in (("forward", 0.3, 0.0, 5.0), ("backward", -0.2, 0.0, 5.0), ("turn left", 0.0, 1.0, 7.0),
                                     ("turn right", 0.0, -1.5, 5.0), ("arc", 0.3, 0.4, 4.0), ("arc back", -0.3, -0.4, 4.0)):
        (odom0, truth0), first_o, first_t = driver.snapshot(), len(driver.odometry), len(driver.kept["ground_truth"])
        driver.drive(v, omega, duration)
        odom1, truth1 = driver.snapshot()
        by_wheels, by_truth = relative(odom0, odom1), relative(truth0, truth1)
        if v:
            ways = [math.hypot(p[0], p[1]) for p in (by_wheels, by_truth)]
            checks.within(f"{what}: way of base over way of wheels - 1", ways[1] / ways[0] - 1, FOLLOWS)
        if omega:
            wheels = driver.turned_by([planar(m.pose.pose) for m in driver.odometry[first_o:]])
            truth = driver.turned_by([planar(m.pose) for m in driver.kept["ground_truth"][first_t:]])
            checks.within(f"{what}: turn of base over turn of wheels - 1", truth / wheels - 1, FOLLOWS)


def stamps(checks, driver):
    """Periods by the stamps of the messages."""
    for what, messages in (("odom", driver.odometry), ("imu", driver.kept["imu"]), ("ground_truth", driver.kept["ground_truth"])):
        times = [seconds(m.header.stamp) for m in messages]
        periods = sorted(b - a for a, b in zip(times, times[1:]))
        checks.check(f"{what} every 20 ms", abs(periods[len(periods) // 2] - 0.02) < 1e-6 and periods[0] > 0, f"{len(times)} messages")
    clock = [seconds(m.clock) for m in driver.kept["/clock"]]
    checks.check("clock never goes back", all(b > a for a, b in zip(clock, clock[1:])), f"{len(clock)} messages")


def silence(checks, driver):
    """The base stops 0.5 s after the last command; a command that is not finite changes nothing."""
    driver.drive(0.2, 0.0, 1.0)
    driver.command, end = (float("nan"), 0.0), driver.now() + 0.3
    driver.until(lambda: driver.now() >= end, 60)
    driver.command, before = (0.2, 0.0), driver.now()
    driver.until(lambda: driver.now() >= before + 1.0, 60)
    driver.command, before = None, driver.now()
    driver.until(lambda: driver.now() >= before + 1.5, 60)
    moving = [seconds(m.header.stamp) for m in driver.odometry if abs(m.twist.twist.linear.x) > 0.01]
    checks.check("the base stops 0.5 to 0.8 s after the last command", 0.45 <= moving[-1] - before <= 0.8, f"{moving[-1] - before:.2f} s")


def touch(checks, driver):
    """No touch so far; then drive against what is ahead."""
    checks.check("no contact on free floor", driver.contact_count() == 0, str(driver.contact_count()))
    driver.command, before = (0.4, 0.0), driver.now()
    driver.until(lambda: driver.contact_count() > 0 or driver.now() > before + 20, 120)
    checks.check("a touch is counted", driver.contact_count() > 0, f"{driver.contact_count()} after {driver.now() - before:.1f} s")


def images(checks, driver):
    """Colour, depth and camera_info share their stamps at 15 Hz."""
    for topic in ("camera/color/image_raw/compressed", "camera/depth/image_raw/compressedDepth"):
        driver.listen(CompressedImage, topic, qos_profile_sensor_data, keep=True)
    driver.listen(CameraInfo, "camera/depth/camera_info", qos_profile_sensor_data, keep=True)
    driver.command = (0.0, 0.5)
    begin = driver.now()
    driver.until(lambda: driver.now() > begin + 6, 180)
    sets = [{seconds(m.header.stamp) for m in driver.kept.get(t, [])} for t in
            ("camera/color/image_raw/compressed", "camera/depth/image_raw/compressedDepth", "camera/depth/camera_info")]
    pairs = sorted(sets[0] & sets[1] & sets[2])
    # A loaded machine loses images of best effort: the period is the median of the gaps.
    gaps = sorted(b - a for a, b in zip(pairs, pairs[1:]))
    period = gaps[len(gaps) // 2] if gaps else 0.0
    checks.check("a pair with camera_info every 1/15 s", abs(period - 1 / 15) < 0.002, f"{period:.4f} s, {len(pairs)} pairs")
    sizes = [sum(len(m.data) for m in driver.kept[t]) / len(driver.kept[t]) / 1000 for t in driver.kept if "compressed" in t]
    print(f"     mean size: {', '.join(f'{s:.0f} kB' for s in sizes)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(tempfile.mkdtemp(prefix="robot-alone-")))
    options = parser.parse_args()
    checks, driver = Checks("robot_alone"), Driver()
    robot = start_robot(options.out, "--images", "none", "--real-time-factor", "0", "--lock-step", "2")
    try:
        driver.command = (0.0, 0.0)
        checks.check("odometry and truth arrive", driver.until(lambda: driver.odometry and "ground_truth" in driver.last, 60))
        for part in (follow, stamps, silence, touch):
            part(checks, driver)
    finally:
        robot.end()
    driver.node.destroy_node()
    driver = Driver()
    robot = start_robot(options.out, "--real-time-factor", "1")
    try:
        images(checks, driver)
    finally:
        robot.end()
    print(robot.log.read_text().splitlines()[-1])
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
