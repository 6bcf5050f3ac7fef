"""A robot that stands, played from this process: pictures of the flat at 640 x 480, odometry and gyro at 50 Hz, /clock by the wall."""
import time

import numpy as np
from harness import Listener
from mujoco_robot import messages, scene, sensors, simulation, worlds
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, CompressedImage, Imu
from tf2_msgs.msg import TFMessage

# Rate of image pairs, Hz, and of odometry and gyro, Hz.
PAIRS_HZ, BASE_HZ = 30, 50
WIDTH_PX, HEIGHT_PX = 640, 480
# Pictures that are played in turn, and the noise of their colours, steps of 255.
PICTURES, NOISE = 6, 1
KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
TOPICS = {"color": (CompressedImage, "camera/color/image_raw/compressed", qos_profile_sensor_data),
          "depth": (CompressedImage, "camera/depth/image_raw/compressedDepth", qos_profile_sensor_data),
          "info": (CameraInfo, "camera/color/camera_info", qos_profile_sensor_data),
          "odom": (Odometry, "odom", 10), "imu": (Imu, "imu", qos_profile_sensor_data), "clock": (Clock, "/clock", qos_profile_sensor_data),
          "tf": (TFMessage, "/tf", 100), "tf_static": (TFMessage, "/tf_static", KEPT)}


def pictures():
    """Colour and depth of one view with noise of its own each, compressed, and the camera_info. Equal images count as a stuck camera."""
    scene.WIDTH_PX, scene.HEIGHT_PX = WIDTH_PX, HEIGHT_PX
    robot, rng, pairs = simulation.Simulation(worlds.build("flat", 0), 0), np.random.default_rng(0), []
    for _ in range(PICTURES):
        color, depth = robot.read_camera()
        noisy = np.clip(color + rng.integers(-NOISE, NOISE, color.shape, endpoint=True), 0, 255).astype(np.uint8)
        pairs.append((messages.compressed_color(noisy, 0, 90), messages.compressed_depth(depth, 0)))
    return pairs, messages.camera_info(0)


class StandingRobot(Listener):
    """Publishes the robot's topics. `spoil(topic, message)` changes what is sent; where it gives None, nothing is."""

    def __init__(self, name):
        super().__init__(name)
        self.pictures, self.info = pictures()
        self.out = {topic: self.node.create_publisher(*description) for topic, description in TOPICS.items()}
        self.spoil = lambda topic, message: message
        self.sent = {"base": {}, "pair": {}}
        self.wheels, self.begin = sensors.WheelOdometry(), time.monotonic()
        self.publish("tf_static", TFMessage(transforms=[messages.camera_mount(0), messages.gyro_mount(0)]))

    def publish(self, topic, message):
        message = self.spoil(topic, message)
        if message is not None:
            self.out[topic].publish(message)

    def now_ms(self):
        return round((time.monotonic() - self.begin) * 1000)

    def play(self, duration, is_over=lambda: False):
        """Send at both rates for `duration` seconds of the wall, or until it is over; answers are taken while waiting."""
        begin, bases, pairs = time.monotonic(), 0, 0
        while (now := time.monotonic() - begin) < duration and not is_over():
            if now >= bases / BASE_HZ:
                bases += 1
                self.send_base(self.now_ms())
            if now >= pairs / PAIRS_HZ:
                pairs += 1
                self.send_pair(self.now_ms())
            due = min(bases / BASE_HZ, pairs / PAIRS_HZ) - (time.monotonic() - begin)
            self.executor.spin_once(timeout_sec=max(0.0, due))

    def send_base(self, now_ms):
        self.publish("clock", Clock(clock=messages.stamp(now_ms)))
        self.publish("imu", messages.imu(0.0, now_ms))
        self.sent["base"][now_ms] = time.monotonic()
        self.publish("odom", messages.odometry(self.wheels, now_ms))

    def send_pair(self, now_ms):
        color, depth = self.pictures[len(self.sent["pair"]) % PICTURES]
        for message in (color, depth, self.info):
            message.header.stamp = messages.stamp(now_ms)
        self.sent["pair"][now_ms] = time.monotonic()
        for topic, message in (("info", self.info), ("color", color), ("depth", depth)):
            self.publish(topic, message)
