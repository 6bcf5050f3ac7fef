//! `geometry_msgs/msg/PoseStamped`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `PoseStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseStamped {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `Pose`.
    pub pose: crate::generated::geometry_msgs::Pose,
}

impl ros2_client::Message for PoseStamped {}

impl crate::interface::MessageType for PoseStamped {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "PoseStamped";
}
