"""A path with timing on a map, and a manoeuvre in a tight place.

python 03_plan_on_a_map.py [MAP.yaml X,Y,DEG X,Y,DEG]; without a map, one of text.
"""

import sys

import numpy as np

import trundle

ROOM = """\
............
............
......#.....
......#.....
......#.....
......#....."""


def pose(text: str) -> tuple[float, float, float]:
    """A pose of 'x,y,degrees'."""
    x, y, degrees = map(float, text.split(","))
    return x, y, np.radians(degrees)


def plan(grid: trundle.OccupancyGrid, start: tuple[float, float, float], goal: tuple[float, float, float]) -> None:
    """Plans for a round robot and prints its pose at each second."""
    found = trundle.plan(grid, start, goal, footprint=0.17)
    print(found["message"])
    if not found["found"]:
        return
    for second in range(int(found["duration"]) + 1):
        row = np.searchsorted(found["time"], second)
        (x, y, theta), (v, omega) = found["poses"][row], found["twists"][row]
        print(f"{second:3d} s ({x:.2f}, {y:.2f}) m {np.degrees(theta):6.1f} deg, {v:.2f} m/s {omega:.2f} rad/s")
    assert np.allclose(found["poses"][-1][:2], goal[:2], atol=1e-6)


def settle() -> None:
    """Moves a robot of 0.6 x 0.4 m by 20 cm sideways in a corridor of 0.9 m."""
    walls = [np.array([[-2.0, y], [2.0, y]]) for y in (-0.45, 0.45)]
    corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)]
    found = trundle.dock(walls, start=(0, -0.1, 0), goal=(0, 0.1, 0), footprint=corners)
    print(found["message"])
    for kind, amount in zip(found["kinds"], found["amounts"], strict=True):
        print(f"{kind:5s} {amount:7.3f} {'rad' if kind == 'turn' else 'm'}")
    assert found["found"]


if __name__ == "__main__":
    if len(sys.argv) > 1:
        plan(trundle.OccupancyGrid.load(sys.argv[1]), pose(sys.argv[2]), pose(sys.argv[3]))
    else:
        plan(trundle.OccupancyGrid.from_ascii(0.25, ROOM), (0.5, 0.4, 0.0), (2.5, 0.4, 0.0))
    settle()
