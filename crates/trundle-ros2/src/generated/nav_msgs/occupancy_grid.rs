//! `nav_msgs/msg/OccupancyGrid`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `OccupancyGrid`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct OccupancyGrid {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `MapMetaData`.
    pub info: crate::generated::nav_msgs::MapMetaData,
    /// `int8[]`.
    pub data: Vec<i8>,
}

impl ros2_client::Message for OccupancyGrid {}

impl crate::interface::MessageType for OccupancyGrid {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "OccupancyGrid";
}
