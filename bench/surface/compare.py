"""The surface of a simulated drive: trundle and Open3D along the same poses, both against the scene's own triangles.

usage: compare.py RECORDING SCENE.glb --trundle PATH [--voxel 0.02] [--height 0.45 --tilt 8] [--core N]

RECORDING is a folder of `trundle sim SCENE.glb --up z --record`. Both programs integrate the same images on one core. Needs numpy, open3d
and trimesh (PyPI). See README.md beside this file.
"""
import argparse
import os
import pathlib
import re
import subprocess
import tempfile
import time
import tomllib

os.environ.setdefault("OMP_NUM_THREADS", "1")
import numpy as np
import open3d as o3d
import trimesh

# The images that `trundle slam --mesh` uses: crates/trundle-app/src/surface.rs.
MIN_DISTANCE_M, MIN_TURN_RAD, MAX_PAUSE_S = 0.1, 0.087, 1.0
MIN_DEPTH_M, MAX_DEPTH_M, TRUNCATION_VOXELS = 0.4, 5.0, 4
MIN_PART_VERTICES = 50
NEAR_M = 0.03


def read_poses(path):
    """Stamps as written, and 4 x 4 poses."""
    stamps, poses = [], []
    for line in path.read_text().splitlines():
        if line.startswith("#") or not line.strip():
            continue
        stamp, x, y, z, qx, qy, qz, qw = line.split()[:8]
        qx, qy, qz, qw = map(float, (qx, qy, qz, qw))
        pose = np.eye(4)
        pose[:3, :3] = [
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
            [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
            [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)],
        ]
        pose[:3, 3] = float(x), float(y), float(z)
        stamps.append(float(stamp))
        poses.append(pose)
    return np.array(stamps), poses


def read_list(path):
    """Stamp and file of each image."""
    rows = [line.split()[:2] for line in path.read_text().splitlines() if not line.startswith("#")]
    return {float(stamp): name for stamp, name in rows}


def used_frames(stamps, poses):
    """Indices of the images that the surface is made of."""
    used, last = [], None
    for i, (stamp, pose) in enumerate(zip(stamps, poses)):
        if last is not None:
            motion = np.linalg.inv(poses[last]) @ pose
            turn = np.arccos(np.clip((np.trace(motion[:3, :3]) - 1) / 2, -1, 1))
            moved = np.linalg.norm(motion[:3, 3])
            if moved <= MIN_DISTANCE_M and turn <= MIN_TURN_RAD and stamp - stamps[last] <= MAX_PAUSE_S:
                continue
        used.append(i)
        last = i
    return used


def rigid(source, target):
    """The rigid motion that lays points onto points: [Horn87]."""
    a, b = source - source.mean(0), target - target.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    turn = np.diag([1, 1, np.sign(np.linalg.det(vt.T @ u.T))])
    motion = np.eye(4)
    motion[:3, :3] = vt.T @ turn @ u.T
    motion[:3, 3] = target.mean(0) - motion[:3, :3] @ source.mean(0)
    return motion


def world_from_map(recording, stamps, poses):
    true_stamps, true_poses = read_poses(recording / "groundtruth.txt")
    nearest = [int(np.argmin(abs(true_stamps - stamp))) for stamp in stamps]
    return rigid(np.array([p[:3, 3] for p in poses]), np.array([true_poses[i][:3, 3] for i in nearest]))


def by_trundle(args, scratch):
    """Vertices (map frame, m), milliseconds an image, and the folder of the run."""
    mesh = scratch / "trundle.ply"
    command = [args.trundle, "slam", args.recording, "--height", args.height, "--tilt", args.tilt]
    command += ["--out", scratch / "slam", "--record", "none", "--mesh", mesh, "--voxel", args.voxel]
    text = subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout
    row = re.search(r"surface, wall clock an image\s+([\d.]+) ms", text)
    memory = re.search(r"memory of the voxels\s+([\d.]+) MB", text)
    vertices = np.asarray(o3d.io.read_triangle_mesh(str(mesh)).vertices)
    return vertices, float(row[1]), float(memory[1]), scratch / "slam"


