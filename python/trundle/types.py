"""Types of arguments and results, for annotations."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

from ._native import BodyCondition, Cliff, Gyro, Odometry, Rgbd, Scan, Touch, Truth, Wheels

Floats: TypeAlias = NDArray[np.float64]
Numbers: TypeAlias = Sequence[float] | NDArray[Any]
File: TypeAlias = str | PathLike[str]
Outline: TypeAlias = float | Sequence[Numbers] | NDArray[Any]
Event: TypeAlias = Wheels | Gyro | Rgbd | Scan | Touch | Cliff | Odometry | BodyCondition | Truth
TrackingState: TypeAlias = Literal["ok", "weak", "dead_reckoning", "lost"]

class PlanDict(TypedDict):
    found: bool
    outcome: Literal["found", "blocked", "start_in_obstacle", "goal_in_obstacle", "start_outside", "goal_outside"]
    message: str
    nearest: Floats | None
    waypoints: Floats
    cells: Floats
    time: Floats
    poses: Floats
    twists: Floats
    duration: float
    length: float
    min_clearance: float

class DockDict(TypedDict):
    found: bool
    outcome: Literal["found", "impossible", "refused"]
    message: str
    kinds: list[Literal["turn", "drive"]]
    amounts: Floats
    starts: Floats
    durations: Floats
    poses: Floats
    duration: float
    bound: float
    margin: float

class TruthDict(TypedDict):
    stamp: float
    pose: Floats
    contacts: int
    clearance: float
    path_length: float

class Statistics(TypedDict):
    count: int
    rmse: float
    mean: float
    median: float
    std: float
    min: float
    max: float

class AteDict(Statistics):
    rotation: Statistics
    errors: Floats
    pairs: NDArray[np.int64]
    reference_from_estimate: Floats
    scale: float

class RpeDict(Statistics):
    rotation: Statistics
    errors: Floats
    pairs: NDArray[np.int64]
