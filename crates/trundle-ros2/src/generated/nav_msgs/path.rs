//! `nav_msgs/msg/Path`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `Path`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PathMessage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `geometry_msgs/PoseStamped[]`.
    pub poses: Vec<crate::generated::geometry_msgs::PoseStamped>,
}

impl ros2_client::Message for PathMessage {}

impl crate::interface::MessageType for PathMessage {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "Path";
}
