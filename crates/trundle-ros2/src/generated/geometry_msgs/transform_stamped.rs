//! `geometry_msgs/msg/TransformStamped`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `TransformStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TransformStamped {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `string`.
    pub child_frame_id: std::string::String,
    /// `Transform`.
    pub transform: crate::generated::geometry_msgs::Transform,
}

impl ros2_client::Message for TransformStamped {}

impl crate::interface::MessageType for TransformStamped {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "TransformStamped";
}
