"""What the robot measures: encoders and odometry, gyro, depth with noise. Each sensor has its own seeded generator."""
import math

import numpy as np

from . import kobuki

# Metres of floor a tick of an encoder.
METRES_PER_TICK = 2 * math.pi * kobuki.WHEEL_RADIUS_M / kobuki.TICKS_PER_TURN


class WheelOdometry:
    """Pose from whole encoder ticks, as the Kobuki's driver computes it: arc by arc."""

    def __init__(self):
        self.x = self.y = self.yaw = 0.0
        self.v = self.omega = 0.0
        self.ticks = None

    def begin(self, x, y, yaw):
        """Start at a pose; without a call it is (0, 0, 0)."""
        self.x, self.y, self.yaw = x, y, yaw

    def update(self, left_rad, right_rad, elapsed):
        """Angles of the wheels now, rad, and the time since the last update, s."""
        ticks = [math.floor(a / (2 * math.pi) * kobuki.TICKS_PER_TURN) for a in (left_rad, right_rad)]
        before, self.ticks = self.ticks or ticks, ticks
        left, right = ((now - then) * METRES_PER_TICK for now, then in zip(ticks, before))
        forward, turn = (left + right) / 2, (right - left) / kobuki.WHEELBASE_M
        self.x += forward * math.cos(self.yaw + turn / 2)
        self.y += forward * math.sin(self.yaw + turn / 2)
        self.yaw += turn
        self.v, self.omega = (forward / elapsed, turn / elapsed) if elapsed > 0 else (0.0, 0.0)


class Gyro:
    """Turn rate with bias, walk of the bias and white noise (L3G4200D's data sheet: 0.03 deg/s/sqrt(Hz))."""

    NOISE_RAD_S, BIAS_RAD_S, WALK_RAD_S_SQRT_S = 0.0037, 0.003, 0.0002

    def __init__(self, seed, noisy=True):
        self.rng = np.random.default_rng(4000 + seed)
        self.scale = float(noisy)
        self.bias = self.scale * self.BIAS_RAD_S * self.rng.normal()

    def read(self, rate, elapsed):
        self.bias += self.scale * self.WALK_RAD_S_SQRT_S * math.sqrt(elapsed) * self.rng.normal()
        return rate + self.bias + self.scale * self.NOISE_RAD_S * self.rng.normal()


class DepthNoise:
    """Metres to whole millimetres: noise that grows with the square of the range, no reading outside the range.

    One sigma is 1.6 mm at 1 m and 5 mm at 3 m (ours, of the size of a time-of-flight camera's); range as a Kinect V2's, 0.5 to 8 m.
    """

    BASE_M, SQUARE_1_M, NEAREST_M, FARTHEST_M = 0.0012, 0.0004, 0.5, 8.0

    def __init__(self, seed, noisy=True):
        self.rng = np.random.default_rng(5000 + seed)
        self.scale = np.float32(noisy)

    def read(self, depth):
        """Depth along the optical axis, m, float32; returns uint16 mm with 0 for no reading."""
        spread = self.scale * (self.BASE_M + self.SQUARE_1_M * depth * depth)
        noisy = depth + spread * self.rng.standard_normal(depth.shape, np.float32)
        seen = (depth >= self.NEAREST_M) & (depth <= self.FARTHEST_M)
        return np.where(seen, np.rint(noisy * 1000), 0).astype(np.uint16)
