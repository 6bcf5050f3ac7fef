//! ROS 2 interfaces. Written by `cargo xtask ros-interfaces`.

pub mod action_msgs;
pub mod builtin_interfaces;
pub mod diagnostic_msgs;
pub mod geometry_msgs;
pub mod lifecycle_msgs;
pub mod map_msgs;
pub mod nav2_msgs;
pub mod nav_msgs;
pub mod rcl_interfaces;
pub mod rosgraph_msgs;
pub mod sensor_msgs;
pub mod service_msgs;
pub mod std_msgs;
pub mod std_srvs;
pub mod tf2_msgs;
pub mod unique_identifier_msgs;
pub mod visualization_msgs;
