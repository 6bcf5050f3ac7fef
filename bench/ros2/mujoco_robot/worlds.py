"""Worlds: a furnished flat, and the four corridors of [Hong24] with the measures of the scenes corridor-a to corridor-d of trundle-sim.

World frame: x and y on the floor, z up, metres. Poses are (x, y, yaw), yaw in radians.
"""
import math
from dataclasses import dataclass, field

import numpy as np

# Height of walls and ceiling, m.
CEILING_M = 2.5
# Thickness of walls, m.
WALL_M = 0.12
# Distance behind the first pose of a corridor's scenario at which the robot starts, m.
LOOKOUT_M = 1.5
# Names of the worlds.
NAMES = ["flat", "corridor-a", "corridor-b", "corridor-c", "corridor-d"]


@dataclass
class Box:
    """A cuboid: centre, size and turn around z, m and rad, with the kind of its texture. Solid: touched by the robot."""

    centre: tuple
    size: tuple
    kind: str
    yaw: float = 0.0
    solid: bool = True


@dataclass
class World:
    """What stands in the world, where the robot starts, and poses to drive to (world frame)."""

    name: str
    boxes: list = field(default_factory=list)
    start: tuple = (0.0, 0.0, 0.0)
    goals: list = field(default_factory=list)
    unreachable: tuple = (0.0, 0.0, 0.0)

    def block(self, x0, y0, x1, y1, z0, z1, kind, solid=True):
        """An upright box between two corners."""
        centre = ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)
        self.boxes.append(Box(centre, (abs(x1 - x0), abs(y1 - y0), z1 - z0), kind, solid=solid))

    def wall(self, x0, y0, x1, y1):
        self.block(x0, y0, x1, y1, 0, CEILING_M, "wallpaper")

    def room_shell(self, x0, y0, x1, y1):
        """Floor, ceiling and outer walls about a rectangle."""
        t = WALL_M
        self.block(x0 - t, y0 - t, x1 + t, y1 + t, -0.1, 0.0, "planks", solid=False)
        self.block(x0 - t, y0 - t, x1 + t, y1 + t, CEILING_M, CEILING_M + 0.1, "panels", solid=False)
        self.wall(x0 - t, y0 - t, x0, y1 + t)
        self.wall(x1, y0 - t, x1 + t, y1 + t)
        self.wall(x0, y0 - t, x1, y0)
        self.wall(x0, y1, x1, y1 + t)

    def table(self, x, y, length, width, height=0.74):
        """A table on four legs."""
        for dx in (-1, 1):
            for dy in (-1, 1):
                cx, cy = x + dx * (length / 2 - 0.05), y + dy * (width / 2 - 0.05)
                self.block(cx - 0.03, cy - 0.03, cx + 0.03, cy + 0.03, 0, height - 0.04, "wood")
        self.block(x - length / 2, y - width / 2, x + length / 2, y + width / 2, height - 0.04, height, "wood")

    def posters(self, rng, place, count, low, high, width=0.75, height=0.5):
        """Pictures along a wall: `place(s)` gives the centre and the yaw at s from 0 to 1."""
        for i in range(count):
            x, y, yaw = place(low + (high - low) * (i + 0.5) / count)
            z = float(rng.uniform(0.45, 1.25))
            self.boxes.append(Box((x, y, z), (width, 0.012, height), "poster", yaw, solid=False))


def flat(seed):
    """Living room, kitchen and bedroom, 8 x 6 m, three doors 1.0 m wide, so that the rooms form a loop."""
    rng = np.random.default_rng(1000 + seed)
    world = World("flat", start=(1.0, 1.1, 0.0), goals=[(3.6, 1.7, 0.0), (6.2, 1.9, math.pi / 2), (6.6, 4.0, math.pi)],
                  unreachable=(-2.0, 3.0, 0.0))
    world.room_shell(0, 0, 8, 6)
    half = WALL_M / 2
    for y0, y1 in ((0.0, 1.2), (2.2, 4.2), (5.2, 6.0)):
        world.wall(4.5 - half, y0, 4.5 + half, y1)
    for x0, x1 in ((4.5 + half, 5.9), (6.9, 8.0)):
        world.wall(x0, 3.2 - half, x1, 3.2 + half)
    furnish(world, rng)
    pictures(world, rng)
    return world


