"""The simulated robot as a ROS 2 node. Time is simulated: everything is stamped by /clock."""
import math
import time

import rclpy
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu, LaserScan
from std_msgs.msg import UInt32

from . import messages

# Period of odometry, gyro, clock and truth, ms: the Kobuki's 50 Hz.
BASE_PERIOD_MS = 20
# Images per second of simulated time.
IMAGE_RATE_HZ = 15
# Lag of the scan that trundle makes of an image behind the newest image, ms of simulated time: beyond the first the simulation slows
# down, so that a loaded machine drops no images; beyond the second nobody makes scans, and it does not wait.
SLOW_LAG_MS, GONE_LAG_MS = 150, 1000
# A command of these frames is in the robot's base; others are refused.
BASE_FRAMES = ("", "base_link", "base_footprint")


class Bridge:
    """Publishers and the command's subscription. `advance` runs the robot for one base period."""

    def __init__(self, node, simulation, options):
        self.node, self.robot, self.options = node, simulation, options
        self.reported, self.command_stamp_ms, self.images = set(), -1, 0
        self.answered, self.image_ms, self.scan_ms = False, 0, None
        self.clock = node.create_publisher(Clock, "/clock", qos_profile_sensor_data)
        self.odom = node.create_publisher(Odometry, "odom", 10)
        self.imu = node.create_publisher(Imu, "imu", qos_profile_sensor_data)
        self.truth = node.create_publisher(PoseStamped, "ground_truth", 10)
        self.contacts = node.create_publisher(UInt32, "contacts", 10)
        if options.lock_step > 0:
            node.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)
        self.create_camera()
        self.create_transforms()
        if options.cmd_vel == "twist":
            node.create_subscription(Twist, "cmd_vel", lambda m: self.command(m, None), 10)
        else:
            node.create_subscription(TwistStamped, "cmd_vel", lambda m: self.command(m.twist, m.header), 10)

    def create_camera(self):
        color, depth = "camera/color", "camera/depth"
        if not self.robot.eye:
            return
        kinds = {"compressed": ((CompressedImage, "image_raw/compressed"), (CompressedImage, "image_raw/compressedDepth")),
                 "raw": ((Image, "image_raw"), (Image, "image_raw"))}[self.options.images]
        publish = lambda kind, topic: self.node.create_publisher(kind, topic, qos_profile_sensor_data)
        self.color, self.depth = (publish(k, f"{t}/{n}") for t, (k, n) in zip((color, depth), kinds))
        self.infos = [publish(CameraInfo, f"{t}/camera_info") for t in (color, depth)]

    def create_transforms(self):
        """tf_static needs tf2_msgs, which get-ros2.sh builds."""
        self.tf = None
        if not (self.options.tf_static or self.options.tf):
            return
        from tf2_msgs.msg import TFMessage
        if self.options.tf_static:
            kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
            self.tf_static = self.node.create_publisher(TFMessage, "/tf_static", kept)
            self.tf_static.publish(TFMessage(transforms=[messages.camera_mount(0), messages.gyro_mount(0)]))
        if self.options.tf:
            self.tf = self.node.create_publisher(TFMessage, "/tf", 100)
            self.tf_message = TFMessage

    def command(self, twist, header):
        """Take a command; a broken one is reported once a kind and the base keeps its command until the timeout."""
        v, omega = twist.linear.x, twist.angular.z
        if not (math.isfinite(v) and math.isfinite(omega)):
            return self.report("not finite", f"cmd_vel: linear.x {v}, angular.z {omega} are not finite; the command is ignored")
        if header and header.frame_id.lstrip("/") not in BASE_FRAMES:
            return self.report("frame", f"cmd_vel: frame_id '{header.frame_id}' is not one of {BASE_FRAMES}; the command is ignored")
        if header:
            self.command_stamp_ms, self.answered = header.stamp.sec * 1000 + header.stamp.nanosec // 1_000_000, True
        self.robot.set_command(v, omega)

    def on_scan(self, message):
        self.scan_ms = message.header.stamp.sec * 1000 + message.header.stamp.nanosec // 1_000_000

    def lag(self):
        """Time by which the newest scan is behind the newest image, s of simulated time; 0 where it is small, or no scan comes."""
        lag_ms = 0 if self.scan_ms is None else self.image_ms - self.scan_ms
        return lag_ms / 1000 if SLOW_LAG_MS < lag_ms < GONE_LAG_MS else 0.0

    def report(self, kind, text):
        if kind not in self.reported:
            self.reported.add(kind)
            self.node.get_logger().warning(text)

    def advance(self):
        """One base period: physics, images that fall due, then clock, odometry, gyro, truth, contacts."""
        robot = self.robot
        end = robot.now_ms + BASE_PERIOD_MS
        while robot.now_ms < end:
            robot.step()
            if robot.eye and robot.now_ms * IMAGE_RATE_HZ >= self.images * 1000:
                self.images += 1
                self.publish_images(*robot.read_camera())
        elapsed = BASE_PERIOD_MS / 1000
        wheels = robot.read_wheels(elapsed)
        self.clock.publish(Clock(clock=messages.stamp(end)))
        self.imu.publish(messages.imu(robot.read_gyro(elapsed), end))
        self.odom.publish(messages.odometry(wheels, end))
        self.truth.publish(messages.pose_stamped(robot.truth(), "world", end))
        self.contacts.publish(UInt32(data=robot.contact_count))
        if self.tf:
            self.tf.publish(self.tf_message(transforms=[messages.base_motion(wheels, end)]))

    def publish_images(self, color, depth):
        now = self.image_ms = self.robot.now_ms
        for publisher in self.infos:
            publisher.publish(messages.camera_info(now))
        if self.options.images == "raw":
            self.color.publish(messages.raw(color, "rgb8", now))
            self.depth.publish(messages.raw_depth(depth, self.options.depth, now))
        else:
            self.color.publish(messages.compressed_color(color, now, self.options.jpeg_quality))
            self.depth.publish(messages.compressed_depth(depth, now))


