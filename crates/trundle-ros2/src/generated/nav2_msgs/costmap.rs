//! `nav2_msgs/msg/Costmap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `Costmap`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Costmap {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `CostmapMetaData`.
    pub metadata: crate::generated::nav2_msgs::CostmapMetaData,
    /// `uint8[]`.
    pub data: crate::wire::Bytes,
}

impl ros2_client::Message for Costmap {}

impl crate::interface::MessageType for Costmap {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "Costmap";
}
