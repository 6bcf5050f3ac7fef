//! ROS bags: MCAP files, rosbag2 folders and ROS 1 bags, their messages as the middleware sends them.

mod bag;
mod cdr;
mod contents;
mod database;
mod frames;
mod laser_log;
mod laser_scan;
mod messages;
mod ros1_bag;
mod ros1_record;
mod sqlite;

pub use laser_log::{read_laser_log, read_ros_bag};
