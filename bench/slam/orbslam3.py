"""Runs ORB-SLAM3 (PyPI pyorbslam3) on a TUM RGB-D folder; called by compare.py with the venv's Python.

usage: orbslam3.py DIR SETTINGS.yaml VOCABULARY.txt TRAJECTORY.txt TIMES.json

Images are decoded before the clock starts: only tracking is timed. Wall time is that of the call; CPU time is that of the
whole process while the call ran, its mapping threads included.
"""
import json
import pathlib
import sys
import time

import cv2
import numpy as np
import pyorbslam3


def rows(path):
    return [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]


def pairs(folder, limit=0.02):
    """Each colour image with the depth image nearest in time, as `trundle slam` pairs them."""
    depth = [(float(t), name) for t, name in rows(folder / "depth.txt")]
    times = np.array([t for t, _ in depth])
    for stamp, name in rows(folder / "rgb.txt"):
        i = int(np.argmin(np.abs(times - float(stamp))))
        if abs(times[i] - float(stamp)) <= limit:
            yield stamp, folder / name, folder / depth[i][1]


def quaternion(r):
    """x y z w of a rotation matrix."""
    w, v = max(0.0, 1 + np.trace(r)), np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    if w > 1e-3:
        q = np.append(v, w)
    else:
        i = int(np.argmax(np.diag(r)))
        q = np.zeros(4)
        q[:3] = (r + r.T)[i] / 2
        q[i] = (1 + 2 * r[i, i] - np.trace(r)) / 2
        q[3] = v[i] / 2
        q *= 2
    return q / np.linalg.norm(q)


def main():
    folder, settings, vocabulary, trajectory, times = sys.argv[1:]
    slam = pyorbslam3.Slam(vocabulary, settings, pyorbslam3.Sensor.RGBD, use_viewer=False)
    wall, cpu, live, start = [], [], [], time.process_time()
    for stamp, color, depth in pairs(pathlib.Path(folder)):
        image = cv2.cvtColor(cv2.imread(str(color), cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)
        metres = cv2.imread(str(depth), cv2.IMREAD_UNCHANGED).astype(np.float32)
        wall_0, cpu_0 = time.perf_counter(), time.process_time()
        result = slam.track_rgbd(image, metres, float(stamp))
        wall.append(1e3 * (time.perf_counter() - wall_0))
        cpu.append(1e3 * (time.process_time() - cpu_0))
        if result.ok:
            pose = np.asarray(result.pose_wc)
            numbers = [*pose[:3, 3], *quaternion(pose[:3, :3])]
            live.append(" ".join([stamp, *(f"{v:.9f}" for v in numbers)]))
    total = time.process_time() - start
    slam.shutdown()
    pathlib.Path(trajectory).with_suffix(".live.txt").write_text("\n".join(live) + "\n")
    slam.save_trajectory_tum(trajectory)
    pathlib.Path(times).write_text(json.dumps({"wall_ms": wall, "cpu_ms": cpu, "tracked": len(live), "process_cpu_s": total}))


main()
