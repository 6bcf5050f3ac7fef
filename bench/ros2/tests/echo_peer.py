"""The peer of latency.py: answers each pair of images, and each odometry, with a TwistStamped on cmd_vel that carries its stamp.

A pair is answered on pair_echo too."""
import sys

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CompressedImage


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("echo_peer")
    commands = node.create_publisher(TwistStamped, "cmd_vel", 10)
    pairs = node.create_publisher(TwistStamped, "pair_echo", 10)
    waiting = {"color": set(), "depth": set()}

    def answer(publisher, stamp):
        message = TwistStamped()
        message.header.stamp = stamp
        publisher.publish(message)

    def image(kind, other, message):
        key = (message.header.stamp.sec, message.header.stamp.nanosec)
        if key in waiting[other]:
            waiting[other].discard(key)
            answer(pairs, message.header.stamp)
            answer(commands, message.header.stamp)
        else:
            waiting[kind].add(key)

    node.create_subscription(Odometry, "odom", lambda m: answer(commands, m.header.stamp), 10)
    for kind, other, topic in (("color", "depth", "image_raw/compressed"), ("depth", "color", "image_raw/compressedDepth")):
        node.create_subscription(CompressedImage, f"camera/{kind}/{topic}", lambda m, k=kind, o=other: image(k, o, m), qos_profile_sensor_data)
    print("ready", flush=True)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
