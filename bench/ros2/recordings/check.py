"""Opens a recording of trundle with programs of others and compares numbers with trundle's own results.

python check.py RUN_FOLDER TUM_FOLDER RERUN_PROGRAM
"""
import io, re, struct, subprocess, sys
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from PIL import Image
from rosbags.highlevel import AnyReader

EXPECTED = {
    "/camera/color/image_raw/compressed": "sensor_msgs/msg/CompressedImage",
    "/camera/depth/image_raw/compressedDepth": "sensor_msgs/msg/CompressedImage",
    "/camera/color/camera_info": "sensor_msgs/msg/CameraInfo",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/odom": "nav_msgs/msg/Odometry",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/plan": "nav_msgs/msg/Path",
    "/goal_pose": "geometry_msgs/msg/PoseStamped",
    "/pose": "geometry_msgs/msg/PoseStamped",
    "/imu": "sensor_msgs/msg/Imu",
    "/cmd_vel": "geometry_msgs/msg/TwistStamped",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/ground_truth": "nav_msgs/msg/Odometry",
}


def unpack_rvl(data):
    columns, rows = struct.unpack_from("<ii", data)
    groups = (w >> s & 15 for (w,) in struct.iter_unpack("<I", data[8:]) for s in range(28, -4, -4))

    def number():
        value = shift = 0
        while True:
            group = next(groups)
            value |= (group & 7) << shift
            shift += 3
            if group < 8:
                return value

    out, before = [], 0
    while len(out) < columns * rows:
        zeros, readings = number(), number()
        out += [0] * zeros
        for _ in range(readings):
            coded = number()
            before += (coded >> 1) ^ -(coded & 1)
            out.append(before)
    return np.array(out).reshape(rows, columns)


def yaw(q):
    return 2 * np.arctan2(q.z, q.w)


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def table(path):
    return np.array([[float(v) for v in line.split()] for line in path.read_text().splitlines() if not line.startswith("#")])


def check_messages(by_topic, run, tum):
    """by_topic: the decoded messages of one library."""
    poses = by_topic["/pose"]
    own = table(run / "trajectory.txt")
    got = np.array([[seconds(m.header.stamp), m.pose.position.x, m.pose.position.y, yaw(m.pose.orientation)] for m in poses])
    own = own[np.isin(np.round(own[:, 0], 6), np.round(got[:, 0], 6))]
    assert len(own) > 10, "too few poses with the stamps of trajectory.txt"
    # A pose is recorded when it is known, the trajectory has it at the stamp of its image.
    near = np.abs(np.interp(own[:, 0], got[:, 0], got[:, 1]) - own[:, 1]).max()
    assert near < 0.02, f"poses differ by {near} m from trajectory.txt"
    # map -> odom -> base_link at the newest odometry is the pose.
    tf = {}
    for message in by_topic["/tf"]:
        for t in message.transforms:
            tf.setdefault((t.header.frame_id, t.child_frame_id), []).append(t)
    a, b = tf["map", "odom"][-1].transform, tf["odom", "base_link"][-1].transform
    turn = yaw(a.rotation)
    x = a.translation.x + np.cos(turn) * b.translation.x - np.sin(turn) * b.translation.y
    assert abs(x - got[-1, 1]) < 0.03, (x, got[-1])
    static = by_topic["/tf_static"][0].transforms[0]
    assert (static.header.frame_id, static.child_frame_id) == ("base_link", "camera")
    assert abs(static.transform.translation.z - 0.45) < 1e-9
    # The last map, cell by cell where it is as large as the picture.
    grid = by_topic["/map"][-1]
    cells = np.array(grid.data, dtype=np.int64).astype(np.int8).reshape(grid.info.height, grid.info.width)
    picture = np.array(Image.open(run / "map.pgm"))[::-1]
    if picture.shape == cells.shape:
        known = {254: 0, 0: 100, 205: -1}
        own_cells = np.vectorize(known.get)(picture)
        same = (own_cells == cells).mean()
        assert same > 0.97, f"{same:.3f} of the cells of the last recorded map are those of map.pgm"
    assert (cells == 100).sum() > 50 and (cells == 0).sum() > 500
    # Images: colour about the same in another decoder, depth exact.
    color, depth = by_topic["/camera/color/image_raw/compressed"], by_topic["/camera/depth/image_raw/compressedDepth"]
    assert len(color) == len(depth) == len(by_topic["/camera/color/camera_info"]) > 20
    assert color[0].format == "jpeg" and depth[0].format == "16UC1; compressedDepth rvl"
    name = f"{color[5].header.stamp.sec}.{color[5].header.stamp.nanosec:09d}.png".rjust(24, "0")
    ours = np.array(Image.open(tum / "rgb" / name)).astype(int)
    theirs = np.array(Image.open(io.BytesIO(bytes(color[5].data))).convert("RGB")).astype(int)
    assert np.abs(ours - theirs).mean() < 1.0, np.abs(ours - theirs).mean()
    units = np.array(Image.open(tum / "depth" / name)).astype(int)
    millimetres = unpack_rvl(bytes(depth[5].data)[12:])
    assert (units == 5 * np.where(millimetres * 5 > 65535, 0, millimetres)).all(), "depth differs"
    info = by_topic["/camera/color/camera_info"][0]
    assert (info.width, info.height) == (512, 424) and info.k[0] > 300
    states = [m.status[0].message for m in by_topic["/diagnostics"]]
    assert "driving" in states and states[-1].startswith("arrived"), states
    assert by_topic["/plan"][0].poses and abs(by_topic["/goal_pose"][0].pose.position.x - 0.8) < 1e-9
    scan = by_topic["/scan"][0]
    hits = np.isfinite(np.array(scan.ranges))
    assert hits.sum() > 20, "too few returns in the scan"


