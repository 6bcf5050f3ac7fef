"""MuJoCo as robot and world, offered to ROS 2 by rclpy."""
