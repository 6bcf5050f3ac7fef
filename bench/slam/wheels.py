"""SLAM with wrong odometry: one recorded drive, evaluated with its own odometry and with falsified ones.

usage: wheels.py DIR --drive D

DIR is a recording of `trundle sim --record`, D the example `drive` of trundle-slam, built for release. Each row is one falsification
of `odometry.txt`; the images are the same. Prints frames located, loops, ATE, and how far off the live pose was when the first loop closed.
"""
import argparse
import math
import pathlib
import re
import subprocess
import tempfile


def read(path):
    rows = [line.split() for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return [tuple(map(float, row)) for row in rows]


def steps(rows):
    """Each row as its time and the motion since the one before, in the base's frame."""
    out = [(rows[0][0], 0.0, 0.0, 0.0)]
    for (_, x, y, theta), (time, u, v, phi) in zip(rows, rows[1:]):
        c, s = math.cos(theta), math.sin(theta)
        turn = math.remainder(phi - theta, math.tau)
        out.append((time, c * (u - x) + s * (v - y), c * (v - y) - s * (u - x), turn))
    return out


def driven(motions):
    """Rows again, from the motions."""
    x = y = theta = 0.0
    out = []
    for time, along, across, turn in motions:
        c, s = math.cos(theta), math.sin(theta)
        x, y, theta = x + c * along - s * across, y + s * along + c * across, theta + turn
        out.append((time, x, y, theta))
    return out


def frozen(rows, start, length, period=math.inf):
    """Encoders that stand still for `length` s from `start` s on, again and again."""
    def stands(time):
        since = time - rows[0][0] - start
        return since >= 0 and since % period < length
    return driven([(t, 0, 0, 0) if stands(t) else (t, a, b, c) for t, a, b, c in steps(rows)])


def aside(rows, degrees):
    """A camera whose mount is turned by `degrees` relative to its description."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return driven([(t, c * a - s * b, s * a + c * b, w) for t, a, b, w in steps(rows)])


def restarted(rows):
    """Odometry that starts again at the origin half way."""
    half = len(rows) // 2
    return rows[:half] + driven([(rows[half][0], 0, 0, 0)] + steps(rows[half:])[1:])


def holes(rows):
    """No odometry for 4 s of every 5 s."""
    return [row for row in rows if (row[0] - rows[0][0]) % 5 < 1]


def scaled(rows, along, turned):
    return driven([(t, along * a, along * b, turned * w) for t, a, b, w in steps(rows)])


def slipping(rows):
    """One wheel that slips by half on 2 m in every 10 m: half of its path appears as a turn."""
    out, path = [], 0.0
    for time, along, across, turn in steps(rows):
        path += abs(along)
        out.append((time, along * 0.75, across, turn + along) if path % 10 < 2 else (time, along, across, turn))
    return driven(out)


SPOILT = {
    "as recorded": lambda rows: rows,
    "encoders frozen for 20 s": lambda rows: frozen(rows, 20, 20),
    "frozen 3 s in every 10 s": lambda rows: frozen(rows, 5, 3, 10),
    "one wheel slips by half, 2 m in every 10 m": slipping,
    "starts again at the origin half way": restarted,
    "no odometry 4 s of every 5 s": holes,
    "wheels five times as large": lambda rows: scaled(rows, 5, 1),
    "turns 5 % too large": lambda rows: scaled(rows, 1, 1.05),
    "camera mounted 2 deg aside": lambda rows: aside(rows, 2),
    "camera mounted 20 deg aside": lambda rows: aside(rows, 20),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--drive", type=pathlib.Path, required=True)
    args = parser.parse_args()
    rows = read(args.recording / "odometry.txt")
    print("| wheels | located | loops | ATE cm | off at the first loop, % |\n|---|---|---|---|---|")
    for name, spoil in SPOILT.items():
        with tempfile.TemporaryDirectory() as scratch:
            copy = pathlib.Path(scratch)
            for entry in args.recording.resolve().iterdir():
                (copy / entry.name).symlink_to(entry)
            (copy / "odometry.txt").unlink()
            lines = (f"{t:.9f} {x:.9f} {y:.9f} {w:.9f}" for t, x, y, w in spoil(rows))
            (copy / "odometry.txt").write_text("\n".join(lines) + "\n")
            printed = subprocess.run([args.drive, copy], capture_output=True, text=True, check=True).stdout
        located, loops = re.search(r"(\d+ of \d+) frames located, (\d+) loops", printed).groups()
        ate = re.search(r"ATE ([\d.]+) cm", printed)[1]
        off = re.search(r"until the first loop: .* ([\d.]+) %", printed)
        off = off[1] if off else "-"
        print(f"| {name} | {located} | {loops} | {ate} | {off} |", flush=True)


main()
