//! `sensor_msgs/msg/Image`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `Image`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ImageMessage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `uint32`.
    pub height: u32,
    /// `uint32`.
    pub width: u32,
    /// `string`.
    pub encoding: std::string::String,
    /// `uint8`.
    pub is_bigendian: u8,
    /// `uint32`.
    pub step: u32,
    /// `uint8[]`.
    pub data: crate::wire::Bytes,
}

impl ros2_client::Message for ImageMessage {}

impl crate::interface::MessageType for ImageMessage {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "Image";
}
