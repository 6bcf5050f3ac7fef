"""Way-points of a closed drive through a map, for `trundle sim SCENE --follow`.

usage: routes.py MAP.yaml OUT.txt [--length 40] [--seed 1] [--clearance 0.35]

Draws places in the free space that is connected with the middle, visits them one after the other along paths that keep the
clearance, comes back to the first one, and goes on until the drive is long enough. The drive ends where it began, so that
it has a loop. Needs numpy. The first way-point is the start: pass it as --start.
"""
import argparse
import heapq
import math
import pathlib

import numpy as np


def read_map(yaml):
    """Free cells (row 0 at the lowest y), resolution (m), origin (m)."""
    fields = dict(line.split(":", 1) for line in yaml.read_text().splitlines() if ":" in line)
    data = (yaml.parent / fields["image"].strip()).read_bytes()
    header, offset = [], 0
    while len(header) < 4:
        end = data.index(b"\n", offset)
        line = data[offset:end].split(b"#")[0]
        header += line.split()
        offset = end + 1
    width, height = int(header[1]), int(header[2])
    pixels = np.frombuffer(data, np.uint8, width * height, offset).reshape(height, width)[::-1]
    origin = [float(v) for v in fields["origin"].strip(" []").split(",")][:2]
    return pixels > 250, float(fields["resolution"]), origin


def eroded(free, cells):
    """Free cells with nothing but free cells within `cells`."""
    out = np.pad(free, cells)
    result = np.ones_like(free)
    for dy in range(-cells, cells + 1):
        for dx in range(-cells, cells + 1):
            if dx * dx + dy * dy <= cells * cells:
                h, w = free.shape
                result &= out[cells + dy : cells + dy + h, cells + dx : cells + dx + w]
    return result


def shortest(free, start):
    """Steps to `start`: distance of every cell and the cell before it."""
    distance, before = {start: 0.0}, {}
    queue = [(0.0, start)]
    while queue:
        d, cell = heapq.heappop(queue)
        if d > distance[cell]:
            continue
        for dy in (-1, 0, 1):
            for dx in (-1, 0, 1):
                to = (cell[0] + dy, cell[1] + dx)
                if (dy or dx) and free[to] and free[cell[0], to[1]] and free[to[0], cell[1]]:
                    length = d + math.hypot(dy, dx)
                    if length < distance.get(to, math.inf):
                        distance[to], before[to] = length, cell
                        heapq.heappush(queue, (length, to))
    return distance, before


def sees(free, a, b):
    """Whether the straight line between two cells is free."""
    steps = 3 * max(abs(a[0] - b[0]), abs(a[1] - b[1])) + 1
    return all(free[round(a[0] + (b[0] - a[0]) * i / steps), round(a[1] + (b[1] - a[1]) * i / steps)] for i in range(steps + 1))


def corners(free, path):
    """The smallest number of cells of a path with a free line between successive ones, greedily."""
    kept, at = [path[0]], 0
    while at < len(path) - 1:
        to = next(j for j in range(len(path) - 1, at, -1) if j == at + 1 or sees(free, path[at], path[j]))
        kept.append(path[to])
        at = to
    return kept


def drive(free, length, rng):
    """Cells of the tour; `length` in cells."""
    cells = np.argwhere(free)
    middle = cells[np.argmin(np.linalg.norm(cells - np.array(free.shape) / 2, axis=1))]
    distance, _ = shortest(free, tuple(int(v) for v in middle))
    reach = sorted(distance)
    start = reach[rng.integers(len(reach))]
    tour, done, at = [start], 0.0, start
    while True:
        last = done >= length
        away, before = shortest(free, at)
        far = sorted(reach, key=lambda cell: away[cell])
        goal = start if last else far[rng.integers(len(far) // 3, len(far))]
        path = [goal]
        while path[-1] != at:
            path.append(before[path[-1]])
        tour += corners(free, path[::-1])[1:]
        done, at = done + away[goal], goal
        if last:
            return tour


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--length", type=float, default=40.0, help="m, at least")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--clearance", type=float, default=0.35, help="m")
    args = parser.parse_args()
    free, resolution, origin = read_map(args.map)
    wide = np.pad(eroded(free, math.ceil(args.clearance / resolution)), 1)
    tour = drive(wide, args.length / resolution, np.random.default_rng(args.seed))
    points = [(origin[0] + (x - 0.5) * resolution, origin[1] + (y - 0.5) * resolution) for y, x in tour]
    headings = [math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])) for a, b in zip(points, points[1:])]
    lines = [f"{x:.3f} {y:.3f} {h:.1f}" for (x, y), h in zip(points, headings + headings[:1])]
    args.out.write_text("\n".join(lines) + "\n")
    metres = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
    print(f"{args.out}: {len(points)} way-points, {metres:.1f} m, start {points[0][0]:.3f},{points[0][1]:.3f},{headings[0]:.1f}")


main()
