//! ROS bags: MCAP files, rosbag2 folders and ROS 1 bags, their messages as the middleware sends them.

mod bag;
mod bag_scans;
mod cdr;
mod cdr_writer;
mod contents;
mod database;
mod definitions;
mod frames;
mod hidden_topics;
mod imu;
mod laser_log;
mod laser_scan;
pub mod message;
mod messages;
mod rgbd;
mod robot_sensors;
mod ros1_bag;
mod ros1_record;
mod scan_survey;
mod sqlite;

pub(crate) use cdr::{CdrError, CdrReader, Wire};
pub(crate) use definitions::definition;
pub use imu::ImuReading;
pub use laser_log::{LaserLogScans, read_laser_log, read_ros_bag};
pub use laser_scan::{ConvertedScan, LaserSweep, NoEcho};
pub(crate) use messages::header;
pub use rgbd::{
    RosFrame, RosFrames, RosImageTopics, RosSequence, RosSequenceOptions, RosTopics, decode_compressed_depth,
};
