//! `nav_msgs/msg/OccupancyGrid`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `OccupancyGrid`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct OccupancyGridMessage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `MapMetaData`.
    pub info: crate::generated::nav_msgs::MapMetaData,
    /// `int8[]`.
    pub data: Vec<i8>,
}

impl ros2_client::Message for OccupancyGridMessage {}

impl crate::interface::MessageType for OccupancyGridMessage {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "OccupancyGrid";
}
