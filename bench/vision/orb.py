"""ORB: trundle-vision against OpenCV and kornia-imgproc, on the same images and the same core, in one run.

usage: orb.py --ours PROGRAM --kornia PROGRAM [--images FOLDER] [--count 10] [--repeats 20] [--rounds 3] [--core 0]

Each image is seen twice, through two known homographies, with noise of 2 grey values in either view. Each program extracts
1000 features (8 levels, factor 1.2, FAST 20 and where it can 7) from both views, the programs taking turns, each on one thread.
Printed for each: the median of all times; the median over the images of the least time of each, which a busy machine disturbs
less, and its ratio to ours; the mean number of features; and how well the views of a pair agree: mutual nearest neighbours of the
descriptors, how many of them are within 2 px of the truth, which share that is, and the median error of those.
"""
import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import cv2
import numpy as np

SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared/data/tum_fr1_rpy_400/rgb"


def homography(size, degrees, scale, tilt):
    """Turns and magnifies around the middle of an image, and tilts it."""
    width, height = size
    middle = np.array([[1, 0, -(width - 1) / 2], [0, 1, -(height - 1) / 2], [0, 0, 1]])
    turn = np.eye(3)
    turn[:2] = cv2.getRotationMatrix2D((0, 0), degrees, scale)
    perspective = np.array([[1, 0, 0], [0, 1, 0], [tilt, 0, 1]])
    return np.linalg.inv(middle) @ perspective @ turn @ middle


def views(image, rng):
    """Two views of an image, and the homography from the first to the second."""
    size = image.shape[1::-1]
    forth = homography(size, rng.uniform(3, 12), rng.uniform(1.0, 1.15), rng.uniform(-2e-4, 2e-4))
    back = homography(size, -rng.uniform(3, 12), rng.uniform(1.0, 1.15), rng.uniform(-2e-4, 2e-4))
    seen = [cv2.warpPerspective(image, h, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT) for h in (forth, back)]
    noisy = [np.clip(np.rint(v + rng.normal(0, 2, v.shape)), 0, 255).astype(np.uint8) for v in seen]
    return noisy, back @ np.linalg.inv(forth)


def by_opencv(paths, repeats):
    """Times (ms), positions and descriptors of each image by OpenCV."""
    cv2.setNumThreads(1)
    orb = cv2.ORB_create(nfeatures=1000, scaleFactor=1.2, nlevels=8, fastThreshold=20)
    for path in paths:
        image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
        orb.detectAndCompute(image, None)
        times = []
        for _ in range(repeats):
            start = time.perf_counter()
            keypoints, descriptors = orb.detectAndCompute(image, None)
            times.append(1e3 * (time.perf_counter() - start))
        yield times, np.array([k.pt for k in keypoints]), descriptors


def by_program(program, paths, repeats):
    """The same by a program that prints them."""
    environment = dict(os.environ, RAYON_NUM_THREADS="1")
    command = [program, str(repeats), *paths]
    text = subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout
    for part in text.split("image ")[1:]:
        head, *rows = part.splitlines()
        words = [row.split() for row in rows]
        descriptors = np.array([list(bytes.fromhex(w[2])) for w in words], np.uint8)
        yield [float(ms) for ms in head.split()[1:]], np.array([[float(w[0]), float(w[1])] for w in words]), descriptors


def agreement(first, second, second_from_first):
    """Number of mutual matches, and the errors (px) of all of them."""
    (_, xy_a, a), (_, xy_b, b) = first, second
    matches = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True).match(a, b)
    expected = cv2.perspectiveTransform(xy_a.reshape(-1, 1, 2).astype(float), second_from_first).reshape(-1, 2)
    errors = [np.linalg.norm(expected[m.queryIdx] - xy_b[m.trainIdx]) for m in matches]
    return len(matches), np.array(errors)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ours", required=True)
    parser.add_argument("--kornia", required=True)
    parser.add_argument("--images", type=pathlib.Path, default=SHARED)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--core", type=int, default=0)
    args = parser.parse_args()
    os.sched_setaffinity(0, {args.core})
    files = sorted(p for p in args.images.iterdir() if p.suffix in (".png", ".jpg"))
    files = files[:: max(1, len(files) // args.count)][: args.count]
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        paths, truths = [], []
        for i, file in enumerate(files):
            pair, truth = views(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), rng)
            truths.append(truth)
            for j, view in enumerate(pair):
                paths.append(f"{folder}/{i}_{j}.png")
                cv2.imwrite(paths[-1], view)
        programs = {
            "trundle": lambda: by_program(args.ours, paths, args.repeats),
            f"OpenCV {cv2.__version__}": lambda: by_opencv(paths, args.repeats),
            "kornia-imgproc": lambda: by_program(args.kornia, paths, args.repeats),
        }
        runs = {name: [] for name in programs}
        for _ in range(args.rounds):
            for name, run in programs.items():
                runs[name].append(list(run()))
    report(runs, truths)


def report(runs, truths):
    load = os.getloadavg()[0]
    print(f"{len(truths)} images, two views each; load {load:.1f}")
    print(f"{'':16}{'median ms':>10}{'least ms':>9}{'ratio':>7}{'features':>10}{'mutual':>8}{'right':>7}{'share':>7}{'error px':>10}")
    ours = None
    for name, rounds in runs.items():
        by_image = [[ms for times, _, _ in seen for ms in times] for seen in zip(*rounds)]
        median = statistics.median(ms for times in by_image for ms in times)
        least = statistics.median(min(times) for times in by_image)
        ours = ours or least
        run = rounds[0]
        agreed = [agreement(run[2 * i], run[2 * i + 1], truth) for i, truth in enumerate(truths)]
        mutual = sum(n for n, _ in agreed)
        errors = np.concatenate([e for _, e in agreed])
        right = errors[errors < 2]
        features = sum(len(image[1]) for image in run) / len(run)
        print(
            f"{name:16}{median:10.2f}{least:9.2f}{least / ours:7.2f}{features:10.0f}{mutual / len(truths):8.0f}"
            f"{len(right) / len(truths):7.0f}{len(right) / mutual:7.3f}{np.median(right):10.3f}"
        )


if __name__ == "__main__":
    main()
