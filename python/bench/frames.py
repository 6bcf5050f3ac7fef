"""Frames per second of SLAM from Python and of the same loop in Rust, alternately in one process.

usage: frames.py [--folder TUM_FOLDER] [--camera freiburg1] [--rounds 3]; `cargo xtask results --measure python` writes results/python.json

Python reads each image as arrays of numpy and gives them to `RgbdSlam.track`; Rust runs `slam_folder`, which is the loop of
crates/trundle/examples/01_slam_a_folder.rs. Both decode the same files and have to give the same trajectory, bit for bit. The rounds
alternate. Printed are the frames in a second of processor time of each one's best round, which other programs disturb least, their ratio, and
the frames a second by the clock. Exit code 1 if the ratio is below 0.95.
"""

import argparse
import pathlib
import sys
import time

import numpy as np

import trundle

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: Smallest accepted ratio of the frame rates of Python and Rust.
GOAL = 0.95


def by_python(folder, camera):
    """Trajectory of a loop in Python."""
    slam = trundle.RgbdSlam(camera)
    for image in trundle.TumSequence(folder, trundle.Camera.named(camera).depth_scale):
        slam.track(image.rgb, image.depth, image.stamp)
    return slam.trajectory()


def timed(run, folder, camera):
    """Trajectory, seconds of processor time of all threads, and wall-clock seconds."""
    clock, processor = time.perf_counter(), time.process_time()
    trajectory = run(folder, camera)
    return trajectory, time.process_time() - processor, time.perf_counter() - clock


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", default=ROOT.parent / "shared/data/tum_fr1_rpy_400", type=pathlib.Path)
    parser.add_argument("--camera", default="freiburg1")
    parser.add_argument("--rounds", default=3, type=int)
    options = parser.parse_args()
    times = {by_python: [], trundle.slam_folder: []}
    trajectories = []
    for _ in range(options.rounds):
        for run, seconds in times.items():
            trajectory, *took = timed(run, options.folder, options.camera)
            trajectories.append(trajectory)
            seconds.append(took)
            print(f"{run.__name__}: {took[0]:.2f} s of processor time, {took[1]:.2f} s", file=sys.stderr)
    for trajectory in trajectories[1:]:
        np.testing.assert_array_equal(trajectory, trajectories[0])
    count = len(trundle.TumSequence(options.folder))
    (python, by_clock), (rust, rust_by_clock) = (count / np.min(seconds, axis=0) for seconds in times.values())
    print(f"{count} frames in a second of processor time; Python: {python:.1f}, Rust: {rust:.1f}, ratio: {python / rust:.3f}")
    print(f"by the clock; Python {by_clock:.1f}, Rust {rust_by_clock:.1f} a second")
    sys.exit(int(python / rust < GOAL))


if __name__ == "__main__":
    main()
