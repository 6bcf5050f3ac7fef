# Records a software device with librealsense, for the test of the RealSense camera.
# Usage: python3 realsense_recording.py SITE_PACKAGES FILE. FILE ends with .db3 for librealsense 2.59, with .bag for 2.55.
# Depth: 64 x 48, value 100 n + 1, first pixel 7, for n = 0 to 4. Colour: 80 x 60, value n + 1, first pixel (9, 8, 7).
# Gyro: samples m = 0 to 19 of (0.1, 0.2, 0.3 + m) rad/s, four an image, at 999 + 8 m ms.
# Stamps of the images: 1000 + 33.25 n ms; the colour image 0.5 ms later.
import array
import sys
import time

sys.path.insert(0, sys.argv[1])
import pyrealsense2 as rs

FRAMES = 5
# Samples of the gyro an image.
SAMPLES = 4


def intrinsics(size, focal, model, coefficients):
    result = rs.intrinsics()
    result.width, result.height = size
    result.ppx, result.ppy = size[0] / 2 - 0.5, size[1] / 2 + 0.25
    result.fx, result.fy = focal, focal + 1
    result.model, result.coeffs = model, coefficients
    return result


def video_stream(kind, uid, size, bytes_per_pixel, form, lens):
    stream = rs.video_stream()
    stream.type, stream.index, stream.uid = kind, 0, uid
    stream.width, stream.height = size
    stream.fps, stream.bpp, stream.fmt, stream.intrinsics = 30, bytes_per_pixel, form, lens
    return stream


def gyro_stream():
    stream = rs.motion_stream()
    stream.type, stream.index, stream.uid, stream.fps = rs.stream.gyro, 0, 3, 200
    stream.fmt = rs.format.motion_xyz32f
    return stream


def image(profile, values, width, bytes_per_pixel, stamp, number):
    frame = rs.software_video_frame()
    frame.pixels = values
    frame.stride, frame.bpp = width * bytes_per_pixel, bytes_per_pixel
    frame.timestamp, frame.domain, frame.frame_number = stamp, rs.timestamp_domain.hardware_clock, number
    frame.profile = profile.as_video_stream_profile()
    return frame


def rate(profile, values, stamp, number):
    frame = rs.software_motion_frame()
    vector = rs.vector()
    vector.x, vector.y, vector.z = values
    frame.data = vector
    frame.timestamp, frame.domain, frame.frame_number = stamp, rs.timestamp_domain.hardware_clock, number
    frame.profile = profile.as_motion_stream_profile()
    return frame


device = rs.software_device()
device.register_info(rs.camera_info.name, "Intel RealSense D435I")
device.register_info(rs.camera_info.serial_number, "012345")
device.register_info(rs.camera_info.firmware_version, "5.16.0.1")
device.register_info(rs.camera_info.usb_type_descriptor, "3.2")
depth_sensor, color_sensor = device.add_sensor("Stereo Module"), device.add_sensor("RGB Camera")
motion_sensor = device.add_sensor("Motion Module")
depth_sensor.add_read_only_option(rs.option.depth_units, 0.00025)
depth_lens = intrinsics((64, 48), 50, rs.distortion.brown_conrady, [0, 0, 0, 0, 0])
color_lens = intrinsics((80, 60), 76, rs.distortion.inverse_brown_conrady, [-0.054, 0.066, -0.0007, 0.0003, -0.021])
depth_profile = depth_sensor.add_video_stream(
    video_stream(rs.stream.depth, 1, (64, 48), 2, rs.format.z16, depth_lens)
)
color_profile = color_sensor.add_video_stream(
    video_stream(rs.stream.color, 2, (80, 60), 3, rs.format.rgb8, color_lens)
)
gyro_profile = motion_sensor.add_motion_stream(gyro_stream())
extrinsics = rs.extrinsics()
extrinsics.rotation = [0, 1, 0, -1, 0, 0, 0, 0, 1]
extrinsics.translation = [0.015, 0.001, 0.002]
depth_profile.register_extrinsics_to(color_profile, extrinsics)
device.create_matcher(rs.matchers.default)

recorder = rs.recorder(sys.argv[2], device)
queue = rs.frame_queue(50)
sensors = recorder.query_sensors()
for sensor in sensors:
    sensor.open(sensor.get_stream_profiles()[0])
    sensor.start(queue)
for n in range(FRAMES):
    stamp = 1000 + 33.25 * n
    for m in range(SAMPLES * n, SAMPLES * (n + 1)):
        motion_sensor.on_motion_frame(rate(gyro_profile, (0.1, 0.2, 0.3 + m), 999 + 8 * m, m + 1))
    depth = memoryview(array.array("H", [7] + [100 * n + 1] * (64 * 48 - 1))).cast("B").cast("H", (48, 64))
    depth_sensor.on_video_frame(image(depth_profile, depth, 64, 2, stamp, n + 1))
    color = memoryview(bytes([9, 8, 7] + [n + 1] * (80 * 60 * 3 - 3))).cast("B", (60, 80, 3))
    color_sensor.on_video_frame(image(color_profile, color, 80, 3, stamp + 0.5, n + 1))
    time.sleep(0.02)
for sensor in sensors:
    sensor.stop()
    sensor.close()
