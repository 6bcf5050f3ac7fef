//! `geometry_msgs/msg/Pose`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Pose`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// `Point`.
    pub position: crate::generated::geometry_msgs::Point,
    /// `Quaternion`.
    pub orientation: crate::generated::geometry_msgs::Quaternion,
}

impl ros2_client::Message for Pose {}

impl crate::interface::MessageType for Pose {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Pose";
}
