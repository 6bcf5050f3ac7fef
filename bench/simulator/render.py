#!/usr/bin/env python3
"""Times trundle's RGB-D renderer and ray caster against MuJoCo's CPU renderer and Embree, and checks its depth.

    python3 -m venv /work/target/sim-venv && /work/target/sim-venv/bin/pip install mujoco embreex trimesh numpy pillow
    cargo build --release -p trundle-sim --example render_bench
    /work/target/sim-venv/bin/python bench/simulator/render.py [--trundle PROGRAM] [--house small_house.glb] [--frames 10]

MuJoCo draws by software: OSMesa (apt-get install libosmesa6) or Mesa's EGL. All programs take turns in one run, on the same
rays: 512 x 424 pixels, 70.6 x 60 deg. CPU time is that of all threads of the program; it suffers less from a busy machine
than the clock does. What is missing is named and skipped.
"""
import argparse
import json
import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

WIDTH, HEIGHT = 512, 424
FIELD = (70.6, 60.0)
ROOT = Path(__file__).resolve().parents[2]
# x, y (m), heading (rad), pitch (rad, down) of a camera 0.6 m above the floor: rooms of small_house, and of a box room.
HOUSE = [(0, 0, 0, 0), (6, 1, 1, 0.1), (-6, 1, 3, 0.1), (-3, -3, 0.5, 0.2), (3.5, 3.5, -2, 0.1), (7.5, -3, 2, 0.1), (-1, 3, -1, 0.15)]
ROOM = [(0.3, 0.2, 0.0, 0.1), (-1.5, 1.0, 2.0, 0.1), (1.5, -1.5, 4.0, 0.2)]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--trundle", default=os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target")) + "/release/examples/render_bench")
    options.add_argument("--house", default=str(ROOT / "../shared/data/scenes/small_house.glb"))
    options.add_argument("--frames", type=int, default=10)
    options = options.parse_args()
    if not Path(options.trundle).exists():
        sys.exit(f"{options.trundle} is not there: cargo build --release -p trundle-sim --example render_bench")
    import numpy as np

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scenes = [("box room", box_room(folder), ROOM)]
        if Path(options.house).exists():
            scenes.append(("small_house", Path(options.house), HOUSE))
        else:
            print(f"skipped: {options.house} is not there")
        for name, glb, poses in scenes:
            parts = read_glb(glb)
            ours = run_trundle(options.trundle, glb, poses, folder, options.frames)
            rows.append((name, "trundle RGB-D and noise", ours["frame_wall_ms"], ours["frame_cpu_ms"]))
            rows.append((name, "trundle RGB-D", ours["render_wall_ms"], ours["render_cpu_ms"]))
            mujoco = attempt("MuJoCo", lambda: run_mujoco(parts, poses, folder, options.frames))
            if mujoco:
                rows.append((name, "MuJoCo RGB + depth", *mujoco))
            rows.append((name, "trundle image, one thread, ns a ray", None, ours["render_one_thread_ns"]))
            rows.append((name, "trundle cast (f64), one thread, ns a ray", None, ours["cast_ns"]))
            embree = attempt("embreex", lambda: run_embree(np, parts, poses, folder, options.frames))
            if embree:
                rows.append((name, "Embree, one thread, ns a ray", None, embree["ns"]))
                print(f"{name}: {100 * embree['agree']:.4f} % of {embree['pixels']} pixels within 1 mm of Embree")
    print(f"\n{'scene':12} {'what':42} {'wall ms':>9} {'CPU ms or ns':>13}")
    for scene, what, wall, cpu in rows:
        print(f"{scene:12} {what:42} {'' if wall is None else f'{wall:9.2f}':>9} {cpu:13.2f}")


def attempt(name, run):
    try:
        return run()
    except Exception as error:  # whatever a peer lacks here
        print(f"skipped {name}: {type(error).__name__}: {error}")
        return None