def by_mcap(file):
    out = {}
    with open(file, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
        assert {c.message_encoding for c in summary.channels.values()} == {"cdr"}
        assert "zstd" in {c.compression for c in summary.chunk_indexes}
        for schema, channel, _, message in reader.iter_decoded_messages():
            assert EXPECTED.get(channel.topic, schema.name) == schema.name, (channel.topic, schema.name)
            out.setdefault(channel.topic, []).append(message)
        assert summary.statistics.message_count == sum(map(len, out.values()))
    return out


def by_rosbags(file):
    out = {}
    with AnyReader([file]) as reader:
        for connection, _, raw in reader.messages():
            out.setdefault(connection.topic, []).append(reader.deserialize(raw, connection.msgtype))
    return out


def by_rerun(program, file):
    """The archetypes that rerun made of each topic: decoded data, not raw bytes."""
    target = file.with_suffix(".rrd")
    subprocess.run([program, "mcap", "convert", str(file), "-o", str(target)], check=True, capture_output=True)
    text = subprocess.run([program, "rrd", "print", "-vv", str(target)], check=True, capture_output=True, text=True).stdout
    columns, entity = set(), ""
    for line in text.splitlines():
        if found := re.search(r"\* entity_path: (\S+)", line):
            entity = found[1]
        columns |= {(entity, archetype) for archetype in re.findall(r"archetype: (\w+)", line)}
    for topic, archetype in [
        ("/camera/color/image_raw/compressed", "EncodedImage"),
        ("/camera/depth/image_raw/compressedDepth", "EncodedDepthImage"),
        ("/tf", "Transform3D"),
        ("/map", "GridMap"),
    ]:
        found = sorted(a for path, a in columns if path == topic)
        assert archetype in found, f"rerun made {found} of {topic}, expected {archetype}"
    return len(columns)


def main():
    run, tum, rerun = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    file = run / "recording.mcap"
    for name, read in [("mcap-ros2-support", by_mcap), ("rosbags", by_rosbags)]:
        messages = read(file)
        missing = [topic for topic in EXPECTED if topic not in messages]
        assert not missing, f"{name}: no message on {missing}"
        check_messages(messages, run, tum)
        print(f"{name}: {sum(map(len, messages.values()))} messages on {len(messages)} topics, numbers are trundle's")
    if Path(rerun).exists():
        print(f"rerun mcap convert: images, transforms and map decoded, {by_rerun(rerun, file)} components")


main()
