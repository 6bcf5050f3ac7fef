"""A user of Nav2's interfaces in rclpy: what a robot's owner writes, with nothing of trundle in it."""
import math

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from harness import Listener, compose, planar, relative, seconds
from nav2_msgs.action import (BackUp, ComputePathToPose, DockRobot, DriveOnHeading, FollowPath, FollowWaypoints,
                              NavigateThroughPoses, NavigateToPose, Spin, UndockRobot)
from nav2_msgs.srv import SetInitialPose
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from std_msgs.msg import UInt32
from std_srvs.srv import Trigger

# Names of the actions, as Nav2 gives them.
ACTIONS = {"navigate_to_pose": NavigateToPose, "navigate_through_poses": NavigateThroughPoses, "follow_waypoints": FollowWaypoints,
           "compute_path_to_pose": ComputePathToPose, "follow_path": FollowPath, "spin": Spin, "backup": BackUp,
           "drive_on_heading": DriveOnHeading, "dock_robot": DockRobot, "undock_robot": UndockRobot}
# Places of the flat, world frame: near the start, and far enough to be stopped on the way.
NEAR, FAR = (2.2, 1.1, 0.0), (3.6, 1.7, 0.0)
# A map is sent to those who come late.
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
STATUS = {value: name.removeprefix("STATUS_") for name, value in vars(GoalStatus).items() if name.startswith("STATUS_")}
STATUS |= {getattr(GoalStatus, f"STATUS_{n}"): n for n in ("SUCCEEDED", "CANCELED", "ABORTED", "EXECUTING", "ACCEPTED", "CANCELING")}


class Goal:
    """One goal of an action: its handle, feedback so far, its result."""

    def __init__(self, user, client, message):
        self.user, self.feedback, self.done = user, [], None
        self.handle = user.result(client.send_goal_async(message, lambda f: self.feedback.append(f.feedback)), 30)
        if self.accepted:
            self.done = self.handle.get_result_async()

    @property
    def accepted(self):
        return self.handle is not None and self.handle.accepted

    def wait(self, seconds_wall=300):
        """The result with its status, `None` if it does not come."""
        return self.user.result(self.done, seconds_wall) if self.done else None

    def cancel(self):
        """The answer to the request to cancel."""
        return self.user.result(self.handle.cancel_goal_async(), 30)


class User(Listener):
    """Action clients, services, and the truth of the simulated robot for the score alone."""

    def __init__(self, name="nav2_user"):
        super().__init__(name)
        self.clients = {name: ActionClient(self.node, kind, name) for name, kind in ACTIONS.items()}
        self.listen(PoseStamped, "ground_truth")
        self.listen(Odometry, "odom")
        self.listen(UInt32, "contacts")
        self.listen(Clock, "/clock", qos_profile_sensor_data)
        self.listen(OccupancyGrid, "map", LATCHED, keep=True)
        self.listen(PoseWithCovarianceStamped, "amcl_pose")
        self.start = None

    def now(self):
        """Simulated time, s."""
        return seconds(self.last["/clock"].clock) if "/clock" in self.last else 0.0

    def wait_until_active(self, limit=120):
        """Nav2 is up: the lifecycle manager says so, and the truth of the start is kept."""
        if not self.until(lambda: {"ground_truth", "odom", "/clock"} <= set(self.last), limit):
            return False
        self.start = planar(self.last["ground_truth"].pose)
        client = self.node.create_client(Trigger, "lifecycle_manager_navigation/is_active")
        if not self.until(client.service_is_ready, limit):
            return False

        def active():
            answer = self.result(client.call_async(Trigger.Request()), 5)
            return answer is not None and answer.success
        return self.until(active, limit) and self.until(lambda: self.clients["navigate_to_pose"].server_is_ready(), limit)

    def call(self, kind, name, request, limit=30):
        """The answer of a service; `None` if it does not come."""
        client = self.node.create_client(kind, name)
        try:
            if not self.until(client.service_is_ready, limit):
                return None
            return self.result(client.call_async(request), limit)
        finally:
            self.node.destroy_client(client)

    def set_pose(self, place):
        """The answer of set_initial_pose at a place of the world frame, known to 20 cm and 8 deg."""
        request, here = SetInitialPose.Request(), self.map_pose(place)
        request.pose.header, request.pose.pose.pose = here.header, here.pose
        request.pose.pose.covariance[[0, 7, 35]] = (0.04, 0.04, 0.02)
        return self.call(SetInitialPose, "set_initial_pose", request)

    def map_pose(self, world_pose, frame="map"):
        """A pose of the world as a message: the map begins at the robot's start."""
        x, y, heading = relative(self.start, world_pose)
        message = PoseStamped()
        message.header.frame_id, message.header.stamp = frame, self.last["/clock"].clock
        message.pose.position.x, message.pose.position.y = x, y
        message.pose.orientation.z, message.pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)
        return message

    def world_pose(self, message):
        """A message's pose in the map as a pose of the world."""
        return compose(self.start, planar(message.pose))

    def send(self, action, **fields):
        """Send a goal: `send("spin", target_yaw=1.0)`."""
        return Goal(self, self.clients[action], ACTIONS[action].Goal(**fields))

    def go(self, world_pose):
        return self.send("navigate_to_pose", pose=self.map_pose(world_pose))

    def truth(self):
        return planar(self.last["ground_truth"].pose)

    def speed(self):
        twist = self.last["odom"].twist.twist
        return max(abs(twist.linear.x), abs(twist.angular.z) * 0.115)

    def contacts(self):
        return self.last["contacts"].data if "contacts" in self.last else 0

    def wait_simulated(self, duration, limit=120):
        end = self.now() + duration
        return self.until(lambda: self.now() >= end, limit)

    def error_to(self, world_pose):
        """Distance, m, and angle, deg, of the truth from a pose."""
        x, y, heading = relative(world_pose, self.truth())
        return math.hypot(x, y), abs(math.degrees(heading))


def outcome(result):
    """Status and error code of a result, as text."""
    if result is None:
        return "no result"
    code = getattr(result.result, "error_code", "")
    text = getattr(result.result, "error_msg", "")
    return f"{STATUS.get(result.status, result.status)}, code {code}{', ' if text else ''}{text}"


def status(result):
    return None if result is None else STATUS.get(result.status)
