//! `nav_msgs/msg/Goals`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `Goals`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Goals {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `geometry_msgs/PoseStamped[]`.
    pub goals: Vec<crate::generated::geometry_msgs::PoseStamped>,
}

impl ros2_client::Message for Goals {}

impl crate::interface::MessageType for Goals {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "Goals";
}
