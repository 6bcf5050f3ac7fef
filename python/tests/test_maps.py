"""Grids, maps of scans, plans and manoeuvres."""

import numpy as np
import pytest
import trundle

WALLS = [np.array([[-2.0, y], [2.0, y]]) for y in (-0.45, 0.45)]
BOX = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)]


@pytest.mark.parametrize("image", ["pgm", "png"])
def test_grids_survive_arrays_and_files(tmp_path, image):
    cells = np.random.default_rng(1).choice(np.array([-1, 0, 100], np.int8), (7, 9))
    grid = trundle.OccupancyGrid(cells, 0.05, origin=(-1.5, 0.25))
    np.testing.assert_array_equal(grid.cells, cells)
    assert grid.shape == (7, 9) and grid.origin == (-1.5, 0.25)
    assert grid.at((-1.5 + 0.05 * 2.5, 0.25 + 0.05 * 3.5)) == cells[3, 2]
    assert grid.at((100, 100)) == -1
    grid.save(tmp_path / "map.yaml", image=image)
    assert (tmp_path / f"map.{image}").exists()
    assert trundle.OccupancyGrid.load(tmp_path / "map.yaml") == grid


def test_a_map_of_nav2_is_read():
    from conftest import shared

    found = sorted(shared("nav").rglob("*.yaml"))
    grids = []
    for file in found:
        try:
            grids.append(trundle.OccupancyGrid.load(file))
        except ValueError:
            continue  # no map but another kind of file
    assert len(grids) > 2 and sum((grid.cells == 100).any() for grid in grids) > 2


def test_scans_make_a_map(wall_scan):
    mapper = trundle.GridMapper(0.05)
    for _ in range(4):
        hits, free, ignored = mapper.insert((0, 0, 0), wall_scan)
        assert hits > 0 and free > 0 and ignored == 0
    grid = mapper.grid()
    assert [grid.at(p) for p in [(2.01, 0.01), (1.51, 0.01), (2.51, 0.01)]] == [100, 0, -1]
    assert mapper.probabilities().shape == grid.shape
    assert mapper.probability_at((2.01, 0.01)) > 0.9 and mapper.probability_at((50, 0)) == 0.5


def test_ranges_are_those_of_ros():
    ranges = np.array([1.0, np.inf, np.nan, -np.inf, 12.0])
    scan = trundle.Scan(1.5, ranges, -0.2, 0.1, range_max=10.0)
    np.testing.assert_array_equal(scan.ranges, [1.0, np.inf, np.nan, np.nan, np.inf])
    np.testing.assert_allclose(scan.angles, [-0.2, -0.1, 0.0, 0.1, 0.2], atol=1e-12)
    assert scan.points().shape == (1, 2) and len(scan) == 5
    with pytest.raises(ValueError, match="beam 1 is -1 m"):
        trundle.Scan(0, np.array([1.0, -1.0]), 0, 0.1, range_max=10)


def test_the_particle_filter_maps_a_drive():
    simulator = trundle.Simulator("room", 1, camera=None, laser="urg-04lx")
    mapper, states, pose = trundle.ParticleMapper(seed=1), [], np.zeros(3)
    for event in simulator.step([0.2, 0.1], 3.0):
        if isinstance(event, trundle.Truth):
            pose = event.pose
        elif isinstance(event, trundle.Scan):
            states.append(mapper.update(pose, event))
    mapper.finish()
    assert "processed" in states and mapper.trajectory().shape[1] == 4
    assert (mapper.grid().cells == 100).sum() > 50


def test_a_laser_log_is_read():
    from conftest import shared

    logs = [file for file in sorted(shared("laser").rglob("*")) if file.suffix in {".log", ".clf", ".gz"}]
    entries = trundle.read_laser_log(logs[0])
    odometry, scan = entries[0]
    assert odometry.shape == (3,) and len(scan) > 10 and len(entries) > 10


def test_a_plan_goes_around_the_wall(room):
    plan = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0), 0.17)
    assert plan["found"] and plan["outcome"] == "found" and plan["length"] > 2.0
    assert plan["waypoints"].shape[1] == 2 and plan["poses"].shape == (len(plan["time"]), 3)
    np.testing.assert_allclose(plan["poses"][-1], [2.5, 0.4, 0], atol=1e-6)
    assert np.all(np.diff(plan["time"]) >= 0) and plan["time"][-1] == plan["duration"]
    assert plan["twists"].shape == (len(plan["time"]), 2)
    for x, y, _ in plan["poses"]:
        assert room.at((x, y)) == 0
    again = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0), 0.17)
    np.testing.assert_array_equal(plan["poses"], again["poses"])


def test_what_cannot_be_planned_is_a_value(room):
    keys = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0), 0.17).keys()
    in_wall = trundle.plan(room, (0.5, 0.4, 0), (1.6, 0.4, 0), 0.17)
    assert not in_wall["found"] and in_wall["outcome"] == "goal_in_obstacle"
    assert in_wall["poses"].shape == (0, 3) and in_wall.keys() == keys
    closed = trundle.OccupancyGrid.from_ascii(0.25, "\n".join(["#" * 14] + ["#.....#......#"] * 6 + ["#" * 14]))
    blocked = trundle.plan(closed, (0.8, 0.9, 0), (2.5, 0.9, 0), 0.17)
    assert blocked["outcome"] == "blocked" and blocked["nearest"].shape == (2,)
    assert "no path" in blocked["message"]


def test_a_manoeuvre_in_a_corridor():
    found = trundle.dock(WALLS, (0, -0.1, 0), (0, 0.1, 0), BOX)
    assert found["found"] and found["bound"] <= found["duration"] + 1e-9
    assert set(found["kinds"]) <= {"turn", "drive"} and len(found["kinds"]) == len(found["amounts"])
    np.testing.assert_allclose(found["poses"][[0, -1]], [[0, -0.1, 0], [0, 0.1, 0]], atol=1e-6)
    assert found["poses"].shape == (len(found["kinds"]) + 1, 3)


def test_what_admits_no_manoeuvre_is_a_value():
    found = trundle.dock(WALLS, (0, -0.1, 0), (0, 0.4, 0), BOX)
    assert found["outcome"] == "refused" and "overlaps" in found["message"] and not found["found"]
    far = trundle.dock(WALLS, (0, 0, 0), (100, 0, 0), BOX)
    assert far["outcome"] == "refused" and "100.00 m away" in far["message"]
    grid = trundle.OccupancyGrid(np.zeros((60, 60), np.int8), 0.05)
    on_map = trundle.dock(grid, (1, 1, 0), (1.2, 1.1, 0))
    assert on_map["found"], on_map["message"]
    assert "off the map" in trundle.dock(grid, (1, 1, 0), (-1, 1, 0))["message"]


def test_settings_of_a_robot_file(tmp_path, room):
    file = tmp_path / "robot.toml"
    file.write_text("footprint_radius_m = 0.3\n")
    config = trundle.RobotConfig(file)
    assert config.footprint == 0.3
    assert "footprint_radius_m" in config.to_toml()
    assert trundle.RobotConfig(None, ["footprint_radius_m=0.2"]).footprint == 0.2
    wide = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0), config=config)
    slim = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0), 0.1)
    assert wide["length"] != slim["length"]
    with pytest.raises(ValueError, match="no_such_key"):
        trundle.RobotConfig(None, ["no_such_key=1"])
    with pytest.raises(FileNotFoundError):
        trundle.RobotConfig(tmp_path / "none.toml")
