"""OpenCV's ORB descriptors of recorded images, for `trundle vocabulary train --descriptors`.

usage: orb_descriptors.py OUT DIR... [--stride 5]

A vocabulary fits the descriptors that it was trained on. ORB-SLAM3 compares the pairs of pixels of [Rublee11], as OpenCV does,
and trundle others: so ORB-SLAM3 gets a vocabulary trained on OpenCV's descriptors by trundle's trainer. Needs opencv-python-headless.
"""
import argparse
import pathlib

import cv2

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("out", type=pathlib.Path)
parser.add_argument("folders", type=pathlib.Path, nargs="+", metavar="DIR")
parser.add_argument("--stride", type=int, default=5, help="use every N-th image")
args = parser.parse_args()
args.out.mkdir(parents=True, exist_ok=True)
orb = cv2.ORB_create(nfeatures=1000, scaleFactor=1.2, nlevels=8, fastThreshold=7)
for folder in args.folders:
    lines = [line.split() for line in (folder / "rgb.txt").read_text().splitlines() if not line.startswith("#")]
    for i, (_, name) in enumerate(lines[:: args.stride]):
        _, descriptors = orb.detectAndCompute(cv2.imread(str(folder / name), cv2.IMREAD_GRAYSCALE), None)
        if descriptors is not None:
            (args.out / f"{folder.name}-{i:05}.orb").write_bytes(descriptors.tobytes())
