"""MuJoCo as robot and world, offered to ROS 2 by rclpy."""
import os

# How MuJoCo draws is read when it is imported. One thread for the software renderer: more cost more than they gain at this size.
os.environ.setdefault("LP_NUM_THREADS", "1")
os.environ.setdefault("MUJOCO_GL", "egl")
