"""Heading error of a drive past a window: seven drives in small_house with different noise, recorded once, evaluated by `drive`.

usage: window.py MESH --trundle T --drive D --records DIR [--seeds 7] [-- FLAGS OF drive]

MESH is small_house.glb, T the program `trundle`, D the example `drive` of trundle-slam (both built for release). Recordings that are in DIR
are used again (0.7 GB each). Prints for each drive the rotation error of the live pose at the end and its maximum, in degrees; then the root
mean square of these, and the mean ATE.
"""
import argparse
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
FIRST_SEED = 1


def run(*command, env=None, fine=(0,)):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, env=env)
    if done.returncode not in fine:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def judged(drive, recording, flags):
    """Degrees at the end, at most, and the ATE in cm."""
    with tempfile.NamedTemporaryFile("r") as frames:
        printed = run(drive, recording, *flags, env={**os.environ, "TRUNDLE_FRAMES": frames.name})
        rows = [line.split() for line in frames if line[0].isdigit()]
    off = [math.degrees(float(row[5])) for row in rows]
    return off[-1], max(off), float(re.search(r"ATE ([\d.]+)", printed).group(1))


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def main():
    own, flags = sys.argv[1:], []
    if "--" in own:
        own, flags = own[: own.index("--")], own[own.index("--") + 1 :]
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh", type=pathlib.Path)
    for name in ["trundle", "drive", "records"]:
        parser.add_argument(f"--{name}", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--seeds", type=int, default=7)
    args = parser.parse_args(own)
    all_drives = []
    for seed in range(FIRST_SEED, FIRST_SEED + args.seeds):
        recording = args.records / f"window-{seed}"
        if not recording.exists():
            start = ["--start", "6.22,-2.52,66", "--follow", HERE / "window.txt"]
            # 1: it ends at a chair, before the last way-point.
            run(args.trundle, "sim", args.mesh, "--up", "z", "--seed", seed, *start, "--record", recording, fine=(0, 1))
        end, largest, ate = judged(args.drive, recording, flags)
        all_drives.append((end, largest, ate))
        print(f"seed {seed}: {end:.3f} deg at the end, {largest:.3f} at most, ATE {ate:.2f} cm", flush=True)
    ends, mosts, ates = zip(*all_drives)
    print(f"{rms(ends):.3f} and {rms(mosts):.3f} deg rms, ATE {sum(ates) / len(ates):.2f} cm on average")


if __name__ == "__main__":
    main()
