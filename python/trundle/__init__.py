"""Autonomy for a two-wheeled indoor robot with one RGB-D camera.

Units are SI and radians. Poses in the plane are arrays of shape (3,): x m, y m, theta rad. Poses in space are homogeneous matrices of
shape (4, 4), m. Trajectories are rows of a TUM file, shape (N, 8): stamp s, x y z m, qx qy qz qw. The base's frame is x forward, y left,
z up; the camera's is x right, y down, z forward.

| to | use |
|---|---|
| track a camera | `RgbdSlam`, `TumSequence`, `slam_folder` |
| map a laser | `GridMapper`, `ParticleMapper`, `Scan`, `read_laser_log` |
| plan | `plan`, `dock`, `OccupancyGrid` |
| simulate | `Simulator`, `trundle.gym` |
| run the whole robot | `Robot`, `RobotConfig` and the events `Wheels`, `Gyro`, `Rgbd`, `Scan`, `Touch`, `Cliff`, `Odometry`, `BodyCondition` |
| evaluate | `trundle.evaluate` |

An object is used by one thread at a time: a concurrent call on the same object raises `RuntimeError`. Long calls release the
interpreter's lock, so that separate objects run in parallel, one per thread.
"""

from importlib.metadata import PackageNotFoundError, version

from . import evaluate
from ._native import (
    BodyCondition,
    Camera,
    Cliff,
    GridMapper,
    Gyro,
    OccupancyGrid,
    Odometry,
    ParticleMapper,
    Rgbd,
    RgbdSlam,
    Robot,
    RobotConfig,
    Scan,
    Simulator,
    SimulatorPool,
    Step,
    Touch,
    Track,
    Truth,
    TumSequence,
    Wheels,
    dock,
    plan,
    read_laser_log,
    read_trajectory,
    slam_folder,
    write_trajectory,
)

try:
    __version__ = version("trundle")
except PackageNotFoundError:  # a source folder in the search path
    __version__ = "unknown"

__all__ = [
    "BodyCondition",
    "Camera",
    "Cliff",
    "GridMapper",
    "Gyro",
    "OccupancyGrid",
    "Odometry",
    "ParticleMapper",
    "Rgbd",
    "RgbdSlam",
    "Robot",
    "RobotConfig",
    "Scan",
    "Simulator",
    "SimulatorPool",
    "Step",
    "Touch",
    "Track",
    "Truth",
    "TumSequence",
    "Wheels",
    "dock",
    "evaluate",
    "plan",
    "read_laser_log",
    "read_trajectory",
    "slam_folder",
    "write_trajectory",
]
