"""Writes RGB-D bags with rosbags in every form that trundle reads, converts each with trundle, and compares the pixels.

python bags.py TRUNDLE
"""
import io, json, struct, subprocess, sys, tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_KILTED)
T = STORE.types
W, H, FRAMES, RATE = 64, 48, 5, 10
FX, FY, CX, CY = 60.0, 61.0, 31.5, 23.5


def stamp(i, late_ms=0):
    ns = 1_700_000_000 * 10**9 + i * 10**9 // RATE + late_ms * 10**6
    return ns, T["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)


def header(i, frame, late_ms=0):
    return T["std_msgs/msg/Header"](stamp=stamp(i, late_ms)[1], frame_id=frame)


def color(i):
    y, x = np.mgrid[0:H, 0:W]
    return np.stack([(x * 3 + i * 7) % 256, (y * 5) % 256, (x + y + i) % 256], 2).astype(np.uint8)


def depth_mm(i):
    y, x = np.mgrid[0:H, 0:W]
    mm = (800 + 13 * x + 7 * y + 50 * i).astype(np.uint16)
    mm[:, :3] = 0
    return mm


def image(i, frame, encoding, array, step, late_ms=0):
    data = np.frombuffer(array.tobytes(), np.uint8)
    return T["sensor_msgs/msg/Image"](header(i, frame, late_ms), H, W, encoding, 0, step, data)


def compressed(i, frame, form, data, late_ms=0):
    return T["sensor_msgs/msg/CompressedImage"](header(i, frame, late_ms), form, np.frombuffer(data, np.uint8))


def picture(array, form, **options):
    out = io.BytesIO()
    Image.fromarray(array).save(out, form, **options)
    return out.getvalue()


def rvl(mm):
    """Wilson 2017, as compressed_depth_image_transport has it: columns, rows, words of eight groups."""
    groups = []

    def vle(v):
        while True:
            rest = v >> 3
            groups.append((v & 7) | (8 if rest else 0))
            if not rest:
                return
            v = rest

    flat, at, before = mm.ravel().tolist(), 0, 0
    while at < len(flat):
        start = at
        while at < len(flat) and flat[at] == 0:
            at += 1
        vle(at - start)
        start = at
        while at < len(flat) and flat[at] != 0:
            at += 1
        vle(at - start)
        for value in flat[start:at]:
            d = value - before
            vle((d << 1) ^ (d >> 31))
            before = value
    groups += [0] * (-len(groups) % 8)
    words = [sum(g << (28 - 4 * k) for k, g in enumerate(groups[j:j + 8])) for j in range(0, len(groups), 8)]
    return struct.pack("<ii", mm.shape[1], mm.shape[0]) + struct.pack(f"<{len(words)}I", *words)


def inverse(mm):
    """Quantised inverse depth of 32-bit images: (header, numbers, metres again)."""
    a, b = np.float32(200.0), np.float32(1.0)
    metres = mm / 1000.0
    with np.errstate(divide="ignore"):
        numbers = np.where(mm == 0, 0, np.round(a / metres + b)).astype(np.uint16)
        back = np.where(numbers == 0, 0, a / (numbers.astype(np.float64) - b))
    return struct.pack("<iff", 1, a, b), numbers, back


def colors():
    rgba = lambda c: np.dstack([c, np.full((H, W), 255, np.uint8)])
    yield "rgb8", "", lambda i: image(i, "cam", "rgb8", color(i), 3 * W), 0
    yield "bgr8", "", lambda i: image(i, "cam", "bgr8", color(i)[..., ::-1], 3 * W), 0
    yield "rgba8", "", lambda i: image(i, "cam", "rgba8", rgba(color(i)), 4 * W), 0
    yield "bgra8", "", lambda i: image(i, "cam", "bgra8", rgba(color(i)[..., ::-1]), 4 * W), 0
    yield "png", "/compressed", lambda i: compressed(i, "cam", "rgb8; png compressed bgr8", picture(color(i), "PNG")), 0
    yield "jpeg", "/compressed", lambda i: compressed(i, "cam", "rgb8; jpeg compressed bgr8", picture(color(i), "JPEG", quality=100, subsampling=0)), 12


def depths():
    f32 = lambda mm: np.where(mm == 0, np.nan, mm / 1000.0).astype(np.float32)
    none = bytes(12)
    yield "16UC1", "", lambda i: image(i, "cam", "16UC1", depth_mm(i), 2 * W, 4), None
    yield "32FC1", "", lambda i: image(i, "cam", "32FC1", f32(depth_mm(i)), 4 * W, 4), None
    yield "png", "/compressedDepth", lambda i: compressed(i, "cam", "16UC1; compressedDepth png", none + picture(depth_mm(i), "PNG"), 4), None
    yield "rvl", "/compressedDepth", lambda i: compressed(i, "cam", "16UC1; compressedDepth rvl", none + rvl(depth_mm(i)), 4), None
    yield "inverse", "/compressedDepth", lambda i: compressed(i, "cam", "32FC1; compressedDepth png", inverse(depth_mm(i))[0] + picture(inverse(depth_mm(i))[1], "PNG"), 4), lambda mm: inverse(mm)[2]


def transform(i, parent, child, xyz, q=(0.0, 0.0, 0.0, 1.0)):
    V, Q = T["geometry_msgs/msg/Vector3"], T["geometry_msgs/msg/Quaternion"]
    t = T["geometry_msgs/msg/Transform"](V(*xyz), Q(*q))
    s = T["geometry_msgs/msg/TransformStamped"](header(i, parent), child, t)
    return T["tf2_msgs/msg/TFMessage"]([s])


def camera_info(i):
    roi = T["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
    k = np.array([FX, 0, CX, 0, FY, CY, 0, 0, 1.0])
    p = np.array([FX, 0, CX, 0, 0, FY, CY, 0, 0, 0, 1.0, 0])
    d = np.array([0.01, -0.02, 0.001, 0.0, 0.0])
    return T["sensor_msgs/msg/CameraInfo"](header(i, "cam"), H, W, "plumb_bob", d, k, np.eye(3).ravel(), p, 0, 0, roi)


def odometry(i):
    P, Q, V = (T[f"geometry_msgs/msg/{n}"] for n in ("Point", "Quaternion", "Vector3"))
    pose = T["geometry_msgs/msg/PoseWithCovariance"](T["geometry_msgs/msg/Pose"](P(0.1 * i, 0.0, 0.0), Q(0.0, 0.0, 0.0, 1.0)), np.zeros(36))
    twist = T["geometry_msgs/msg/TwistWithCovariance"](T["geometry_msgs/msg/Twist"](V(1.0, 0.0, 0.0), V(0.0, 0.0, 0.0)), np.zeros(36))
    return T["nav_msgs/msg/Odometry"](header(i, "odom"), "base_link", pose, twist)


def write_bag(path, plugin, color_topic, make_color, depth_topic, make_depth):
    with Writer(path, version=9, storage_plugin=plugin) as bag:
        topics = {}

        def put(topic, kind, message, ns):
            if topic not in topics:
                topics[topic] = bag.add_connection(topic, kind, typestore=STORE)
            bag.write(topics[topic], ns, STORE.serialize_cdr(message, kind))

        # A camera that looks ahead, 0.3 m above the floor: optical frame by REP 103.
        put("/tf_static", "tf2_msgs/msg/TFMessage", transform(0, "base_link", "cam", (0.1, 0.0, 0.3), (-0.5, 0.5, -0.5, 0.5)), stamp(0)[0])
        for i in range(FRAMES):
            ns = stamp(i)[0]
            put("/odom", "nav_msgs/msg/Odometry", odometry(i), ns)
            put("/cam/color/camera_info", "sensor_msgs/msg/CameraInfo", camera_info(i), ns)
            kind = "sensor_msgs/msg/CompressedImage" if color_topic.endswith("compressed") else "sensor_msgs/msg/Image"
            put(color_topic, kind, make_color(i), ns)
            kind = "sensor_msgs/msg/CompressedImage" if depth_topic.endswith("Depth") else "sensor_msgs/msg/Image"
            put(depth_topic, kind, make_depth(i), ns + 4 * 10**6)


def check(trundle, bag, out, color_tolerance, depth_of):
    subprocess.run([trundle, "convert", bag, out, "--to", "tum", "--quiet"], check=True)
    for i in range(FRAMES):
        name = f"{stamp(i)[0] // 10**9}.{stamp(i)[0] % 10**9:09d}.png".rjust(24, "0")
        got = np.array(Image.open(out / "rgb" / name)).astype(int)
        worst = np.abs(got - color(i)).max()
        assert worst <= color_tolerance, f"colour differs by {worst} in frame {i}"
        metres = np.array(Image.open(out / "depth" / name)) / 5000.0
        expected = depth_of(depth_mm(i)) if depth_of else depth_mm(i) / 1000.0
        worst = np.abs(metres - expected).max()
        assert worst < 1.1e-4, f"depth differs by {worst} m in frame {i}"
    camera = (out / "camera.toml").read_text()
    assert f"fx = {FX}" in camera and "k1 = 0.01" in camera, camera
    rows = [line.split() for line in (out / "odometry.txt").read_text().splitlines() if not line.startswith("#")]
    assert len(rows) == FRAMES and abs(float(rows[-1][1]) - 0.1 * (FRAMES - 1)) < 1e-9, rows


def track(trundle, bag, out):
    """`trundle slam` reads each pair of the bag, in its order of time, with the odometry; whether it maps them is not compared."""
    ended = subprocess.run([trundle, "slam", bag, "--out", out, "--quiet"], capture_output=True, text=True)
    assert ended.returncode in (0, 1), ended.stderr
    summary = json.loads(next(out.rglob("summary.json")).read_text())
    assert summary["frames"] == FRAMES, summary


def main():
    trundle = str(Path(sys.argv[1]).resolve())
    plugins = {"sqlite": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}
    cases = [(c, next(depths())) for c in colors()] + [(next(colors()), d) for d in list(depths())[1:]]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        done = 0
        for plugin_name, plugin in plugins.items():
            for (color_name, suffix, make_color, tolerance), (depth_name, depth_suffix, make_depth, depth_of) in cases:
                name = f"{plugin_name}-{color_name}-{depth_name}"
                bag = scratch / name
                write_bag(bag, plugin, "/cam/color/image_raw" + suffix, make_color, "/cam/depth/image_raw" + depth_suffix, make_depth)
                try:
                    check(trundle, bag, scratch / f"{name}-tum", tolerance, depth_of)
                except Exception as problem:
                    sys.exit(f"{name}: {problem}")
                done += 1
        first = next(colors()), next(depths())
        track(trundle, scratch / f"sqlite-{first[0][0]}-{first[1][0]}", scratch / "slam")
        print(f"{done} bags of rosbags: colour, depth, camera and odometry are equal")
        topics = subprocess.run([trundle, "convert", bag, "--list"], check=True, capture_output=True, text=True).stdout
        assert "/cam/color/image_raw" in topics and "32FC1; compressedDepth png" in topics, topics


main()
