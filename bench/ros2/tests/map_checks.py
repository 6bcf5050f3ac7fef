"""Parts of user.py about maps: late joiner, save_map, load_map, clearing of costmaps."""
import pathlib

import numpy as np
import rclpy
import yaml
from nav2_msgs.srv import ClearCostmapAroundRobot, ClearEntireCostmap, LoadMap, SaveMap
from nav2_user import LATCHED, NEAR, outcome, status
from nav_msgs.msg import OccupancyGrid
from PIL import Image
from rclpy.executors import SingleThreadedExecutor

# Thresholds of a saved map, as in Nav2's map_saver.
FREE, OCCUPIED = 0.25, 0.65
# Grey values of a trinary map: occupied, free, unknown.
GREY = {"occupied": 0, "free": 254, "unknown": 205}


def cells(message):
    """Cells of a map, row 0 at the origin."""
    return np.array(message.data, np.int16).reshape(message.info.height, message.info.width)


def geometry(message):
    """What places the cells."""
    info, origin = message.info, message.info.origin.position
    return info.width, info.height, round(info.resolution, 6), round(origin.x, 6), round(origin.y, 6)


def stamp_of(message):
    return message.header.stamp.sec, message.header.stamp.nanosec


def late_joiner(checks, user, options):
    """A participant of its own that comes late gets the map that the early one has, cell for cell."""
    if not checks.check("an early listener has the map", user.until(lambda: "map" in user.last, 60)):
        return
    context = rclpy.context.Context()
    rclpy.init(context=context)
    node, found = rclpy.create_node("late_joiner", context=context), []
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    node.create_subscription(OccupancyGrid, "map", found.append, LATCHED)
    for _ in range(200):
        executor.spin_once(timeout_sec=0.05)
        user.executor.spin_once(timeout_sec=0.0)
        if found:
            break
    if checks.check("a late joiner gets the map", bool(found)):
        user.until(lambda: any(stamp_of(m) == stamp_of(found[0]) for m in user.kept["map"]), 10)
        same = [m for m in user.kept["map"] if stamp_of(m) == stamp_of(found[0])]
        equal = bool(same) and geometry(same[-1]) == geometry(found[0]) and np.array_equal(cells(same[-1]), cells(found[0]))
        checks.check("the late joiner's map equals the early one, cell for cell", equal, f"{geometry(found[0])}")
        checks.check("the map has free and occupied cells", {0, 100} <= set(np.unique(cells(found[0])).tolist())
                     or (cells(found[0]) > 65).any() and (cells(found[0]) == 0).any())
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown(context=context)


def trinary(message):
    """The picture that map_saver makes of a map: row 0 on top is the last row of the map."""
    values = cells(message)
    picture = np.full(values.shape, GREY["unknown"], np.uint8)
    picture[(values >= 0) & (values <= FREE * 100)] = GREY["free"]
    picture[values >= OCCUPIED * 100] = GREY["occupied"]
    return picture[::-1]


def save_map(checks, user, options):
    """The saved file equals the published map."""
    url = pathlib.Path(options.out).resolve() / "saved"
    request = SaveMap.Request(map_topic="map", map_url=str(url), image_format="pgm", map_mode="trinary",
                              free_thresh=FREE, occupied_thresh=OCCUPIED)
    before = len(user.kept.get("map", []))
    answer = user.call(SaveMap, "map_saver/save_map", request)
    user.wait_simulated(2.0)
    if not checks.check("save_map succeeds", answer is not None and answer.result):
        return
    described = yaml.safe_load(url.with_suffix(".yaml").read_text())
    picture = np.array(Image.open(url.parent / described["image"]))
    candidates = user.kept["map"][max(0, before - 2):]
    equal = [m for m in candidates if picture.shape == (m.info.height, m.info.width) and np.array_equal(picture, trinary(m))]
    checks.check("the saved picture equals a published map", bool(equal), f"{picture.shape}, {len(candidates)} maps compared")
    info = (equal or candidates)[-1].info
    placed = [described["resolution"], *described["origin"][:2]]
    wanted = [info.resolution, info.origin.position.x, info.origin.position.y]
    checks.check("resolution and origin are equal", np.allclose(placed, wanted, atol=1e-4), f"{placed}")


def load_map(checks, user, options):
    """The saved map can be loaded: its pose is unknown then, and after an initial pose it reaches a goal. A file that is not there has its code."""
    url = pathlib.Path(options.out).resolve() / "saved.yaml"
    if not url.exists():
        save_map(checks, user, options)
    answer = user.call(LoadMap, "map_server/load_map", LoadMap.Request(map_url=str(url)))
    checks.check("load_map of the saved map succeeds", answer is not None and answer.result == LoadMap.Response.RESULT_SUCCESS,
                 f"result {answer.result if answer else None}")
    user.wait_simulated(0.5)
    variance = user.last["amcl_pose"].pose.covariance[0] if "amcl_pose" in user.last else None
    checks.check("the pose in the loaded map is unknown", variance is not None and variance > 1, f"variance of x {variance} m2")
    user.set_pose(user.truth())
    result = user.go(NEAR).wait(180)
    distance, angle = user.error_to(NEAR)
    checks.check("on the loaded map the robot reaches a goal after initialpose", status(result) == "SUCCEEDED" and distance < 0.05 and angle < 3,
                 f"{outcome(result)}, {100 * distance:.1f} cm, {angle:.2f} deg")
    answer = user.call(LoadMap, "map_server/load_map", LoadMap.Request(map_url="/nowhere/map.yaml"))
    code = LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST
    checks.check("load_map of a missing file says so", answer is not None and answer.result == code, f"result {answer.result if answer else None}")


def clear_costmaps(checks, user, options):
    """Clearing is answered, and the map is still there."""
    for costmap in ("global_costmap", "local_costmap"):
        answer = user.call(ClearEntireCostmap, f"{costmap}/clear_entirely_{costmap}", ClearEntireCostmap.Request())
        checks.check(f"clear_entirely_{costmap} is answered", answer is not None)
        request = ClearCostmapAroundRobot.Request(reset_distance=1.0)
        answer = user.call(ClearCostmapAroundRobot, f"{costmap}/clear_around_{costmap}", request)
        checks.check(f"clear_around_{costmap} is answered", answer is not None)
