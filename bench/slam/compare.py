"""Whole sequences: `trundle slam` against ORB-SLAM3 (PyPI pyorbslam3), one after the other on the same core.

usage: compare.py DIR... --trundle PROGRAM --vocabulary VOC.txt [--core 1] [--runs 1] [--out out/compare]

DIR is a TUM RGB-D folder: a recording of `trundle sim --record`, or tum_fr1_rpy_400. Run it with the Python of a virtual
environment that has pyorbslam3, numpy and opencv-python-headless. For each folder and run it prints, a row a program:
frames posed, ATE RMSE (rigid alignment, own code for both), wall-clock milliseconds a frame (median, 99th percentile),
CPU milliseconds a frame of the whole process, and the ratio of the medians. Both are pinned to one core, so that the mapping
threads of ORB-SLAM3 share it with its tracking: its wall time is that of tracking with the others in between, its CPU time
holds all of its threads. CPU time holds the decoding of the images and, for trundle, the writing of its results too.
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent

# TUM's calibration of freiburg1's colour camera, and ORB-SLAM3's settings for it.
FREIBURG1 = """%YAML:1.0
---
File.version: "1.0"
Camera.type: "PinHole"
Camera1.fx: 517.3
Camera1.fy: 516.5
Camera1.cx: 318.6
Camera1.cy: 255.3
Camera1.k1: 0.2624
Camera1.k2: -0.9531
Camera1.p1: -0.0054
Camera1.p2: 0.0026
Camera1.k3: 1.1633
Camera.width: 640
Camera.height: 480
Camera.fps: 30
Camera.RGB: 1
Stereo.ThDepth: 40.0
Stereo.b: 0.07732
RGBD.DepthMapFactor: 5000.0
ORBextractor.nFeatures: 1000
ORBextractor.scaleFactor: 1.2
ORBextractor.nLevels: 8
ORBextractor.iniThFAST: 20
ORBextractor.minThFAST: 7
Viewer.KeyFrameSize: 0.05
Viewer.KeyFrameLineWidth: 1.0
Viewer.GraphLineWidth: 0.9
Viewer.PointSize: 2.0
Viewer.CameraSize: 0.08
Viewer.CameraLineWidth: 3.0
Viewer.ViewpointX: 0.0
Viewer.ViewpointY: -0.7
Viewer.ViewpointZ: -1.8
Viewer.ViewpointF: 500.0
"""


def trajectory(path):
    """Stamps and positions of a TUM trajectory."""
    rows = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    numbers = np.array([[float(v) for v in row[:4]] for row in rows]).reshape(-1, 4)
    return numbers[:, 0], numbers[:, 1:]


def ate(truth, estimate, limit=0.02):
    """Poses with a true one within `limit` s, and their RMSE in m after the best rigid alignment."""
    (t_true, p_true), (t, p) = truth, estimate
    if len(t) == 0:
        return 0, float("nan")
    after = np.clip(np.searchsorted(t_true, t), 1, len(t_true) - 1)
    nearest = np.where(t - t_true[after - 1] <= t_true[after] - t, after - 1, after)
    near = np.abs(t_true[nearest] - t) <= limit
    a, b = p[near], p_true[nearest[near]]
    a0, b0 = a - a.mean(0), b - b.mean(0)
    u, _, v = np.linalg.svd(b0.T @ a0)
    rotation = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v
    return int(near.sum()), float(np.sqrt(((a0 @ rotation.T - b0) ** 2).sum(1).mean()))


def run(core, command, accepted=(0,)):
    """Seconds of CPU that a pinned command took, user and system. Raises unless its exit code is one of `accepted`."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = ["taskset", "-c", str(core), *map(str, command)]
    done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if done.returncode not in accepted:
        raise subprocess.CalledProcessError(done.returncode, command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def ours(args, folder, out):
    size = ["--threads", "1", "--quiet", "--out", out]
    # Exit code 1: more than a tenth of the images is not located.
    cpu = run(args.core, [args.trundle, "slam", folder, *size], accepted=(0, 1))
    summary = json.loads((out / "summary.json").read_text())
    stage = summary["wall_clock"]["stages"]["slam"]
    posed, error = ate(trajectory(folder / "groundtruth.txt"), trajectory(out / "trajectory.txt"))
    frames = summary["frames"]
    tracked = frames - summary["frames_lost"]
    return {
        "program": "trundle", "frames": frames, "tracked": tracked, "posed": posed, "ate_cm": 100 * error,
        "median_ms": stage["median_ms"], "p99_ms": stage["p99_ms"], "cpu_ms": 1e3 * cpu / frames,
    }


def theirs(args, folder, out):
    out.mkdir(parents=True, exist_ok=True)
    settings = folder / "orb_slam.yaml"
    if not settings.exists():
        settings = out / "freiburg1.yaml"
        settings.write_text(FREIBURG1)
    saved, times = out / "trajectory.txt", out / "times.json"
    script = [sys.executable, HERE / "orbslam3.py", folder, settings, args.vocabulary, saved, times]
    run(args.core, script)
    times = json.loads(times.read_text())
    truth = trajectory(folder / "groundtruth.txt")
    _, error = ate(truth, trajectory(saved))
    _, live = ate(truth, trajectory(saved.with_suffix(".live.txt")))
    frames, tracked = len(times["wall_ms"]), times["tracked"]
    return {
        "program": "ORB-SLAM3", "frames": frames, "tracked": tracked, "posed": tracked,
        "ate_cm": 100 * error, "live_ate_cm": 100 * live,
        "median_ms": statistics.median(times["wall_ms"]), "p99_ms": float(np.percentile(times["wall_ms"], 99)),
        "cpu_ms": 1e3 * times["process_cpu_s"] / frames, "tracking_cpu_ms": statistics.median(times["cpu_ms"]),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=pathlib.Path, nargs="+", metavar="DIR")
    parser.add_argument("--trundle", type=pathlib.Path, required=True)
    parser.add_argument("--vocabulary", type=pathlib.Path, required=True, help="DBoW2 text, for ORB-SLAM3")
    parser.add_argument("--core", type=int, default=1)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/compare"))
    args = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f}; core {args.core}")
    head = ["sequence", "run", "program", "posed", "ATE cm", "median ms", "p99 ms", "CPU ms a frame"]
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    results = []
    for folder in args.folders:
        for number in range(1, args.runs + 1):
            out = args.out / folder.name / str(number)
            out.mkdir(parents=True, exist_ok=True)
            pair = [ours(args, folder, out / "trundle"), theirs(args, folder, out / "orbslam3")]
            for r in pair:
                error = f"{r['ate_cm']:.2f}" + (f" (live {r['live_ate_cm']:.2f})" if "live_ate_cm" in r else "")
                times = [f"{r[key]:.1f}" for key in ("median_ms", "p99_ms", "cpu_ms")]
                posed = f"{r['tracked']} of {r['frames']}"
                print("| " + " | ".join([folder.name, str(number), r["program"], posed, error, *times]) + " |", flush=True)
                results.append({"sequence": folder.name, "run": number, **r})
            ratio = [b / a for a, b in ((pair[0][key], pair[1][key]) for key in ("median_ms", "p99_ms", "cpu_ms"))]
            print(f"| {folder.name} | {number} | ORB-SLAM3 / trundle | | | " + " | ".join(f"{r:.2f}" for r in ratio) + " |")
    (args.out / "results.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
