//! ROS 2 bags: MCAP files and rosbag2 folders, their messages as the middleware sends them (CDR).

mod bag;
mod cdr;
mod database;
mod frames;
mod laser_log;
mod laser_scan;
mod messages;
mod motion;
mod sqlite;

pub use laser_log::{RosBagOptions, read_laser_log, read_ros_bag};
