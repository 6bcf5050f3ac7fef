"""The map of a laser log with raw odometry, by a particle filter.

python 02_map_a_laser_log.py [LOG]; without a log, a simulated drive. Writes map.yaml and map.png.
"""

import sys

import numpy as np

import trundle


def simulated_drive() -> list[tuple[np.ndarray, trundle.Scan]]:
    """Scans of a drive of 10 s with the true pose in place of odometry."""
    simulator = trundle.Simulator("room", seed=1, camera=None, laser="urg-04lx")
    pose, entries = np.zeros(3), []
    for event in simulator.step([0.2, 0.3], duration=10.0):
        if isinstance(event, trundle.Truth):
            pose = event.pose
        elif isinstance(event, trundle.Scan):
            entries.append((pose, event))
    return entries


if __name__ == "__main__":
    log = trundle.read_laser_log(sys.argv[1]) if len(sys.argv) > 1 else simulated_drive()
    mapper = trundle.ParticleMapper(seed=1)
    for odometry, scan in log:
        mapper.update(odometry, scan)
    mapper.finish()
    grid = mapper.grid()
    grid.save("map.yaml", image="png")
    x, y, theta = mapper.pose
    print(f"{len(log)} scans; the robot ends at ({x:.2f}, {y:.2f}) m, {np.degrees(theta):.1f} deg")
    print(f"{(grid.cells == 100).sum()} occupied cells in map.png")
    assert (grid.cells == 100).sum() > 50, "walls are in the map"
