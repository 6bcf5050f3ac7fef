//! ROS 2 messages to core types and back: one file for each family of messages. A value that is not finite, not normalised or of an unknown
//! format is refused with its field; the caller adds the topic.

pub mod battery;
pub mod camera_info;
pub mod diagnostics;
pub mod grid;
pub mod image;
pub mod imu;
pub mod odometry;
pub mod path;
pub mod pose;
pub mod scan;
pub mod stamp;
pub mod transform;
pub mod twist;
