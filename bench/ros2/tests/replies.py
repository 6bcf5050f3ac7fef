"""Services of a node whose replies have more or less room: parameters, map, path. No robot is needed.

replies.py --trundle PATH. Exit 0: all checks hold.
"""
import argparse
import pathlib
import sys
import tempfile

from harness import Checks, Listener, Process
from nav2_msgs.srv import LoadMap
from nav_msgs.srv import GetMap
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters, SetParametersAtomically

# Longest wait for a reply, s.
LIMIT_S = 10
SPEED, PATIENCE = "limits.v_m_s", "mission_executor.patience_s"


class Caller(Listener):
    """Calls services of one node."""

    def __init__(self, node):
        super().__init__("replies")
        self.target, self.clients = node, {}

    def call(self, kind, name, request):
        """The answer; `None` if it does not come."""
        if name not in self.clients:
            self.clients[name] = self.node.create_client(kind, name)
            if not self.until(self.clients[name].service_is_ready, LIMIT_S):
                return None
            self.spin(0.3)
        return self.result(self.clients[name].call_async(request), LIMIT_S)

    def own(self, kind, name, request):
        return self.call(kind, f"{self.target}/{name}", request)


def double(name, value):
    return Parameter(name=name, value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value))


def lists(checks, caller):
    """Every parameter is found from the top by prefixes, each list in one reply."""
    names, prefixes, asked, lost = set(), [""], set(), []
    while prefixes:
        prefix = prefixes.pop()
        if prefix in asked:
            continue
        asked.add(prefix)
        answer = caller.own(ListParameters, "list_parameters", ListParameters.Request(prefixes=[prefix] if prefix else []))
        if answer is None:
            lost.append(prefix)
            continue
        names.update(answer.result.names)
        prefixes.extend(answer.result.prefixes)
    checks.check("every list_parameters is answered", not lost, f"{len(asked)} lists, lost {lost}")
    checks.check("prefixes lead to every parameter", len(names) > 250 and {SPEED, PATIENCE, "use_sim_time"} <= names, f"{len(names)} names")
    return sorted(names)


def values(checks, caller, names, trundle):
    """Values and descriptors arrive a few at a time; too many at once are answered empty, and later ones still arrive."""
    answer = caller.own(GetParameters, "get_parameters", GetParameters.Request(names=names[:10]))
    checks.check("get_parameters of ten", answer is not None and len(answer.values) == 10)
    answer = caller.own(GetParameters, "get_parameters", GetParameters.Request(names=names))
    checks.check("get_parameters of all is answered empty", answer is not None and not answer.values)
    answer = caller.own(DescribeParameters, "describe_parameters", DescribeParameters.Request(names=[SPEED, names[0]]))
    good = answer is not None and len(answer.descriptors) == 2 and not answer.descriptors[0].read_only
    checks.check("describe_parameters after it has range and meaning",
                 good and answer.descriptors[0].floating_point_range[0].from_value == 0.05 and answer.descriptors[1].description != "")
    checks.check("the log names the service", "get_parameters: a reply has" in trundle.log.read_text())


def settings(checks, caller, trundle):
    """What may change is set; a wrong type, a wrong value and what may not change are refused with the reason."""
    asked = [double(PATIENCE, 20.0), double(SPEED, 99.0), double("drive.wheel_radius_m", 0.1), double("no.such", 1.0),
             Parameter(name=SPEED, value=ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="fast"))]
    answer = caller.own(SetParameters, "set_parameters", SetParameters.Request(parameters=asked))
    results = [(r.successful, r.reason) for r in answer.results] if answer else []
    checks.check("one of five is set", [good for good, _ in results] == [True, False, False, False, False], str(results))
    checks.check("each refusal has a reason", all(good or reason for good, reason in results))
    said = trundle.log.read_text()
    checks.check("the log names service, parameter and cause", f"set_parameters: a parameter was not set: {SPEED} is 99, expected" in said)
    answer = caller.own(GetParameters, "get_parameters", GetParameters.Request(names=[PATIENCE]))
    checks.check("the new value is read", answer is not None and answer.values[0].double_value == 20.0)
    request = SetParametersAtomically.Request(parameters=[double(PATIENCE, 30.0), double(SPEED, 99.0)])
    answer = caller.own(SetParametersAtomically, "set_parameters_atomically", request)
    kept = caller.own(GetParameters, "get_parameters", GetParameters.Request(names=[PATIENCE]))
    checks.check("an atomic set with one wrong value sets none",
                 answer is not None and not answer.result.successful and kept.values[0].double_value == 20.0)


def maps(checks, caller):
    """Services of the map are answered before there is one."""
    answer = caller.call(GetMap, "map_server/map", GetMap.Request())
    checks.check("map_server/map is answered", answer is not None)
    answer = caller.call(LoadMap, "map_server/load_map", LoadMap.Request(map_url="/nowhere/map.yaml"))
    checks.check("load_map of a missing file has code 1", answer is not None and answer.result == LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trundle", required=True, type=pathlib.Path, help="binary with the feature ros2")
    parser.add_argument("--node", default="/trundle", help="name of trundle's node")
    options = parser.parse_args()
    checks, out = Checks("replies"), pathlib.Path(tempfile.mkdtemp(prefix="replies-"))
    trundle = Process("trundle", [options.trundle.resolve(), "ros2", "--wait", "300"], out)
    try:
        caller = Caller(options.node)
        names = lists(checks, caller)
        values(checks, caller, names, trundle)
        settings(checks, caller, trundle)
        maps(checks, caller)
    finally:
        trundle.end()
    print(f"logs: {out}")
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
