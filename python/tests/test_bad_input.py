"""Invalid input: the error names the expected form, without a panic."""

import inspect
import itertools

import numpy as np
import pytest

import trundle
from trundle import evaluate

RGB, DEPTH = np.zeros((424, 512, 3), np.uint8), np.zeros((424, 512), np.uint16)


@pytest.fixture
def slam():
    return trundle.RgbdSlam("kinect_v2")


@pytest.mark.parametrize(
    "rgb,depth,kind,text",
    [
        (RGB.astype(float), DEPTH, TypeError, "rgb has dtype float64, expected a numpy array of dtype uint8 and shape (height, width, 3)"),
        (RGB.tolist(), DEPTH, TypeError, "rgb is of type list, expected a numpy array of dtype uint8"),
        (RGB[..., 0], DEPTH, ValueError, "rgb has shape [424, 512], expected"),
        (np.zeros((424, 512, 4), np.uint8), DEPTH, ValueError, "shape (height, width, 3)"),
        (RGB, DEPTH.astype(np.int64), TypeError, "depth has dtype int64, expected a numpy array of dtype uint16"),
        (RGB, DEPTH[None], ValueError, "depth has shape [1, 424, 512]"),
        (RGB, DEPTH[:100], ValueError, "depth image size is 512 x 100 px, expected 512 x 424"),
        (RGB[:0], DEPTH[:0], ValueError, "image size is 512 x 0 px"),
        (RGB[:100], DEPTH[:100], ValueError, "image has 512 x 100 px, expected 512 x 424 px as the camera"),
        (RGB, DEPTH.astype(">u2"), TypeError, "depth has dtype >u2"),
    ],
)
def test_images(slam, rgb, depth, kind, text):
    with pytest.raises(kind) as found:
        slam.track(rgb, depth, 0.0)
    assert text in str(found.value)


@pytest.mark.parametrize(
    "call,kind,text",
    [
        (lambda: trundle.RgbdSlam(5), TypeError, "camera is of type int, expected a Camera"),
        (lambda: trundle.RgbdSlam("freiburg1", depth_scale=-1), ValueError, "depth_scale is -1 units/m"),
        (lambda: trundle.RgbdSlam("freiburg1", depth_scale=np.nan), ValueError, "depth_scale is NaN units/m"),
        (lambda: trundle.RgbdSlam("freiburg1", base_from_camera=np.eye(3)), ValueError, "shape (4, 4)"),
        (lambda: trundle.RgbdSlam("freiburg1", base_from_camera=2 * np.eye(4)), ValueError, "no rotation"),
        (lambda: trundle.RgbdSlam("kinect_v2").track(RGB, DEPTH, np.nan), ValueError, "stamp is NaN s"),
        (lambda: trundle.RgbdSlam("kinect_v2").track(RGB, DEPTH, 1e12), ValueError, "292 years"),
        (lambda: trundle.Camera(640, 480, -1, 1, 1, 1), ValueError, "fx"),
        (lambda: trundle.Camera(640, 480, 500, 500, 320, 240, distortion=[1, 2]), ValueError, "k1, k2, p1, p2, k3"),
        (lambda: trundle.OccupancyGrid(np.zeros((2, 2)), 0.1), TypeError, "dtype int8"),
        (lambda: trundle.OccupancyGrid(np.zeros(4, np.int8), 0.1), ValueError, "shape (rows, columns)"),
        (lambda: trundle.OccupancyGrid(np.full((2, 2), 50, np.int8), 0.1), ValueError, "value of a cell is 50"),
        (lambda: trundle.OccupancyGrid(np.zeros((2, 2), np.int8), 0), ValueError, "resolution"),
        (lambda: trundle.OccupancyGrid(np.zeros((2, 2), np.int8), np.nan), ValueError, "resolution"),
        (lambda: trundle.OccupancyGrid(np.zeros((2, 2), np.int8), 1, origin=(np.inf, 0)), ValueError, "origin"),
        (lambda: trundle.OccupancyGrid.from_ascii(0.1, ""), ValueError, ""),
        (lambda: trundle.GridMapper(-1), ValueError, "resolution"),
        (lambda: trundle.ParticleMapper(particles=0), ValueError, "particles"),
        (lambda: trundle.Scan(0, np.zeros(3, np.float32), 0, 0.1, range_max=1), TypeError, "dtype float64"),
        (lambda: trundle.Scan(0, np.zeros(3), 0, -0.1, range_max=1), ValueError, "angle_increment"),
        (lambda: trundle.Scan(0, np.zeros(3), 0, 0.1, range_max=np.inf), ValueError, "range_max"),
        (lambda: trundle.Wheels(0, 70000, 0), ValueError, "left is 70000 ticks"),
        (lambda: trundle.Gyro(0, np.nan), ValueError, "omega is NaN rad/s"),
        (lambda: trundle.Odometry(0, (0, 0, 0), (0, 0), np.full((3, 3), np.nan)), ValueError, ""),
        (lambda: trundle.Odometry(0, (0, 0, 0), (0, 0), np.eye(2)), ValueError, "shape (3, 3)"),
        (lambda: trundle.BodyCondition.link(0, "engine", True), ValueError, "base, camera or laser"),
        (lambda: trundle.BodyCondition.battery(0, 15, source="sun"), ValueError, "battery, charging_station or adapter"),
        (lambda: trundle.BodyCondition.battery(0, float("nan")), ValueError, "voltage"),
        (lambda: trundle.BodyCondition.button(0, 300, True), ValueError, "index of the button is 300"),
        (lambda: trundle.BodyCondition.dock_infrared(0, ["left"], [], []), ValueError, "as near_left"),
        (lambda: trundle.Robot().step(5), TypeError, "event is of type int, expected one of Wheels"),
        (lambda: trundle.Robot("robot.toml"), TypeError, "RobotConfig('robot.toml')"),
        (lambda: trundle.Robot().drive_to((np.nan, 0, 0)), ValueError, "goal is NaN"),
        (lambda: trundle.Robot().drive_to((1e9, 0, 0)), ValueError, "x of goal is 1000000000 m"),
        (lambda: trundle.Robot().drive_to((0, 0)), ValueError, "goal has 2 numbers, expected 3 numbers: x m, y m, theta rad"),
        (lambda: trundle.Robot().drive_to("abc"), TypeError, "goal is of type str"),
        (lambda: trundle.Simulator("room").step((np.nan, 0)), ValueError, "twist is NaN"),
        (lambda: trundle.Simulator("room").step((0, 0), np.nan), ValueError, "duration is NaN s"),
        (lambda: trundle.Simulator("room").step((1e4, 0)), ValueError, "v of twist is 10000 m/s"),
        (lambda: trundle.Simulator("room", start=(1e5, 0, 0)), ValueError, "outside scene"),
        (lambda: trundle.TumSequence("/no/such/folder"), (OSError, ValueError), "/no/such/folder"),
        (lambda: trundle.read_trajectory("/no/such/file"), FileNotFoundError, "/no/such/file"),
        (lambda: evaluate.ate(np.zeros((3, 7)), np.zeros((3, 8))), ValueError, "shape (any, 8)"),
        (lambda: evaluate.ate(np.zeros((3, 8), np.float32), np.zeros((3, 8))), TypeError, "dtype float64"),
        (lambda: trundle.dock(5, (0, 0, 0), (0, 0, 0)), TypeError, "obstacles is of type int"),
        (lambda: trundle.dock([np.zeros((2, 3))], (0, 0, 0), (0, 0, 0)), ValueError, "obstacles[0] has shape [2, 3]"),
        (lambda: trundle.dock([], (0, 0, 0), (0, 0, 0), -1.0), ValueError, "radius"),
        (lambda: trundle.dock([], (0, 0, 0), (0, 0, 0), margin=np.nan), ValueError, "margin"),
        (lambda: trundle.dock([], (0, 0, 0), (0, 0, 0), [(0, 0), (1, 0)]), ValueError, ""),
    ],
)
def test_values(call, kind, text):
    with pytest.raises(kind) as found:
        call()
    assert text in str(found.value), str(found.value)


