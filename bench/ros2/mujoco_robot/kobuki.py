"""The robot: a Kobuki with a depth camera, as MuJoCo's XML.

Wheels are spheres: one point of contact whatever the heading. Casters have no friction. The base's origin is on the floor
between the wheels.
"""
import math

# Distance between the driven wheels, m (Kobuki's data sheet: 230 mm).
WHEELBASE_M = 0.23
# Radius of the driven wheels, m.
WHEEL_RADIUS_M = 0.035
# Radius of the round body, m: 354 mm across.
BODY_RADIUS_M = 0.177
# Encoder ticks a turn of a wheel: 52 x 49.5833.
TICKS_PER_TURN = 2578.33
# Highest speed of a wheel's circumference, m/s (Kobuki's data sheet: 70 cm/s).
WHEEL_SPEED_M_S = 0.70
# Highest acceleration of a wheel's circumference, m/s^2, of the motor controller (ours: below slipping).
WHEEL_ACCELERATION_M_S2 = 1.2
# Camera: forward, up, m, and tilt downward, rad. It stands behind the axle as on a TurtleBot 2, so that it measures what touches the
# front (nearest depth 0.5 m). This is not the default mount of trundle, which has to read /tf_static.
CAMERA_X_M, CAMERA_Z_M, CAMERA_TILT_RAD = -0.087, 0.48, math.radians(8.0)
# Place of the gyro on the base, m (the Kobuki's published description).
GYRO_XYZ_M = (0.056, 0.062, 0.0202)
# Radius of a caster, m, and its distance from the axle, m.
CASTER_RADIUS_M, CASTER_X_M = 0.015, 0.12


def xml(pose, fovy_deg):
    """The robot's body at a pose (x, y, yaw) on the floor."""
    x, y, yaw = pose
    tilt = math.pi / 2 - CAMERA_TILT_RAD
    return f"""
    <body name="base" pos="{x} {y} 0" euler="0 0 {yaw}">
      <freejoint name="base"/>
      <inertial pos="0 0 0.06" mass="2.8" diaginertia="0.025 0.025 0.04"/>
      <geom name="body" type="cylinder" size="{BODY_RADIUS_M} 0.045" pos="0 0 0.062" rgba="0.1 0.1 0.12 1" group="3" friction="0.2"
            contype="2" conaffinity="1"/>
      <geom name="mast" type="cylinder" size="0.05 0.22" pos="0 0 0.38" rgba="0.1 0.1 0.12 1" group="3" friction="0.2"
            contype="2" conaffinity="1"/>
      <geom name="caster_front" type="sphere" size="{CASTER_RADIUS_M}" pos="{CASTER_X_M} 0 {CASTER_RADIUS_M}" group="3" friction="0 0 0"
            condim="1" priority="1" contype="4" conaffinity="8"/>
      <geom name="caster_back" type="sphere" size="{CASTER_RADIUS_M}" pos="-{CASTER_X_M} 0 {CASTER_RADIUS_M}" group="3" friction="0 0 0"
            condim="1" priority="1" contype="4" conaffinity="8"/>
      <camera name="eye" pos="{CAMERA_X_M} 0 {CAMERA_Z_M}" xyaxes="0 -1 0 {math.cos(tilt)} 0 {math.sin(tilt)}" fovy="{fovy_deg}"/>
      {wheel("left", WHEELBASE_M / 2)}
      {wheel("right", -WHEELBASE_M / 2)}
    </body>"""


def wheel(side, y):
    return f"""
      <body name="{side}" pos="0 {y} {WHEEL_RADIUS_M}">
        <joint name="{side}" type="hinge" axis="0 1 0" damping="0.001" armature="0.002"/>
        <geom name="{side}" type="sphere" size="{WHEEL_RADIUS_M}" mass="0.1" group="3" friction="1.0 0.001 0.0001" condim="3"
              contype="4" conaffinity="8"/>
      </body>"""


def actuators():
    """Velocity control of both wheels, rad/s."""
    return "".join(f'<velocity name="{s}" joint="{s}" kv="2" forcerange="-3 3"/>' for s in ("left", "right"))
