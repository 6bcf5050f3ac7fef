"""Degraded copies of a TUM RGB-D folder: blur, noise, lower rate, gaps, brightness, other sizes, wrong intrinsics, moving photos.

`CASES` maps the name of a case to a function of (frames, camera, random numbers) that returns the degraded frames and camera. The same
folder and case give the same bytes. Needs numpy and opencv-python-headless.
"""
import dataclasses
import pathlib

import cv2
import numpy as np

# Intrinsics of TUM's freiburg1 colour camera: sequences without a camera file of their own.
FREIBURG1 = {
    "fx": 517.3, "fy": 516.5, "cx": 318.6, "cy": 255.3,
    "k1": 0.2624, "k2": -0.9531, "p1": -0.0054, "p2": 0.0026, "k3": 1.1633,
    "width": 640, "height": 480, "fps": 30.0, "depth_units_per_metre": 5000.0,
    # Time from the first to the last row [s] [Ringaby11]; ORB-SLAM3 has no such setting.
    "readout": 0.026,
}
LENS = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
# Distance of a pasted photo [m]: nearer than the scene behind it, as that of a person who passes.
PHOTO_DEPTH_M = 1.5
# A photo crosses the image for 3 s of every 10 s.
PHOTO_PERIOD_S, PHOTO_CROSSING_S = 10.0, 3.0


@dataclasses.dataclass
class Frame:
    """One pair of images, with the stamps as written."""

    color_stamp: str
    depth_stamp: str
    color: np.ndarray  # rows x columns x 3, BGR
    depth: np.ndarray  # rows x columns, 16 bit, 0 where unknown

    @property
    def time(self):
        return float(self.color_stamp)


def read_rows(path):
    """Words of each line that is no comment."""
    return [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]


def read_frames(folder, limit_s=0.02):
    """Each colour image with the depth image nearest in time, within `limit_s`."""
    depth = read_rows(folder / "depth.txt")
    times = np.array([float(stamp) for stamp, _ in depth])
    for stamp, name in read_rows(folder / "rgb.txt"):
        nearest = int(np.argmin(np.abs(times - float(stamp))))
        if abs(times[nearest] - float(stamp)) <= limit_s:
            color = cv2.imread(str(folder / name), cv2.IMREAD_COLOR)
            values = cv2.imread(str(folder / depth[nearest][1]), cv2.IMREAD_UNCHANGED)
            yield Frame(stamp, depth[nearest][0], color, values)


def settings(camera):
    """The camera as a settings file of ORB-SLAM3."""
    # A number without a decimal point is refused.
    lens = "".join(f"Camera1.{key}: {float(camera[key])!r}\n" for key in LENS)
    return (
        '%YAML:1.0\n---\nFile.version: "1.0"\nCamera.type: "PinHole"\n' + lens
        + f"Camera.width: {camera['width']}\nCamera.height: {camera['height']}\nCamera.fps: {camera['fps']:.0f}\nCamera.RGB: 1\n"
        + f"Stereo.ThDepth: 40.0\nStereo.b: 0.07732\nRGBD.DepthMapFactor: {camera['depth_units_per_metre']}\n"
        + "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
        + "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n"
        + "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1.0\nViewer.GraphLineWidth: 0.9\nViewer.PointSize: 2.0\n"
        + "Viewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3.0\nViewer.ViewpointX: 0.0\nViewer.ViewpointY: -0.7\n"
        + "Viewer.ViewpointZ: -1.8\nViewer.ViewpointF: 500.0\n"
    )


def camera_file(camera):
    """The camera as trundle's camera.toml."""
    names = [("depth_scale", "depth_units_per_metre"), *((key, key) for key in ("width", "height", "readout", *LENS))]
    return "".join(f"{name} = {camera[key]!r}\n" for name, key in names if camera[key] is not None)


