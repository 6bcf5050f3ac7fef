"""python -m mujoco_robot [options] [--ros-args ...]: the simulated robot as a ROS 2 node until SIGINT, SIGTERM or --duration."""
import argparse
import math
import signal
import sys
import time

import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from . import bridge, simulation, worlds


def at_least_zero(text):
    """A number from 0 on; infinity is allowed."""
    value = float(text)
    if not value >= 0:
        raise argparse.ArgumentTypeError(f"is {text}, expected a number from 0 on")
    return value


def whole(text):
    """A whole number from 0 on."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"is {text}, expected a whole number from 0 on")
    return int(text)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="mujoco_robot", description="MuJoCo as robot and world behind ROS 2.")
    parser.add_argument("--world", choices=worlds.NAMES, default="flat")
    parser.add_argument("--seed", type=whole, default=0, help="textures, furniture and noise")
    parser.add_argument("--duration", type=at_least_zero, default=math.inf, help="simulated time, s")
    parser.add_argument("--real-time-factor", type=at_least_zero, default=1.0, help="0: as fast as the machine can")
    parser.add_argument("--lock-step", type=at_least_zero, default=0.0, metavar="S",
                        help="after each odometry wait up to S seconds of wall time for a command stamped with its time or later")
    parser.add_argument("--images", choices=["compressed", "raw", "none"], default="compressed")
    parser.add_argument("--depth", choices=["16UC1", "32FC1"], default="16UC1", help="raw depth in mm or in m")
    parser.add_argument("--jpeg-quality", type=int, choices=range(1, 101), metavar="1..100", default=90)
    parser.add_argument("--cmd-vel", choices=["stamped", "twist"], default="stamped")
    parser.add_argument("--odom-start", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "YAW"),
                        help="the odometry's first pose, m and rad")
    parser.add_argument("--tf", action="store_true", help="publish odom -> base_link by the wheels")
    parser.add_argument("--no-tf-static", dest="tf_static", action="store_false", help="no base_link -> camera")
    parser.add_argument("--no-noise", dest="noisy", action="store_false")
    options = parser.parse_args(arguments)
    options.duration = min(options.duration, 1e9)
    return options


def main():
    options = parse(remove_ros_args(sys.argv)[1:])
    # SIGINT and SIGTERM end the loop by an exception, before ROS is shut down.
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    node = rclpy.create_node("mujoco_robot")
    robot = simulation.Simulation(worlds.build(options.world, options.seed), options.seed, options.noisy, options.images != "none")
    robot.odometry.begin(*options.odom_start)
    print(f"mujoco_robot: world {options.world}, seed {options.seed}, ready", flush=True)
    cpu = time.process_time()
    try:
        bridge.run(node, bridge.Bridge(node, robot, options), options)
    except KeyboardInterrupt:
        pass
    simulated = robot.now_ms / 1000
    print(f"mujoco_robot: {simulated:.2f} s simulated, {time.process_time() - cpu:.2f} s CPU, {robot.contact_count} contacts", flush=True)
    node.destroy_node()
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
