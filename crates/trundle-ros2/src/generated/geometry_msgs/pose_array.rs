//! `geometry_msgs/msg/PoseArray`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `PoseArray`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseArray {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `Pose[]`.
    pub poses: Vec<crate::generated::geometry_msgs::Pose>,
}

impl ros2_client::Message for PoseArray {}

impl crate::interface::MessageType for PoseArray {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "PoseArray";
}
