"""Error of the estimated pose in house runs at every image.

usage: jumps.py DIR...

DIR is the folder of `trundle experiment house --out DIR`: `seed-N.csv` holds the estimated and the true pose at every image. Prints for each
seed the largest errors of heading and position, the number of images with a heading error above 0.8 degrees, and the number of changes of
the position error by more than 3 cm between two images.
"""
import csv
import math
import pathlib
import sys


def off(row):
    """Error of x and y, cm, and of the heading, degrees."""
    _, x, y, theta, true_x, true_y, true_theta = row
    turn = (theta - true_theta + math.pi) % (2 * math.pi) - math.pi
    return 100 * (x - true_x), 100 * (y - true_y), math.degrees(turn)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for folder in map(pathlib.Path, sys.argv[1:]):
        print(folder)
        for file in sorted(folder.glob("seed-*.csv"), key=lambda path: int(path.stem.split("-")[1])):
            rows = [[float(value) for value in row] for row in list(csv.reader(file.open()))[1:]]
            errors = [off(row) for row in rows]
            turns = [abs(error[2]) for error in errors]
            jumps = sum(math.dist(a[:2], b[:2]) > 3 for a, b in zip(errors, errors[1:]))
            far = max(math.hypot(*error[:2]) for error in errors)
            turned = sum(turn > 0.8 for turn in turns)
            print(f"{file.stem}: {max(turns):.2f} deg, {far:.1f} cm at most; {turned} images beyond 0.8 deg, {jumps} jumps")


if __name__ == "__main__":
    main()