def run(node, bridge, options):
    """Until the end of the simulated duration: advance, take commands, keep the pace."""
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    begin, last = time.monotonic(), round(options.duration * 1000)
    while rclpy.ok() and bridge.robot.now_ms < last:
        bridge.advance()
        take_commands(executor, bridge, options)
        wait_for_scan(executor, bridge, options)
        if options.real_time_factor > 0:
            ahead = bridge.robot.now_ms / 1000 / options.real_time_factor - (time.monotonic() - begin)
            if ahead > 0:
                wait(executor, ahead)
            else:
                # A slow machine delays simulated time; it does not catch up in a burst.
                begin -= ahead
    return time.monotonic() - begin


def take_commands(executor, bridge, options):
    """Commands that wait; in lock step wait for the command that answers the last odometry.

    When none comes, time runs on without waiting until the next command.
    """
    executor.spin_once(timeout_sec=0)
    deadline = time.monotonic() + options.lock_step
    while bridge.answered and bridge.command_stamp_ms < bridge.robot.now_ms:
        left = deadline - time.monotonic()
        if left <= 0:
            bridge.answered = False
        else:
            executor.spin_once(timeout_sec=left)


def wait_for_scan(executor, bridge, options):
    """In lock step: a wait in proportion to the lag of the scans. Time does not stand still, as scans come after later odometry."""
    deadline = time.monotonic() + min(options.lock_step, bridge.lag() / 2)
    while bridge.lag() > 0 and (left := deadline - time.monotonic()) > 0:
        executor.spin_once(timeout_sec=left)


def wait(executor, seconds):
    deadline = time.monotonic() + seconds
    while (left := deadline - time.monotonic()) > 0:
        executor.spin_once(timeout_sec=left)
