#!/usr/bin/env python3
"""Frames a second of SLAM from Python against the same loop in Rust, in one process, by turns.

usage: frames.py [--folder TUM_FOLDER] [--camera freiburg1] [--rounds 3] [--write results/python.json]

Python reads each image as arrays of numpy and gives them to `RgbdSlam.track`; Rust runs `slam_folder`, which is the loop of
crates/trundle/examples/01_slam_a_folder.rs. Both decode the same files and have to give the same trajectory, bit for bit. The rounds
alternate. Printed are the frames a second of each one's best round, which a busy machine disturbs least, and their ratio.
"""

import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np

import trundle

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: Frames a second of Python that are enough, as a part of those of Rust.
GOAL = 0.95


def by_python(folder, camera):
    """Trajectory, and seconds."""
    begin = time.perf_counter()
    slam = trundle.RgbdSlam(camera)
    for image in trundle.TumSequence(folder, trundle.Camera.named(camera).depth_scale):
        slam.track(image.rgb, image.depth, image.stamp)
    return slam.trajectory(), time.perf_counter() - begin


def by_rust(folder, camera):
    """Trajectory, and seconds."""
    begin = time.perf_counter()
    return trundle.slam_folder(folder, camera), time.perf_counter() - begin


def machine():
    """Cores and processor."""
    info = pathlib.Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    model = next((line.split(": ", 1)[1] for line in lines if line.startswith("model name")), "an unknown processor")
    return f"{os.cpu_count()} cores of {model}, shared"


def write(file, python, rust):
    """The result in the form of the others."""
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    figures = [
        {
            "name": "frames a second, with decoding",
            "value": round(python, 1),
            "unit": "1/s",
            "better": "more",
            "peer": {"name": "Rust", "value": round(rust, 1), "same_run": True},
        },
        {"name": "part of Rust's frames a second", "value": round(python / rust, 3), "unit": "", "goal": {"at_least": GOAL}},
    ]
    result = {
        "subject": "Python",
        "title": "SLAM from Python, freiburg1_rpy, 400 frames",
        "command": "python/bench/frames.py --write results/python.json",
        "commit": commit.stdout.strip(),
        "machine": machine(),
        "date": datetime.date.today().isoformat(),
        "figures": figures,
    }
    pathlib.Path(file).write_text(json.dumps(result, indent=2) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", default=ROOT.parent / "shared/data/tum_fr1_rpy_400", type=pathlib.Path)
    parser.add_argument("--camera", default="freiburg1")
    parser.add_argument("--rounds", default=3, type=int)
    parser.add_argument("--write", type=pathlib.Path)
    options = parser.parse_args()
    times = {by_python: [], by_rust: []}
    trajectories = []
    for _ in range(options.rounds):
        for run, seconds in times.items():
            trajectory, took = run(options.folder, options.camera)
            trajectories.append(trajectory)
            seconds.append(took)
            print(f"{run.__name__}: {took:.2f} s", file=sys.stderr)
    for trajectory in trajectories[1:]:
        np.testing.assert_array_equal(trajectory, trajectories[0])
    count = len(trundle.TumSequence(options.folder))
    python, rust = (count / min(seconds) for seconds in times.values())
    print(f"{count} frames; Python: {python:.1f} a second, Rust: {rust:.1f} a second, ratio: {python / rust:.3f}")
    if options.write:
        write(options.write, python, rust)
    sys.exit(python / rust < GOAL)


if __name__ == "__main__":
    main()
