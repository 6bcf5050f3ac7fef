//! `sensor_msgs/msg/CompressedImage`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `CompressedImage`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CompressedImage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `string`.
    pub format: std::string::String,
    /// `uint8[]`.
    pub data: crate::wire::Bytes,
}

impl ros2_client::Message for CompressedImage {}

impl crate::interface::MessageType for CompressedImage {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "CompressedImage";
}
