"""Save what the camera sees from a pose, to look at: python -m mujoco_robot.snapshot WORLD SEED X Y YAW_DEG OUT.png"""
import math
import sys
import time

import numpy as np
from PIL import Image

from . import simulation, worlds


def main(name, seed, x, y, yaw_deg, out):
    world = worlds.build(name, int(seed))
    world.start = (float(x), float(y), math.radians(float(yaw_deg)))
    robot = simulation.Simulation(world, int(seed))
    robot.read_camera()
    begin, wall = time.process_time(), time.perf_counter()
    for _ in range(20):
        color, depth = robot.read_camera()
    cpu = (time.process_time() - begin) / 20
    gray = np.repeat((np.clip(depth / 4500, 0, 1) * 255).astype(np.uint8)[..., None], 3, 2)
    Image.fromarray(np.hstack([color, gray])).save(out)
    print(f"{out}: {1000 * cpu:.1f} ms CPU, {1000 * (time.perf_counter() - wall) / 20:.1f} ms a pair; depth {depth.min()}..{depth.max()} mm")


if __name__ == "__main__":
    main(*sys.argv[1:])
