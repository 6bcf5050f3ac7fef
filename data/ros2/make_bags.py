"""Makes the three small ROS 2 bags of this folder, without ROS: CDR, MCAP and rosbag2's tables written by hand.

python3 make_bags.py; needs the programs zstd and lz4. A robot drives along x at 0.5 m/s through a room whose walls are
x = -2, x = 6, y = -2, y = 2 (odometry's frame). Its laser hangs upside down 0.2 m ahead and 0.1 m to the left, turned by 0.5 rad.
Of every scan beam 3 is NaN, beam 4 is -1, beam 5 infinite.

zstd.mcap       little endian, chunks in zstd, nav_msgs/Odometry
lz4.mcap        big endian, chunks in lz4, odometry as transforms odom > base_link only
sqlite/         a rosbag2 folder: metadata.yaml and a .db3 file with pages of 1024 bytes
"""
import math, os, sqlite3, struct, subprocess

BEAMS, FIRST, STEP = 270, -0.75 * math.pi, 1.5 * math.pi / 269
MOUNT = (0.2, 0.1, 0.3, math.pi, 0.5)  # x y z roll yaw


class Cdr:
    def __init__(self, little):
        self.mark = "<" if little else ">"
        self.head, self.body = bytes([0, 1 if little else 0, 0, 0]), b""

    def put(self, kind, *values):
        size = struct.calcsize(kind)
        for value in values:
            self.body += b"\0" * (-len(self.body) % size) + struct.pack(self.mark + kind, value)
        return self

    def text(self, text):
        self.put("I", len(text) + 1)
        self.body += text.encode() + b"\0"
        return self

    def header(self, t, frame):
        return self.put("i", 1700000000 + int(t)).put("I", round((t - int(t)) * 1e9)).text(frame)

    def bytes(self):
        return self.head + self.body


def cast(x, y, angle):
    dx, dy = math.cos(angle), math.sin(angle)
    ways = []
    if dx: ways.append(((6 if dx > 0 else -2) - x) / dx)
    if dy: ways.append(((2 if dy > 0 else -2) - y) / dy)
    return min(ways)


def scan(little, t):
    x, y, _, _, yaw = MOUNT
    ranges = [cast(0.5 * t + x, y, yaw - (FIRST + i * STEP)) for i in range(BEAMS)]
    ranges[3:6] = [math.nan, -1.0, math.inf]
    c = Cdr(little).header(t, "laser")
    c.put("f", FIRST, FIRST + STEP * (BEAMS - 1), STEP, 0.0, 0.1, 0.1, 20.0)
    c.put("I", BEAMS).put("f", *ranges)
    return c.put("I", 0).bytes()


def odometry(little, t):
    c = Cdr(little).header(t, "odom").text("base_link")
    c.put("d", 0.5 * t, 0, 0, 0, 0, 0, 1).put("d", *[0.0] * 36)
    return c.put("d", 0.5, 0, 0, 0, 0, 0).put("d", *[0.0] * 36).bytes()


def transform(little, t, parent, child, place, q):
    return Cdr(little).put("I", 1).header(t, parent).text(child).put("d", *place).put("d", *q).bytes()


def static(little):
    x, y, z, roll, yaw = MOUNT
    h, g = roll / 2, yaw / 2
    q = (math.sin(h) * math.cos(g), math.sin(h) * math.sin(g), math.cos(h) * math.sin(g), math.cos(h) * math.cos(g))
    return transform(little, 0.0, "base_link", "laser", (x, y, z), q)


LASER, ODOM, TF = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"


def messages(little, by_transforms):
    yield 0, "/tf_static", TF, static(little)
    for i in range(61):
        t = i / 20
        if by_transforms:
            yield t, "/tf", TF, transform(little, t, "odom", "base_link", (0.5 * t, 0, 0), (0, 0, 0, 1))
        else:
            yield t, "/odom", ODOM, odometry(little, t)
        if i % 6 == 0 and i < 60:
            yield t + 0.01, "/scan", LASER, scan(little, t + 0.01)


def record(op, body):
    return bytes([op]) + struct.pack("<Q", len(body)) + body


def string(text):
    return struct.pack("<I", len(text)) + text.encode()


def mcap(name, little, by_transforms, compression, program):
    magic = b"\x89MCAP0\r\n"
    chunks, ids, body, start = [], {}, b"", 0
    for n, (t, topic, kind, data) in enumerate(messages(little, by_transforms)):
        if topic not in ids:
            i = ids[topic] = len(ids) + 1
            body += record(3, struct.pack("<H", i) + string(kind) + string("ros2msg") + struct.pack("<I", 0))
            body += record(4, struct.pack("<HH", i, i) + string(topic) + string("cdr") + struct.pack("<I", 0))
        nanos = 1700000000 * 10**9 + round(t * 1e9)
        body += record(5, struct.pack("<HIQQ", ids[topic], n, nanos, nanos) + data)
        if n % 40 == 39:
            chunks.append(body)
            body = b""
    chunks.append(body)
    out = magic + record(1, string("ros2") + string("make_bags.py"))
    for chunk in chunks:
        packed = subprocess.run(program, input=chunk, stdout=subprocess.PIPE, check=True).stdout
        out += record(6, struct.pack("<QQQI", 0, 0, len(chunk), 0) + string(compression) + struct.pack("<Q", len(packed)) + packed)
    out += record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + magic
    open(name, "wb").write(out)


def sqlite(folder):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "bag_0.db3")
    if os.path.exists(path): os.remove(path)
    db = sqlite3.connect(path)
    db.execute("PRAGMA page_size=1024")
    db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
               "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)")
    db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT NULL)")
    ids = {}
    for t, topic, kind, data in messages(True, False):
        if topic not in ids:
            ids[topic] = len(ids) + 1
            db.execute("INSERT INTO topics VALUES(?,?,?,?,?)", (ids[topic], topic, kind, "cdr", ""))
        nanos = 1700000000 * 10**9 + round(t * 1e9)
        db.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", (ids[topic], nanos, data))
    db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    db.commit()
    db.close()
    open(os.path.join(folder, "metadata.yaml"), "w").write(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n"
        "    - bag_0.db3\n  compression_format: \"\"\n  compression_mode: \"\"\n")


if __name__ == "__main__":
    mcap("zstd.mcap", True, False, "zstd", ["zstd", "-q", "-c"])
    mcap("lz4.mcap", False, True, "lz4", ["lz4", "-q", "-c"])
    sqlite("sqlite")
