"""Data of the tests: real recordings if present beside the project, and simulated ones."""

import pathlib

import numpy as np
import pytest
import trundle

ROOT = pathlib.Path(__file__).resolve().parents[2]


def shared(name):
    """A file or folder of the shared data. The test is skipped by name if it is absent."""
    found = ROOT.parent / "shared/data" / name
    return found if found.exists() else pytest.skip(f"{name} is absent")


@pytest.fixture(scope="session")
def tum_folder():
    return shared("tum_fr1_rpy_400")


@pytest.fixture(scope="session")
def images():
    """Eight images of a room from a robot that drives an arc."""
    simulator = trundle.Simulator("room", 1)
    found = []
    while len(found) < 8:
        found += [event for event in simulator.step([0.2, 0.1], 0.1) if isinstance(event, trundle.Rgbd)]
    return simulator, found


@pytest.fixture
def room():
    """12 x 6 cells of 0.25 m with a wall."""
    return trundle.OccupancyGrid.from_ascii(0.25, "\n".join(["............"] * 2 + ["......#....."] * 4))


@pytest.fixture
def wall_scan():
    """Ten beams that hit a wall 2 m ahead."""
    return trundle.Scan(0.0, np.full(10, 2.0), 0.0, 0.002, range_max=10.0)
