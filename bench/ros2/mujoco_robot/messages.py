"""Readings of the robot as ROS 2 messages (REP 103, REP 105)."""
import io
import math
import struct

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from PIL import Image as Picture
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu

from . import kobuki, scene

OPTICAL_FRAME, GYRO_FRAME = "camera_color_optical_frame", "gyro_link"
# compressed_depth_image_transport puts a header before the PNG: format and two parameters, unused for 16UC1.
DEPTH_HEADER = struct.pack("<iff", 0, 0.0, 0.0)


def stamp(now_ms):
    return Time(sec=now_ms // 1000, nanosec=now_ms % 1000 * 1_000_000)


def quaternion(yaw):
    return Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))


def pose_stamped(pose, frame, now_ms):
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp(now_ms)
    message.pose.position.x, message.pose.position.y = float(pose[0]), float(pose[1])
    message.pose.orientation = quaternion(pose[2])
    return message


def odometry(wheels, now_ms):
    """Pose of the wheels' odometry in `odom`, twist in `base_link`; variances as the Kobuki's driver states them."""
    message = Odometry()
    message.header.frame_id, message.header.stamp, message.child_frame_id = "odom", stamp(now_ms), "base_link"
    message.pose.pose = pose_stamped((wheels.x, wheels.y, wheels.yaw), "odom", now_ms).pose
    message.twist.twist.linear.x, message.twist.twist.angular.z = wheels.v, wheels.omega
    for covariance in (message.pose.covariance, message.twist.covariance):
        covariance[[0, 7, 35]] = (0.1, 0.1, 0.05)
        covariance[[14, 21, 28]] = 1e10
    return message


def imu(rate, now_ms):
    """Turn rate around z; orientation and acceleration are marked as absent (REP 145: first covariance -1)."""
    message = Imu()
    message.header.frame_id, message.header.stamp = GYRO_FRAME, stamp(now_ms)
    message.angular_velocity.z = rate
    message.angular_velocity_covariance[[0, 4, 8]] = (1e10, 1e10, 0.0037**2)
    message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1.0
    return message


def camera_info(now_ms):
    """A pinhole camera; the principal point is counted from the centre of the first pixel."""
    message = CameraInfo(width=scene.WIDTH_PX, height=scene.HEIGHT_PX, distortion_model="plumb_bob", d=[0.0] * 5)
    message.header.frame_id, message.header.stamp = OPTICAL_FRAME, stamp(now_ms)
    f, cx, cy = scene.FOCAL_PX, (scene.WIDTH_PX - 1) / 2, (scene.HEIGHT_PX - 1) / 2
    message.k = [f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0]
    message.r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    message.p = [f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0]
    return message


def compressed_color(color, now_ms, quality):
    buffer = io.BytesIO()
    Picture.fromarray(color).save(buffer, "JPEG", quality=quality)
    return compressed("rgb8; jpeg compressed bgr8", buffer.getvalue(), now_ms)


def compressed_depth(depth, now_ms):
    buffer = io.BytesIO()
    Picture.fromarray(depth).save(buffer, "PNG", compress_level=1)
    return compressed("16UC1; compressedDepth png", DEPTH_HEADER + buffer.getvalue(), now_ms)


def compressed(layout, data, now_ms):
    message = CompressedImage(format=layout)
    message.header.frame_id, message.header.stamp = OPTICAL_FRAME, stamp(now_ms)
    message.data = data
    return message


def raw(pixels, encoding, now_ms):
    """`rgb8`, `16UC1` (mm) or `32FC1` (m)."""
    pixels = np.ascontiguousarray(pixels)
    message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding=encoding, step=pixels.strides[0])
    message.header.frame_id, message.header.stamp = OPTICAL_FRAME, stamp(now_ms)
    message.data = pixels.tobytes()
    return message


def raw_depth(millimetres, encoding, now_ms):
    """`16UC1`, or `32FC1` with NaN where there is no reading (REP 118)."""
    if encoding == "32FC1":
        millimetres = np.where(millimetres == 0, np.nan, millimetres / 1000).astype(np.float32)
    return raw(millimetres, encoding, now_ms)


def gyro_mount(now_ms):
    """`base_link` to the gyro's frame: the same axes, as in the Kobuki's description."""
    message = TransformStamped(child_frame_id=GYRO_FRAME)
    message.header.frame_id, message.header.stamp = "base_link", stamp(now_ms)
    message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = kobuki.GYRO_XYZ_M
    message.transform.rotation.w = 1.0
    return message


def camera_mount(now_ms):
    """`base_link` to the optical frame (z forward, x right, y down)."""
    message = TransformStamped(child_frame_id=OPTICAL_FRAME)
    message.header.frame_id, message.header.stamp = "base_link", stamp(now_ms)
    move = message.transform.translation
    move.x, move.z = kobuki.CAMERA_X_M, kobuki.CAMERA_Z_M
    # Rotation by -90 deg around z and -90 deg - tilt around x, in axes of the parent: columns are the optical axes.
    s, c = math.sin(kobuki.CAMERA_TILT_RAD), math.cos(kobuki.CAMERA_TILT_RAD)
    message.transform.rotation = from_matrix(np.array([[0.0, -s, c], [-1.0, 0.0, 0.0], [0.0, -c, -s]]))
    return message


def from_matrix(m):
    """Quaternion of a rotation matrix, by the largest of its four components."""
    squares = np.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + np.trace(m)])
    i = int(np.argmax(squares))
    rows = np.array([[squares[0], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
                     [m[1, 0] + m[0, 1], squares[1], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
                     [m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], squares[2], m[1, 0] - m[0, 1]],
                     [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squares[3]]])[i]
    x, y, z, w = (float(v) for v in rows / np.linalg.norm(rows))
    return Quaternion(x=x, y=y, z=z, w=w)


def base_motion(wheels, now_ms):
    """`odom` to `base_link` by the wheels."""
    message = TransformStamped(child_frame_id="base_link")
    message.header.frame_id, message.header.stamp = "odom", stamp(now_ms)
    message.transform.translation.x, message.transform.translation.y = wheels.x, wheels.y
    message.transform.rotation = quaternion(wheels.yaw)
    return message
