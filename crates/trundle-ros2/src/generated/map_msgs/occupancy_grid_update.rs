//! `map_msgs/msg/OccupancyGridUpdate`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `map_msgs`: `OccupancyGridUpdate`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct OccupancyGridUpdate {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `int32`.
    pub x: i32,
    /// `int32`.
    pub y: i32,
    /// `uint32`.
    pub width: u32,
    /// `uint32`.
    pub height: u32,
    /// `int8[]`.
    pub data: Vec<i8>,
}

impl ros2_client::Message for OccupancyGridUpdate {}

impl crate::interface::MessageType for OccupancyGridUpdate {
    const PACKAGE: &str = "map_msgs";
    const NAME: &str = "OccupancyGridUpdate";
}