def write(folder, source, frames, camera):
    """Writes a TUM folder; the ground truth is that of `source`."""
    for part in ("rgb", "depth"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    lists = {"rgb.txt": [], "depth.txt": []}
    for frame in frames:
        color, depth = f"rgb/{frame.color_stamp}.jpg", f"depth/{frame.depth_stamp}.png"
        cv2.imwrite(str(folder / color), frame.color, [cv2.IMWRITE_JPEG_QUALITY, 95])
        cv2.imwrite(str(folder / depth), frame.depth, [cv2.IMWRITE_PNG_COMPRESSION, 1])
        lists["rgb.txt"].append(f"{frame.color_stamp} {color}\n")
        lists["depth.txt"].append(f"{frame.depth_stamp} {depth}\n")
    for name, lines in lists.items():
        (folder / name).write_text("".join(lines))
    (folder / "groundtruth.txt").write_bytes((source / "groundtruth.txt").read_bytes())
    (folder / "orb_slam.yaml").write_text(settings(camera))
    (folder / "camera.toml").write_text(camera_file(camera))


def each(change):
    """A case that changes every frame by `change(frame, random)`, and not the camera."""
    return lambda frames, camera, random: ((change(frame, random) for frame in frames), camera)


def with_color(function):
    """A change of the colour image alone."""
    return lambda frame, random: dataclasses.replace(frame, color=function(frame.color, random))


def every(step):
    """Every `step`-th frame: a lower rate."""
    def case(frames, camera, _):
        kept = (frame for number, frame in enumerate(frames) if number % step == 0)
        return kept, camera | {"fps": camera["fps"] / step}
    return case


def gap(length_s, at_s=4.0):
    """No frames for `length_s`, from `at_s` after the first one."""
    def kept(frames):
        start = None
        for frame in frames:
            start = frame.time if start is None else start
            if not at_s <= frame.time - start < at_s + length_s:
                yield frame
    return lambda frames, camera, _: (kept(frames), camera)


def blur(pixels):
    """Blur along the rows, as by a turn about the vertical axis during the exposure."""
    kernel = np.full((1, pixels), 1 / pixels, np.float32)
    return each(with_color(lambda color, _: cv2.filter2D(color, -1, kernel)))


def noise(deviation):
    """White noise of each pixel, `deviation` of 255."""
    def noisy(color, random):
        return np.clip(color + random.normal(0, deviation, color.shape), 0, 255).astype(np.uint8)
    return each(with_color(noisy))


def brightness_steps(factor, period_s=1.0):
    """Every other `period_s` is darker by `factor`, as by a lamp or an automatic exposure."""
    def stepped(frame, _):
        is_dark = int(frame.time / period_s) % 2 == 1
        return dataclasses.replace(frame, color=(frame.color * factor).astype(np.uint8)) if is_dark else frame
    return each(stepped)


def without_depth(share, block=32):
    """Depth is missing in blocks of `block` pixels, other ones in each image."""
    def holes(frame, random):
        rows, columns = (-(-size // block) for size in frame.depth.shape)
        lost = random.random((rows, columns)) < share
        lost = np.kron(lost, np.ones((block, block), bool))[: frame.depth.shape[0], : frame.depth.shape[1]]
        return dataclasses.replace(frame, depth=np.where(lost, 0, frame.depth).astype(np.uint16))
    return each(holes)


def upright(frames, camera, _):
    """The camera turned by a quarter turn clockwise about its axis. Its rows become columns, so that no readout time by rows is right."""
    turned = camera | {
        "fx": camera["fy"], "fy": camera["fx"], "cx": camera["height"] - 1 - camera["cy"], "cy": camera["cx"],
        "p1": camera["p2"], "p2": -camera["p1"], "width": camera["height"], "height": camera["width"],
        "readout": None,
    }
    turn = cv2.ROTATE_90_CLOCKWISE
    frames = (dataclasses.replace(f, color=cv2.rotate(f.color, turn), depth=cv2.rotate(f.depth, turn)) for f in frames)
    return frames, turned


def enlarged(width, height):
    """Images of `width` columns, interpolated, and the middle `height` rows of them."""
    def case(frames, camera, _):
        factor = width / camera["width"]
        size = (width, round(camera["height"] * factor))
        top = (size[1] - height) // 2
        larger = camera | {
            "fx": camera["fx"] * factor, "fy": camera["fy"] * factor, "cx": (camera["cx"] + 0.5) * factor - 0.5,
            "cy": (camera["cy"] + 0.5) * factor - 0.5 - top, "width": width, "height": height,
            "readout": camera["readout"] * height / size[1],
        }
        def change(frame):
            color = cv2.resize(frame.color, size, interpolation=cv2.INTER_CUBIC)[top : top + height]
            depth = cv2.resize(frame.depth, size, interpolation=cv2.INTER_NEAREST)[top : top + height]
            return dataclasses.replace(frame, color=color, depth=depth)
        return map(change, frames), larger
    return case


def wrong_focal_length(factor):
    """The camera file has another focal length than the camera."""
    return lambda frames, camera, _: (frames, camera | {"fx": camera["fx"] * factor, "fy": camera["fy"] * factor})


def unknown_readout(frames, camera, _):
    """The camera file does not have the readout time."""
    return frames, camera | {"readout": None}


def photo(share):
    """A photo over `share` of the image crosses it, colour and depth."""
    def case(frames, camera, random):
        side = np.sqrt(share)
        rows, columns = round(camera["height"] * side), round(camera["width"] * side)
        texture = cv2.resize(random.integers(0, 256, (rows // 8, columns // 8, 3), np.uint8), (columns, rows), interpolation=cv2.INTER_CUBIC)
        top = (camera["height"] - rows) // 2
        units = round(PHOTO_DEPTH_M * camera["depth_units_per_metre"])
        def paste(frame):
            phase = (frame.time % PHOTO_PERIOD_S) / PHOTO_CROSSING_S
            if phase >= 1:
                return frame
            left = round(phase * (camera["width"] + columns)) - columns
            first, last = max(left, 0), min(left + columns, camera["width"])
            color, depth = frame.color.copy(), frame.depth.copy()
            color[top : top + rows, first:last] = texture[:, first - left : last - left]
            depth[top : top + rows, first:last] = units
            return dataclasses.replace(frame, color=color, depth=depth)
        return map(paste, frames), camera
    return case


CASES = {
    "unchanged": lambda frames, camera, _: (frames, camera),
    "15 Hz": every(2),
    "10 Hz": every(3),
    "5 Hz": every(6),
    "no images for 1 s": gap(1.0),
    "no images for 2 s": gap(2.0),
    "blur of 7 px": blur(7),
    "blur of 15 px": blur(15),
    "blur of 31 px": blur(31),
    "noise of 10 of 255": noise(10),
    "noise of 25 of 255": noise(25),
    "brightness steps to 0.5": brightness_steps(0.5),
    "brightness steps to 0.25": brightness_steps(0.25),
    "half the depth missing": without_depth(0.5),
    "0.8 of the depth missing": without_depth(0.8),
    "upright": upright,
    "1280 x 720": enlarged(1280, 720),
    "1280 x 960": enlarged(1280, 960),
    "focal length 2 % too large": wrong_focal_length(1.02),
    "focal length 5 % too large": wrong_focal_length(1.05),
    "focal length 5 % too small": wrong_focal_length(0.95),
    "readout time unknown": unknown_readout,
    "photo over 10 % of the image": photo(0.10),
    "photo over 20 % of the image": photo(0.20),
    "photo over 35 % of the image": photo(0.35),
}


def make(name, source, folder):
    """Writes the case `name` of the TUM folder `source` into `folder`."""
    random = np.random.default_rng(list(CASES).index(name))
    frames, camera = CASES[name](read_frames(source), dict(FREIBURG1), random)
    write(pathlib.Path(folder), source, frames, camera)
