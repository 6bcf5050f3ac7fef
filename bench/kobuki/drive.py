"""A program that is not trundle drives the emulated Kobuki of `trundle sim SCENE --kobuki LINK`.

Usage: python3 bench/kobuki/drive.py PROGRAM [PACKET.hex]
PROGRAM: trundle. PACKET.hex: one packet of a real Kobuki, which the decoder here must read right.

Only Python's standard library. Written from the protocol's description: 115200 baud; AA 55, length, parts (id, length, data), and the XOR
of all bytes from the length on; little-endian.
"""

import math
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import tty

PACKETS = 50
SPEED_MM_S = 100
DRIVE_S = 1.0
DISTANCE_M = 0.1
WHEEL_RADIUS_M = 0.035
TICKS_PER_TURN = 2578.33
# Parts of the feedback: core sensors, hardware, firmware, unique id.
CORE, HARDWARE, FIRMWARE, UNIQUE_ID = 1, 10, 11, 19


def xor(data):
    result = 0
    for byte in data:
        result ^= byte
    return result


def frame(*parts):
    """The packet of a command out of parts (id, data)."""
    content = b"".join(bytes([number, len(data)]) + data for number, data in parts)
    checked = bytes([len(content)]) + content
    return b"\xaa\x55" + checked + bytes([xor(checked)])


def base_control(speed_mm_s, radius_mm):
    return frame((1, struct.pack("<hh", speed_mm_s, radius_mm)))


def parts_of(content):
    """The parts of a packet: data by id."""
    parts, at = {}, 0
    while at < len(content):
        number, length = content[at], content[at + 1]
        parts[number] = content[at + 2 : at + 2 + length]
        assert len(parts[number]) == length, f"part {number} of {length} bytes is cut"
        at += 2 + length
    return parts


class Core:
    """The core sensors: time, ticks, battery."""

    def __init__(self, data):
        fields = struct.unpack("<HBBBHHbbBBBB", data)
        self.stamp_ms, self.bumper, self.wheel_drop, self.cliff, self.left, self.right = fields[:6]
        self.battery_v = fields[10] / 10


class Port:
    """The serial line: packets in, commands out."""

    def __init__(self, path):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.fd)
        self.waiting, self.packets, self.wrong = b"", 0, 0

    def send(self, command):
        assert os.write(self.fd, command) == len(command), "the line is full"

    def packet(self, limit_s=1.0):
        """The parts of the next sound packet."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            begin = self.waiting.find(b"\xaa\x55")
            if begin >= 0 and len(self.waiting) > begin + 2:
                last = begin + 3 + self.waiting[begin + 2]
                if len(self.waiting) > last:
                    checked, self.waiting = self.waiting[begin + 2 : last + 1], self.waiting[last + 1 :]
                    self.packets += 1
                    if xor(checked) == 0:
                        return parts_of(checked[1:-1])
                    self.wrong += 1
                    continue
            try:
                self.waiting += os.read(self.fd, 4096)
            except BlockingIOError:
                time.sleep(0.002)
        raise TimeoutError(f"no packet within {limit_s} s")

    def core(self):
        while True:
            parts = self.packet()
            if CORE in parts:
                return Core(parts[CORE])


def check_real_packet(file):
    data = bytes.fromhex("".join(pathlib.Path(file).read_text().split()))
    assert data[:2] == b"\xaa\x55" and xor(data[2:]) == 0, "XOR of the real packet"
    core = Core(parts_of(data[3:-1])[CORE])
    found = (core.stamp_ms, core.left, core.right, core.battery_v)
    assert found == (2984, 65532, 62447, 15.7), f"the real packet is read as {found}"
    print("a real packet: read")


def check_packets(port):
    """50 sound packets at 50 Hz of the base's clock, and the answer to the request for versions."""
    stamps = [port.core().stamp_ms for _ in range(PACKETS)]
    steps = [(later - earlier) % 65536 for earlier, later in zip(stamps, stamps[1:])]
    assert port.wrong == 0, f"{port.wrong} of {port.packets} packets have a wrong XOR"
    assert set(steps) == {20}, f"milliseconds between packets: {sorted(set(steps))}"
    port.send(frame((9, struct.pack("<H", 0x01 | 0x02 | 0x08))))
    answer = {}
    for _ in range(PACKETS):
        answer.update(port.packet())
    missing = {HARDWARE, FIRMWARE, UNIQUE_ID} - answer.keys()
    assert not missing, f"no answer to the request for versions: parts {missing}"
    patch, minor, major = answer[FIRMWARE][:3]
    print(f"{port.packets} packets with a right XOR, 20 ms apart; firmware {major}.{minor}.{patch}")


def stopped(port):
    """Stops the base; its core sensors at rest."""
    before, now = None, port.core()
    while before is None or (before.left, before.right) != (now.left, now.right):
        port.send(base_control(0, 0))
        before, now = now, [port.core() for _ in range(10)][-1]
    return now


def drive(port):
    """Drives ahead for a second, and stops; the ticks of both wheels."""
    before = port.core()
    end = time.monotonic() + DRIVE_S
    while time.monotonic() < end:
        port.send(base_control(SPEED_MM_S, 0))
        port.core()
    after = stopped(port)
    return (after.left - before.left) % 65536, (after.right - before.right) % 65536


def first_number(text, row):
    line = next(line for line in text.splitlines() if row in line)
    return float(line.split(row)[1].split()[0])


def main(program, *packet):
    for file in packet:
        check_real_packet(file)
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, "kobuki")
        command = [program, "sim", "room", "--no-noise", "--kobuki", link]
        robot = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            end = time.monotonic() + 60
            while not os.path.exists(link):
                assert robot.poll() is None and time.monotonic() < end, "the emulated Kobuki does not start"
                time.sleep(0.05)
            port = Port(link)
            check_packets(port)
            ticks = drive(port)
        finally:
            robot.send_signal(signal.SIGINT)
            text = robot.communicate(timeout=30)[0]
    by_ticks = [count / TICKS_PER_TURN * math.tau * WHEEL_RADIUS_M for count in ticks]
    truth = first_number(text, "true pose from the start")
    print(f"ticks {ticks}: {by_ticks[0]:.4f} m, {by_ticks[1]:.4f} m; true distance {truth:.3f} m")
    # A busy computer sends the stop late. The true distance is printed to 1 mm.
    assert abs(truth - DISTANCE_M) < 0.03, f"true distance {truth} m, expected {DISTANCE_M} m"
    assert all(abs(distance - truth) < 0.0015 for distance in by_ticks), "ticks and true distance differ"
    assert first_number(text, "last command received") == 0.0, text


main(*sys.argv[1:])
