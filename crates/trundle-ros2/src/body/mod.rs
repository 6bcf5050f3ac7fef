//! A ROS 2 robot as a body: sensors and base come by topics.

mod base_sensors;
mod camera_topics;
mod commands;
mod frame_tree;
mod image_inbox;
mod image_pairs;
mod link_watch;
mod ros2_body;
mod ros_camera;
mod settings;

pub use base_sensors::{MAX_ODOM_SILENCE, MAX_SCAN_SILENCE};
pub use frame_tree::FrameTree;
pub use image_inbox::{ImageInbox, ImagePair, ReceivedImage};
pub use image_pairs::{ImagePairs, MAX_PAIR_GAP_S};
pub use ros_camera::{RosCamera, RosCameraSource};
pub use ros2_body::{BodyDescription, OdometryReader, Ros2Body};
pub use settings::BodySettings;
