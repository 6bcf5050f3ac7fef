"""Parts of user.py about the node: parameters, transforms, lifecycle states."""
import math

from harness import compose, seconds, yaw
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from tf2_msgs.msg import TFMessage

# Largest gap between transforms, s of their stamps: odometry comes at 50 Hz, map -> odom at 10 Hz or more.
GAPS_S = {("odom", "base_link"): 0.1, ("map", "odom"): 0.3}
# Largest step of the robot in the map between two transforms of odom -> base_link, m: a correction of the map is smaller.
STEP_M = 0.3
# Simulated time for which transforms are watched, s.
WATCH_S = 30.0
NUMBERS = {ParameterType.PARAMETER_DOUBLE: "double_value", ParameterType.PARAMETER_INTEGER: "integer_value"}


class TransformWatch:
    """Collects TF for WATCH_S of simulated time from its start on, while other parts drive the robot."""

    def __init__(self, user):
        self.user, self.found, self.begin = user, {pair: [] for pair in GAPS_S}, user.now()
        # No message is lost while a part does not spin.
        user.node.create_subscription(TFMessage, "/tf", self.take, 1000)

    def is_over(self):
        return self.user.now() > self.begin + WATCH_S

    def take(self, message):
        for t in message.transforms if not self.is_over() else []:
            self.found.get((t.header.frame_id.lstrip("/"), t.child_frame_id.lstrip("/")), []).append(t)


def transforms(checks, user, options):
    """30 s of TF without a gap, and no jump of the robot in the map, while it drives: since the start of the program."""
    user.until(options.watch.is_over, 10 * WATCH_S)
    found = options.watch.found
    for pair, limit in GAPS_S.items():
        times = [seconds(t.header.stamp) for t in found[pair]]
        gaps = [b - a for a, b in zip(times, times[1:])]
        good = len(times) > 2 and times[-1] - times[0] > WATCH_S - 2 and max(gaps) <= limit and min(gaps) >= 0
        checks.check(f"{pair[0]} -> {pair[1]} for 30 s without a gap over {limit} s", good,
                     f"{len(times)} transforms, largest gap {max(gaps, default=math.inf):.3f} s, least {min(gaps, default=math.inf):.3f} s")
    checks.check("the robot does not jump in the map", largest_step(found) < STEP_M, f"{largest_step(found):.3f} m")


def pose(transform):
    return transform.transform.translation.x, transform.transform.translation.y, yaw(transform.transform.rotation)


def largest_step(found):
    """Largest distance between robot poses in the map that follow each other."""
    corrections, step, before = found["map", "odom"], 0.0, None
    for motion in found["odom", "base_link"]:
        known = [c for c in corrections if seconds(c.header.stamp) <= seconds(motion.header.stamp) + 0.3]
        if known:
            here = compose(pose(known[-1]), pose(motion))
            step, before = max(step, math.dist(here[:2], (before or here)[:2])), here
    return step


# Values and descriptors that are asked for at once: a reply has little room.
AT_ONCE = 4


def parameter_names(user, node):
    """All names: a list that has no room for them names prefixes, which are asked for in turn."""
    names, prefixes, asked = set(), [""], set()
    while prefixes:
        prefix = prefixes.pop()
        if prefix not in asked:
            asked.add(prefix)
            request = ListParameters.Request(prefixes=[prefix] if prefix else [])
            answer = user.call(ListParameters, f"{node}/list_parameters", request)
            names.update(answer.result.names if answer else [])
            prefixes.extend(answer.result.prefixes if answer else [])
    return sorted(names)


def in_parts(user, kind, service, names, field):
    """The answers for all names, asked for a few at a time by one client, and one by one where a reply had no room for them."""
    client = user.node.create_client(kind, service)

    def ask(part):
        answer = user.result(client.call_async(kind.Request(names=part)), 30)
        return list(getattr(answer, field)) if answer else []
    try:
        if not user.until(client.service_is_ready, 30):
            return []
        found = []
        for i in range(0, len(names), AT_ONCE):
            part = names[i:i + AT_ONCE]
            found += ask(part) or [value for name in part for value in ask([name])]
        return found
    finally:
        user.node.destroy_client(client)


def parameters(checks, user, options):
    """All settings can be read and described; a changeable one keeps its range and its type."""
    names = parameter_names(user, options.node)
    if not checks.check("parameters are listed", len(names) > 20, f"{len(names)} names"):
        return
    values = in_parts(user, GetParameters, f"{options.node}/get_parameters", names, "values")
    unset = [n for n, v in zip(names, values) if v.type == ParameterType.PARAMETER_NOT_SET]
    checks.check("every parameter has a value or is optional", len(values) == len(names), f"{len(values)} of {len(names)}, not set: {unset}")
    described = in_parts(user, DescribeParameters, f"{options.node}/describe_parameters", names, "descriptors")
    texts = sum(bool(d.description) for d in described)
    checks.check("every parameter is described", texts == len(names), f"{texts} of {len(names)}")
    missing = user.call(GetParameters, f"{options.node}/get_parameters", GetParameters.Request(names=["no.such.parameter"]))
    checks.check("an unknown name is answered as not set", missing is not None and all(v.type == 0 for v in missing.values))
    if len(values) == len(described) == len(names):
        set_parameters(checks, user, options, described, values)


def setting(user, options, name, value):
    """The answer to setting one parameter: (successful, reason)."""
    answer = user.call(SetParameters, f"{options.node}/set_parameters", SetParameters.Request(parameters=[Parameter(name=name, value=value)]))
    return (answer.results[0].successful, answer.results[0].reason) if answer and answer.results else (None, "no answer")


def set_parameters(checks, user, options, descriptors, values):
    changeable = [(d, v) for d, v in zip(descriptors, values)
                  if not d.read_only and v.type in NUMBERS and (d.floating_point_range or d.integer_range)]
    fixed = [(d, v) for d, v in zip(descriptors, values) if d.read_only and v.type in NUMBERS]
    if not checks.check("a number with a range can be changed while running", bool(changeable)):
        return
    descriptor, value = changeable[0]
    limits = (descriptor.floating_point_range or descriptor.integer_range)[0]
    field = NUMBERS[value.type]
    beyond = ParameterValue(type=value.type, **{field: type(getattr(value, field))(limits.to_value + abs(limits.to_value) + 1)})
    good, reason = setting(user, options, descriptor.name, beyond)
    checks.check(f"{descriptor.name} beyond its range is refused with a reason", good is False and bool(reason), reason)
    good, reason = setting(user, options, descriptor.name, ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="fast"))
    checks.check(f"{descriptor.name} as text is refused with a reason", good is False and bool(reason), reason)
    good, reason = setting(user, options, descriptor.name, value)
    checks.check(f"{descriptor.name} takes its own value", good is True, reason)
    if fixed:
        good, reason = setting(user, options, fixed[0][0].name, fixed[0][1])
        checks.check(f"read-only {fixed[0][0].name} is refused with a reason", good is False and bool(reason), reason)


def lifecycle_states(checks, user, options):
    """Tools that ask for the states of Nav2's servers hear that they are active."""
    for server in ("bt_navigator", "planner_server", "controller_server", "amcl"):
        answer = user.call(GetState, f"{server}/get_state", GetState.Request(), 15)
        state = answer.current_state if answer else None
        checks.check(f"{server} is active", state is not None and state.id == State.PRIMARY_STATE_ACTIVE, state.label if state else "no answer")
