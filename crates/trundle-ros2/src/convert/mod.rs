//! ROS 2 messages to core types and back: one file for each family of messages. What is not finite, not normal or of an unknown form
//! is refused with its field and value; the caller names the topic.

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
