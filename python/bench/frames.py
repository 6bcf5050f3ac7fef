"""Frames a second of SLAM from Python against the same loop in Rust, in one process, by turns.

usage: frames.py [--folder TUM_FOLDER] [--camera freiburg1] [--rounds 10]; `cargo xtask results --measure python` writes results/python.json

Python reads each image as arrays of numpy and gives them to `RgbdSlam.track`; Rust runs `slam_folder`, which is the loop of
crates/trundle/examples/01_slam_a_folder.rs. Both decode the same files and have to give the same trajectory, bit for bit. The rounds
alternate. Printed are the frames a second of each one's best round, which a busy machine disturbs least, and their ratio. Exit code 1 if it
is below 0.95.
"""

import argparse
import pathlib
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", default=ROOT.parent / "shared/data/tum_fr1_rpy_400", type=pathlib.Path)
    parser.add_argument("--camera", default="freiburg1")
    parser.add_argument("--rounds", default=10, type=int)
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
    sys.exit(python / rust < GOAL)


if __name__ == "__main__":
    main()
