#!/usr/bin/env python3
"""An entry to the corridor benchmark: turn to the goal, drive, turn to its heading. It ignores the obstacles.

usage: corridor_bench --planner bench/docking/entry_example.py
"""
import math
import sys

poses, name = {}, None
for line in sys.stdin:
    words = line.split("#")[0].split()
    if words[:1] == ["problem"]:
        name = words[1]
    elif words[:1] in (["start"], ["goal"]):
        poses[words[0]] = [float(word) for word in words[1:4]]
(x, y, heading), (goal_x, goal_y, goal_heading) = poses["start"], poses["goal"]
distance = math.hypot(goal_x - x, goal_y - y)
direction = math.degrees(math.atan2(goal_y - y, goal_x - x)) if distance > 0.001 else heading
turn = lambda degrees: (degrees + 180.0) % 360.0 - 180.0
print(f"trundle-answers 1\nproblem {name}\nturn {turn(direction - heading):.6f}\ndrive {distance:.6f}\nturn {turn(goal_heading - direction):.6f}")
