"""AprilTags: trundle-vision against OpenCV and the AprilTag library, on the same drawn images with known corners.

usage: tags.py --ours PROGRAM [--count 20] [--seed 1] [--keep FOLDER]

Each image shows 6 x 5 tags of tag36h11 through a known homography, 4 x 4 samples per pixel, with blur of 0.8 px and noise of 3 grey
values. Printed for each program: the fraction of the tags found, wrong ids, and the error of the corners. Prints `skipped` where the
packages opencv-python-headless, pupil-apriltags and numpy (PyPI) are absent.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

try:
    import cv2
    import numpy as np
    import pupil_apriltags
except ImportError as error:
    print(f"skipped: tags.py: {error}")
    sys.exit(0)

COLUMNS, ROWS, SIDE, GAP = 6, 5, 80, 24
WIDTH, HEIGHT, SAMPLES = 640, 480, 4
DICTIONARY = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)


def sheet():
    """The board, one pixel per unit, and the corners of each tag, units, pixel centres at whole numbers."""
    pitch = SIDE + GAP
    image = np.full((ROWS * pitch + GAP, COLUMNS * pitch + GAP), 215, np.uint8)
    corners = {}
    for tag in range(COLUMNS * ROWS):
        x, y = GAP + tag % COLUMNS * pitch, GAP + (ROWS - 1 - tag // COLUMNS) * pitch
        # OpenCV draws each tag turned by 180 degrees.
        drawn = np.rot90(cv2.aruco.generateImageMarker(DICTIONARY, tag, SIDE), 2)
        image[y : y + SIDE, x : x + SIDE] = np.where(drawn > 0, 215, 35)
        corners[tag] = np.array([[x, y], [x + SIDE, y], [x + SIDE, y + SIDE], [x, y + SIDE]], float) - 0.5
    return image, corners


def view(board, rng):
    """A homography from the sheet to the image."""
    height, width = board.shape
    box = np.array([[0, 0], [width, 0], [width, height], [0, height]], np.float32)
    angle, size = rng.uniform(0, 2 * np.pi), rng.uniform(0.42, 0.62)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    target = (box - box.mean(0)) * size @ turn.T * rng.uniform(0.8, 1.1, 2) + [WIDTH / 2, HEIGHT / 2]
    target += rng.uniform(-35, 35, (4, 2))
    return cv2.getPerspectiveTransform(box, target.astype(np.float32))


def draw(board, image_from_sheet, rng):
    fine = np.diag([SAMPLES, SAMPLES, 1.0]) @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])
    fine = np.array([[1, 0, -0.5], [0, 1, -0.5], [0, 0, 1]]) @ fine @ image_from_sheet
    size = (WIDTH * SAMPLES, HEIGHT * SAMPLES)
    large = cv2.warpPerspective(board, fine, size, flags=cv2.INTER_AREA, borderMode=cv2.BORDER_CONSTANT, borderValue=120)
    small = large.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES).mean((1, 3))
    noisy = cv2.GaussianBlur(small, (0, 0), 0.8) + rng.normal(0, 3, small.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


def by_opencv(paths, refinement):
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = refinement
    detector = cv2.aruco.ArucoDetector(DICTIONARY, parameters)
    for path in paths:
        corners, ids, _ = detector.detectMarkers(cv2.imread(path, cv2.IMREAD_GRAYSCALE))
        ids = [] if ids is None else ids.flatten()
        yield {int(i): np.roll(c[0], 2, axis=0) for i, c in zip(ids, corners)}


def by_apriltag(paths):
    detector = pupil_apriltags.Detector(families="tag36h11", quad_decimate=1.0)
    for path in paths:
        found = detector.detect(cv2.imread(path, cv2.IMREAD_GRAYSCALE))
        # Its corners run from the lower left against the clock, and the centre of a pixel is at a half.
        yield {tag.tag_id: tag.corners[[3, 2, 1, 0]] - 0.5 for tag in found}


def by_program(program, paths):
    text = subprocess.run([program, *paths], check=True, capture_output=True, text=True).stdout
    for part in text.split("image ")[1:]:
        rows = [row.split() for row in part.splitlines()[1:]]
        yield {int(row[0]): np.array(row[1:], float).reshape(4, 2) for row in rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ours", required=True)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="of the views and of the noise")
    parser.add_argument("--keep", type=pathlib.Path)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    board, corners = sheet()
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        paths, truths = [], []
        for i in range(args.count):
            image_from_sheet = view(board, rng)
            truth = {t: cv2.perspectiveTransform(c[None], image_from_sheet)[0] for t, c in corners.items()}
            inside = lambda c: (c > 5).all() and (c < [WIDTH - 6, HEIGHT - 6]).all()
            truths.append({t: c for t, c in truth.items() if inside(c)})
            paths.append(str(folder / f"{i:02}.png"))
            cv2.imwrite(paths[-1], draw(board, image_from_sheet, rng))
        programs = {
            "trundle": list(by_program(args.ours, paths)),
            "OpenCV subpixel": list(by_opencv(paths, cv2.aruco.CORNER_REFINE_SUBPIX)),
            "OpenCV contour": list(by_opencv(paths, cv2.aruco.CORNER_REFINE_CONTOUR)),
            "AprilTag": list(by_apriltag(paths)),
        }
    report(programs, truths)


def report(programs, truths):
    total = sum(map(len, truths))
    print(f"{len(truths)} images, {total} tags; OpenCV {cv2.__version__}")
    print(f"{'':18}{'found':>7}{'wrong':>7}{'rms px':>9}{'median px':>11}{'worst px':>10}")
    for name, images in programs.items():
        both = [(found[t], truth[t]) for found, truth in zip(images, truths) for t in truth if t in found]
        wrong = sum(t >= COLUMNS * ROWS for found in images for t in found)
        errors = np.concatenate([np.linalg.norm(a - b, axis=1) for a, b in both]) if both else np.array([np.nan])
        rms = np.sqrt((errors**2).mean())
        print(f"{name:18}{len(both) / total:7.3f}{wrong:7}{rms:9.3f}{np.median(errors):11.3f}{errors.max():10.3f}")


if __name__ == "__main__":
    main()