def by_open3d(args, stamps, poses):
    """The same by Open3D's scalable volume."""
    camera = tomllib.loads((args.recording / "camera.toml").read_text())
    intrinsic = o3d.camera.PinholeCameraIntrinsic(
        *(camera[name] for name in ("width", "height", "fx", "fy", "cx", "cy")))
    colors, depths = read_list(args.recording / "rgb.txt"), read_list(args.recording / "depth.txt")
    volume = o3d.pipelines.integration.ScalableTSDFVolume(
        voxel_length=args.voxel, sdf_trunc=TRUNCATION_VOXELS * args.voxel,
        color_type=o3d.pipelines.integration.TSDFVolumeColorType.RGB8)
    seconds, used = 0.0, used_frames(stamps, poses)
    for i in used:
        color = o3d.io.read_image(str(args.recording / colors[stamps[i]]))
        depth = np.asarray(o3d.io.read_image(str(args.recording / depths[stamps[i]]))).astype(np.float32)
        depth /= camera["depth_scale"]
        depth[(depth < MIN_DEPTH_M) | (depth > MAX_DEPTH_M)] = 0
        image = o3d.geometry.RGBDImage.create_from_color_and_depth(
            color, o3d.geometry.Image(depth), depth_scale=1.0, depth_trunc=MAX_DEPTH_M,
            convert_rgb_to_intensity=False)
        clock = time.perf_counter()
        volume.integrate(image, intrinsic, np.linalg.inv(poses[i]))
        seconds += time.perf_counter() - clock
    mesh = volume.extract_triangle_mesh()
    labels, counts, _ = mesh.cluster_connected_triangles()
    small = np.asarray(counts)[np.asarray(labels)] < 2 * MIN_PART_VERTICES
    mesh.remove_triangles_by_mask(small)
    mesh.remove_unreferenced_vertices()
    return np.asarray(mesh.vertices), 1e3 * seconds / len(used)


def errors(vertices, world, scene):
    points = vertices @ world[:3, :3].T + world[:3, 3]
    return scene.compute_distance(o3d.core.Tensor(points.astype(np.float32))).numpy()


def true_scene(path):
    loaded = trimesh.load(path, force="mesh", process=False)
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(np.asarray(loaded.vertices, np.float32), np.asarray(loaded.faces, np.uint32))
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--trundle", required=True)
    parser.add_argument("--voxel", type=float, default=0.02)
    parser.add_argument("--height", type=float, default=0.45)
    parser.add_argument("--tilt", type=float, default=8)
    parser.add_argument("--core", type=int)
    args = parser.parse_args()
    if args.core is not None:
        os.sched_setaffinity(0, {args.core})
    with tempfile.TemporaryDirectory() as scratch:
        vertices, milliseconds, memory, run = by_trundle(args, pathlib.Path(scratch))
        stamps, poses = read_poses(run / "trajectory.txt")
    peer_vertices, peer_milliseconds = by_open3d(args, stamps, poses)
    scene, world = true_scene(args.scene), world_from_map(args.recording, stamps, poses)
    print(f"{'':10} {'vertices':>9} {'median':>9} {'p95':>9} {'within 3 cm':>12} {'ms an image':>12}")
    for name, at, ms in (("trundle", vertices, milliseconds), ("Open3D", peer_vertices, peer_milliseconds)):
        off = errors(at, world, scene)
        print(f"{name:10} {len(at):9} {100 * np.median(off):6.2f} cm {100 * np.quantile(off, 0.95):6.2f} cm "
              f"{100 * np.mean(off < NEAR_M):10.2f} % {ms:12.1f}")
    print(f"memory of trundle's voxels: {memory:.0f} MB; Open3D {o3d.__version__}")


if __name__ == "__main__":
    main()
