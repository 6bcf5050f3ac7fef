"""The simulated robot: time in whole milliseconds, wheels, truth, contacts and images. Knows nothing of ROS."""
import math

import mujoco
import numpy as np

from . import kobuki, scene, sensors

# The base stops when no command came for this long, ms of simulated time (Kobuki's driver: 0.6 s; asked for: 0.5 s).
COMMAND_TIMEOUT_MS = 500
STEP_MS = round(scene.STEP_S * 1000)


class Simulation:
    """One world with one robot. `step` advances 2 ms; the reading functions return the state at `now_ms`."""

    def __init__(self, world, seed=0, noisy=True, images=True):
        self.world, self.now_ms = world, 0
        self.model = scene.model(world, seed)
        self.data = mujoco.MjData(self.model)
        self.odometry, self.gyro = sensors.WheelOdometry(), sensors.Gyro(seed, noisy)
        self.depth_noise = sensors.DepthNoise(seed, noisy)
        self.command, self.command_ms = (0.0, 0.0), -COMMAND_TIMEOUT_MS
        self.wheel_speed = np.zeros(2)
        self.contact_count, self.touching = 0, set()
        self.named = {name: self.model.geom(name).id for name in ("body", "mast")}
        self.eye = Eye(self.model) if images else None
        self.settle()

    def settle(self):
        """Let the robot sink onto its wheels, then start time and counters from zero."""
        for _ in range(250):
            mujoco.mj_step(self.model, self.data)
        self.start_angles = self.data.qpos[7:9].copy()
        self.yaw_before, self.turned = self.truth()[2], 0.0
        self.odometry.update(0.0, 0.0, 0.0)

    def set_command(self, v, omega):
        """Forward speed, m/s, and turn rate, rad/s; both finite."""
        self.command, self.command_ms = (v, omega), self.now_ms

    def step(self):
        """Advance by one physics step."""
        v, omega = self.command if self.now_ms - self.command_ms < COMMAND_TIMEOUT_MS else (0.0, 0.0)
        half = kobuki.WHEELBASE_M / 2
        wanted = np.array([v - omega * half, v + omega * half])
        fastest = np.abs(wanted).max()
        if fastest > kobuki.WHEEL_SPEED_M_S:
            wanted *= kobuki.WHEEL_SPEED_M_S / fastest
        change = kobuki.WHEEL_ACCELERATION_M_S2 * scene.STEP_S
        self.wheel_speed += np.clip(wanted - self.wheel_speed, -change, change)
        self.data.ctrl[:] = self.wheel_speed / kobuki.WHEEL_RADIUS_M
        mujoco.mj_step(self.model, self.data)
        self.now_ms += STEP_MS
        self.count_contacts()

    def count_contacts(self):
        """Each new touch of body or mast with a solid counts once."""
        now = set()
        for contact in self.data.contact[: self.data.ncon]:
            for part, number in self.named.items():
                if number in (contact.geom1, contact.geom2):
                    now.add((part, contact.geom1 + contact.geom2 - number))
        self.contact_count += len(now - self.touching)
        self.touching = now

    def truth(self):
        """Pose of the base in the world: x, y, m, and yaw, rad."""
        w, x, y, z = self.data.qpos[3:7]
        return self.data.qpos[0], self.data.qpos[1], math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def read_wheels(self, elapsed):
        """Update the odometry; returns it."""
        left, right = self.data.qpos[7:9] - self.start_angles
        self.odometry.update(left, right, elapsed)
        return self.odometry

    def read_gyro(self, elapsed):
        """Mean turn rate since the last reading, rad/s, with noise."""
        yaw = self.truth()[2]
        turned = math.remainder(yaw - self.yaw_before, 2 * math.pi)
        self.yaw_before = yaw
        return self.gyro.read(turned / elapsed, elapsed)

    def read_camera(self):
        """Colour (uint8, H x W x 3) and depth (uint16 mm, H x W)."""
        color, depth = self.eye.render(self.data)
        return color, self.depth_noise.read(depth)


class Eye:
    """The camera: one rendering gives colour and depth."""

    def __init__(self, model):
        self.model = model
        self.context = mujoco.GLContext(scene.WIDTH_PX, scene.HEIGHT_PX)
        self.context.make_current()
        self.drawing = mujoco.MjvScene(model, maxgeom=model.ngeom + 50)
        self.target = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self.target)
        self.target.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self.option, self.perturb = mujoco.MjvOption(), mujoco.MjvPerturb()
        self.option.geomgroup[:] = [1, 0, 0, 0, 0, 0]
        self.camera = mujoco.MjvCamera()
        self.camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self.camera.fixedcamid = model.camera("eye").id
        self.view = mujoco.MjrRect(0, 0, scene.WIDTH_PX, scene.HEIGHT_PX)
        self.color = np.empty((scene.HEIGHT_PX, scene.WIDTH_PX, 3), np.uint8)
        self.buffer = np.empty((scene.HEIGHT_PX, scene.WIDTH_PX), np.float32)
        self.near = model.vis.map.znear * model.stat.extent
        self.far = model.vis.map.zfar * model.stat.extent

    def render(self, data):
        mujoco.mjv_updateScene(self.model, data, self.option, self.perturb, self.camera, mujoco.mjtCatBit.mjCAT_ALL.value, self.drawing)
        mujoco.mjr_render(self.view, self.drawing, self.target)
        mujoco.mjr_readPixels(self.color, self.buffer, self.view, self.target)
        # The buffer is 1 at the near plane and 0 at the far plane, linear in the inverse of the depth.
        depth = 1.0 / (1.0 / self.far + self.buffer * (1.0 / self.near - 1.0 / self.far))
        return np.flipud(self.color), np.flipud(depth)