def furnish(world, rng):
    """Furniture, each piece up to 5 cm from its drawn place."""
    def moved(x0, y0, x1, y1, z1, kind):
        dx, dy = rng.uniform(-0.05, 0.05, 2)
        world.block(x0 + dx, y0 + dy, x1 + dx, y1 + dy, 0, z1, kind)

    moved(0.10, 2.6, 0.95, 4.5, 0.75, "cloth")       # sofa
    moved(1.9, 3.1, 2.5, 4.1, 0.42, "wood")          # low chest
    moved(1.0, 5.6, 2.9, 5.92, 1.9, "shelf")         # bookcase
    moved(3.95, 2.6, 4.35, 3.8, 0.5, "wood")         # sideboard
    moved(3.4, 0.08, 4.2, 0.5, 0.95, "shelf")        # shelf
    moved(7.35, 0.08, 7.92, 2.9, 0.9, "wood")        # kitchen counter
    moved(4.7, 0.08, 5.3, 0.65, 1.8, "wood")         # refrigerator
    world.table(5.35, 2.55, 0.9, 0.7)
    moved(7.0, 4.9, 7.9, 5.9, 0.55, "cloth")         # armchair
    moved(4.75, 3.4, 5.75, 3.95, 1.9, "wood")        # wardrobe
    moved(5.0, 5.35, 6.3, 5.9, 0.75, "wood")         # desk
    moved(7.55, 3.4, 7.9, 4.3, 1.2, "shelf")         # shelf


def pictures(world, rng):
    """Posters on the walls of the flat, 7 mm off the wall."""
    gap, half = 0.007, WALL_M / 2
    world.posters(rng, lambda s: (8 * s, gap, math.pi), 7, 0.05, 0.98)
    world.posters(rng, lambda s: (8 * s, 6 - gap, 0.0), 7, 0.03, 0.98)
    world.posters(rng, lambda s: (gap, 6 * s, math.pi / 2), 5, 0.02, 0.98)
    world.posters(rng, lambda s: (8 - gap, 6 * s, -math.pi / 2), 5, 0.02, 0.98)
    for side, yaw in ((-half - gap, -math.pi / 2), (half + gap, math.pi / 2)):
        world.posters(rng, lambda s, d=side, a=yaw: (4.5 + d, 2.2 + 2.0 * s, a), 2, 0.0, 1.0)
        world.posters(rng, lambda s, d=side, a=yaw: (4.5 + d, 1.2 * s, a), 1, 0.0, 1.0)
    for side, yaw in ((-half - gap, 0.0), (half + gap, math.pi)):
        world.posters(rng, lambda s, d=side, a=yaw: (4.55 + 1.3 * s, 3.2 + d, a), 1, 0.0, 1.0)
        world.posters(rng, lambda s, d=side, a=yaw: (6.9 + 1.1 * s, 3.2 + d, a), 1, 0.0, 1.0)


def corridor(name, seed):
    """A corridor 1.0 m wide and 6 m long along y, closed at both ends. The scenario: from a pose to one 0.38 m beside it, same heading.

    (a) free, (b) blocked in front, (c) blocked in front on the left, (d) blocked in front on the right, goal 0.5 m back. The paper gives
    the map; here the robot comes from LOOKOUT_M behind, as the camera measures nothing nearer than 0.5 m. Goals: the scenario's two poses.
    """
    rng = np.random.default_rng(2000 + seed)
    half, length, offset = 0.5, 3.0, 0.38
    back = 0.5 if name == "corridor-d" else 0.0
    poses = [(-offset / 2, 0.0, math.pi / 2), (offset / 2, -back, math.pi / 2)]
    world = World(name, start=(-offset / 2, -LOOKOUT_M, math.pi / 2), goals=poses, unreachable=(3.0, 0.0, 0.0))
    world.room_shell(-half, -length, half, length)
    ahead = 0.44 + float(rng.uniform(-0.02, 0.02))
    across = {"corridor-b": (-half, half), "corridor-c": (-half, -0.05), "corridor-d": (0.05, half)}.get(name)
    if across:
        world.block(across[0], ahead, across[1], ahead + 0.5, 0, 1.1, "wood")
    for side, yaw in ((-half + 0.007, math.pi / 2), (half - 0.007, -math.pi / 2)):
        world.posters(rng, lambda s, x=side, a=yaw: (x, -length + 2 * length * s, a), 7, 0.02, 0.98)
    for side, yaw in ((-length + 0.007, math.pi), (length - 0.007, 0.0)):
        world.posters(rng, lambda s, y=side, a=yaw: (0.0, y, a), 1, 0.0, 1.0)
    return world


def build(name, seed):
    """The world of that name. Raises ValueError with the known names."""
    if name == "flat":
        return flat(seed)
    if name in NAMES:
        return corridor(name, seed)
    raise ValueError(f"world '{name}' is unknown; known are {', '.join(NAMES)}")