JUNK = [
    None, True, -1, 0, 7, 2**70, -(2**70), 0.5, float("nan"), float("inf"), 1e308, "", "room", "\0", b"x", [], [1], [1, 2, 3],
    ["a"], {}, object(), np.zeros(0), np.zeros((0, 8)), np.full((4, 8), np.nan), np.full((4, 4), 1e300), np.zeros((3, 2)),
    np.zeros((1, 1), np.int8), np.zeros((2, 2, 3), np.uint8), np.array(5), np.array(["a"]), np.zeros((2, 3), complex),
    np.zeros(3, [("a", "f8")]), np.ma.masked_array([1.0, 2.0, 3.0]), [float("nan")] * 3, [1e308] * 3,
]  # fmt: skip

ALLOWED = (TypeError, ValueError, OverflowError, OSError, IndexError, AttributeError)


def makers():
    """Every class and function of the package, by name."""
    for name in trundle.__all__:
        member = getattr(trundle, name)
        if inspect.isclass(member) or inspect.isbuiltin(member):
            yield name, member
            for part, method in inspect.getmembers(member):
                if inspect.isclass(member) and not part.startswith("_") and isinstance(inspect.getattr_static(member, part), staticmethod):
                    yield f"{name}.{part}", method
    yield "ate", evaluate.ate
    yield "rpe", evaluate.rpe


@pytest.mark.parametrize("name,call", list(makers()), ids=lambda value: value if isinstance(value, str) else "")
def test_junk_of_every_kind_is_refused_without_panic(name, call):
    chance = np.random.default_rng(len(name))
    tries = [()] + [(junk,) * count for junk in JUNK for count in range(1, 4)]
    tries += [tuple(JUNK[i] for i in chance.integers(len(JUNK), size=chance.integers(1, 7))) for _ in range(150)]
    # Creating a simulator of a room takes seconds.
    for arguments in tries[:: 4 if call is trundle.Simulator else 1]:
        try:
            call(*arguments)
        except ALLOWED:
            pass  # PanicException is a BaseException and ends the test.


def objects():
    yield trundle.RgbdSlam("kinect_v2")
    yield trundle.Robot()
    yield trundle.Simulator("room", 1, camera=None, laser="lds-01")
    yield trundle.SimulatorPool("room", [1, 2], "lds-01")
    yield trundle.GridMapper()
    yield trundle.ParticleMapper()
    yield trundle.OccupancyGrid(np.zeros((2, 2), np.int8), 0.1)


@pytest.mark.parametrize("index", range(7))
def test_junk_in_methods_is_refused_without_panic(index, tmp_path, monkeypatch, images):
    monkeypatch.chdir(tmp_path)
    chance, target = np.random.default_rng(index), list(objects())[index]
    valid = [images[1][0], trundle.Wheels(0.0, 1, 1), (0, 0, 0), (0.1, 0.1), 0.002, images[1][0].rgb, images[1][0].depth]
    values = JUNK + valid
    names = [name for name in dir(target) if not name.startswith("_") and callable(getattr(target, name))]
    for name, _ in itertools.product(names, range(80)):
        arguments = tuple(values[i] for i in chance.integers(len(values), size=chance.integers(0, 5)))
        try:
            getattr(target, name)(*arguments)
        except ALLOWED:
            pass
    assert repr(target)
