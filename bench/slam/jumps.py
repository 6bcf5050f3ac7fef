"""Whether the estimated pose of house runs ever left the true one, image by image.

usage: jumps.py DIR...

DIR is what `trundle experiment house --out DIR` wrote: `seed-N.csv` holds believed and true pose at every image. Prints of each seed how far
heading and position were off at most, at how many images the heading was off by more than 0.8 degrees, and how often the error of the
position changed by more than 3 cm from one image to the next.
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