def run_trundle(program, glb, poses, folder, frames):
    text = "\n".join(" ".join(map(str, pose)) for pose in poses)
    (folder / "poses.txt").write_text(text)
    command = [program, str(glb), str(folder / "poses.txt"), str(folder), str(frames)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def rotation(np, heading, pitch):
    """Columns: the camera's right, down and forward axes in the world."""
    c, s, cp, sp = np.cos(heading), np.sin(heading), np.cos(pitch), np.sin(pitch)
    right, forward = np.array([s, -c, 0.0]), np.array([c * cp, s * cp, -sp])
    return np.stack([right, np.cross(forward, right), forward], axis=1)


def run_embree(np, parts, poses, folder, frames):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    scene = rtcore_scene.EmbreeScene()
    for positions, _, triangles, _ in parts:
        TriangleMesh(scene, np.ascontiguousarray(positions, np.float32), np.ascontiguousarray(triangles, np.int32))
    fx, fy = (n / 2 / np.tan(np.radians(f) / 2) for n, f in zip((WIDTH, HEIGHT), FIELD))
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    rays = np.stack([(u - (WIDTH - 1) / 2) / fx, (v - (HEIGHT - 1) / 2) / fy, np.ones_like(u)], -1).reshape(-1, 3)
    best, agree, pixels = [], 0, 0
    for i, (x, y, heading, pitch) in enumerate(poses):
        directions = np.ascontiguousarray(rays @ rotation(np, heading, pitch).T, np.float32)
        origins = np.ascontiguousarray(np.broadcast_to([x, y, 0.6], directions.shape), np.float32)
        times = []
        for _ in range(frames):
            begun = time.process_time()
            scene.run(origins, directions, query="INTERSECT")
            times.append(time.process_time() - begun)
        best.append(min(times))
        hit = scene.run(origins, directions, output=1)
        depth = np.where(hit["geomID"] >= 0, hit["tfar"], 0.0)
        ours = np.fromfile(folder / f"depth{i}.f32", np.float32)
        agree += int((abs(depth - ours) < 1e-3).sum())
        pixels += ours.size
    return {"ns": 1e9 * sum(best) / len(best) / len(rays), "agree": agree / pixels, "pixels": pixels}


def run_mujoco(parts, poses, folder, frames):
    """Mean over the poses of the best wall and CPU time of a colour and a depth image, ms; no shadows, no reflections."""
    mujoco = import_mujoco()
    import numpy as np
    from PIL import Image

    assets, geoms = [], []
    for i, (positions, uvs, triangles, (color, image)) in enumerate(parts):
        with open(folder / f"part{i}.obj", "w") as out:
            out.writelines(f"v {x} {y} {z}\n" for x, y, z in positions)
            out.writelines(f"vt {u} {1 - v}\n" for u, v in uvs)
            out.writelines("f " + " ".join(f"{k + 1}/{k + 1}" for k in corners) + "\n" for corners in triangles)
        if image is not None:
            Image.fromarray(image).save(folder / f"part{i}.png")
            assets.append(f'<texture name="t{i}" type="2d" file="part{i}.png"/><material name="m{i}" texture="t{i}"/>')
        else:
            assets.append(f'<material name="m{i}" rgba="{color[0]} {color[1]} {color[2]} 1"/>')
        assets.append(f'<mesh name="p{i}" file="part{i}.obj" inertia="shell"/>')
        geoms.append(f'<geom type="mesh" mesh="p{i}" material="m{i}" contype="0" conaffinity="0"/>')
    for i, (x, y, heading, pitch) in enumerate(poses):
        axes = rotation(np, heading, pitch)
        right, up = axes[:, 0], -axes[:, 1]
        geoms.append(f'<camera name="c{i}" pos="{x} {y} 0.6" fovy="{FIELD[1]}" xyaxes="{" ".join(map(str, [*right, *up]))}"/>')
    xml = f"""<mujoco><compiler meshdir="{folder}" texturedir="{folder}"/>
      <visual><global offwidth="{WIDTH}" offheight="{HEIGHT}"/><quality shadowsize="0" offsamples="0"/><map znear="0.001"/></visual>
      <asset>{"".join(assets)}</asset>
      <worldbody><light directional="true" castshadow="false" dir="-0.3 -0.4 -0.8"/>{"".join(geoms)}</worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = mujoco.Renderer(model, HEIGHT, WIDTH)
    walls, cpus = [], []
    for i in range(len(poses)):
        renderer.update_scene(data, camera=f"c{i}")
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION, mujoco.mjtRndFlag.mjRND_SKYBOX):
            renderer.scene.flags[flag] = False
        wall, cpu = [], []
        for _ in range(frames):
            begun, worked = time.perf_counter(), time.process_time()
            color = renderer.render()
            renderer.enable_depth_rendering()
            depth = renderer.render()
            renderer.disable_depth_rendering()
            wall.append(time.perf_counter() - begun)
            cpu.append(time.process_time() - worked)
        if color.max() == 0 or not np.isfinite(depth).all():
            raise RuntimeError("the picture is black")
        ours = np.fromfile(folder / f"depth{i}.f32", np.float32).reshape(HEIGHT, WIDTH)
        near = (abs(depth - ours) < 0.02 * np.maximum(ours, 0.1))[ours > 0].mean()
        print(f"MuJoCo sees the same from pose {i}: {100 * near:.1f} % of the depths within 2 %")
        walls.append(min(wall))
        cpus.append(min(cpu))
    renderer.close()
    return 1e3 * sum(walls) / len(walls), 1e3 * sum(cpus) / len(cpus)


def import_mujoco():
    if "MUJOCO_GL" not in os.environ:
        import ctypes.util

        os.environ["MUJOCO_GL"] = "osmesa" if ctypes.util.find_library("OSMesa") else "egl"
    os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
    os.environ.setdefault("MESA_LOADER_DRIVER_OVERRIDE", "swrast")
    import mujoco

    print(f"MuJoCo {mujoco.__version__} draws by {os.environ['MUJOCO_GL']}")
    return mujoco


def read_glb(path):
    """(positions, uvs, triangles, (colour, image)) of every primitive; nodes must not move their meshes."""
    import io

    import numpy as np
    from PIL import Image

    data = Path(path).read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    gltf = json.loads(data[20 : 20 + length])
    start = 28 + length
    if any(key in node for node in gltf["nodes"] for key in ("matrix", "translation", "rotation", "scale")):
        raise RuntimeError(f"{path}: a node moves its mesh")

    def bytes_of(view):
        view = gltf["bufferViews"][view]
        first = start + view.get("byteOffset", 0)
        return data[first : first + view["byteLength"]]

    def numbers(index):
        accessor = gltf["accessors"][index]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "u1"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        first = accessor.get("byteOffset", 0)
        return np.frombuffer(bytes_of(accessor["bufferView"]), kind, accessor["count"] * width, first).reshape(-1, width)

    def look(material):
        surface = gltf["materials"][material].get("pbrMetallicRoughness", {})
        color = surface.get("baseColorFactor", [1.0, 1.0, 1.0, 1.0])[:3]
        if "baseColorTexture" not in surface:
            return color, None
        image = gltf["images"][gltf["textures"][surface["baseColorTexture"]["index"]]["source"]]
        return color, np.asarray(Image.open(io.BytesIO(bytes_of(image["bufferView"]))).convert("RGB"))

    parts = []
    for mesh in gltf["meshes"]:
        for primitive in mesh["primitives"]:
            positions = numbers(primitive["attributes"]["POSITION"])
            uv = primitive["attributes"].get("TEXCOORD_0")
            uvs = numbers(uv) if uv is not None else np.zeros((len(positions), 2), np.float32)
            triangles = numbers(primitive["indices"]).reshape(-1, 3)
            parts.append((positions, uvs, triangles, look(primitive["material"])))
    return parts


def box_room(folder):
    """A room of 6 x 6 x 2.5 m with ten boxes, every face a textured rectangle, as a GLB."""
    import io

    import numpy as np
    from PIL import Image

    chance = np.random.default_rng(1)
    boxes = [((0, 0, -0.05), (6, 6, 0.1)), ((0, 0, 2.55), (6, 6, 0.1))]
    boxes += [((3.05, 0, 1.25), (0.1, 6, 2.5)), ((-3.05, 0, 1.25), (0.1, 6, 2.5)), ((0, 3.05, 1.25), (6, 0.1, 2.5)), ((0, -3.05, 1.25), (6, 0.1, 2.5))]
    for i in range(10):
        angle, size = 0.628 * i, chance.uniform(0.3, 0.8, 3)
        boxes.append(((2.3 * np.cos(angle), 2.3 * np.sin(angle), size[2] / 2), tuple(size)))
    positions, uvs, triangles = [], [], []
    for center, size in boxes:
        for axis in range(3):
            for sign in (-1, 1):
                first = len(positions)
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                    corner = np.array(center, float)
                    corner[axis] += sign * size[axis] / 2
                    corner[(axis + 1) % 3] += a * size[(axis + 1) % 3] / 2
                    corner[(axis + 2) % 3] += b * size[(axis + 2) % 3] / 2
                    positions.append(corner)
                    uvs.append(((a + 1) / 2 * size[(axis + 1) % 3], (b + 1) / 2 * size[(axis + 2) % 3]))
                # Counter-clockwise from outside: MuJoCo does not draw backs.
                turn = (lambda a, b, c: (a, b, c)) if sign > 0 else (lambda a, b, c: (a, c, b))
                triangles += [turn(first, first + 1, first + 2), turn(first, first + 2, first + 3)]
    image = io.BytesIO()
    Image.fromarray(chance.integers(0, 255, (256, 256, 3), np.uint8)).resize((512, 512)).save(image, "PNG")
    chunks = [np.asarray(positions, "<f4").tobytes(), np.asarray(uvs, "<f4").tobytes(), np.asarray(triangles, "<u4").tobytes(), image.getvalue()]
    views, offset = [], 0
    for i, chunk in enumerate(chunks):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(chunk)})
        chunks[i] = chunk + b"\0" * (-len(chunk) % 4)
        offset += len(chunks[i])
    accessor = lambda view, kind, count, type: {"bufferView": view, "componentType": kind, "count": count, "type": type}
    points = np.asarray(positions, "<f4")
    place = accessor(0, 5126, len(positions), "VEC3") | {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
    gltf = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [place, accessor(1, 5126, len(uvs), "VEC2"), accessor(2, 5125, 3 * len(triangles), "SCALAR")],
        "bufferViews": views, "buffers": [{"byteLength": offset}],
    }
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(chunks)
    path = folder / "room.glb"
    header = struct.pack("<4sII", b"glTF", 2, 12 + 16 + len(text) + len(body))
    path.write_bytes(header + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body)
    return path


if __name__ == "__main__":
    main()
