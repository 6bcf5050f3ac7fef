//! `sensor_msgs/msg/RegionOfInterest`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `RegionOfInterest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RegionOfInterest {
    /// `uint32`.
    pub x_offset: u32,
    /// `uint32`.
    pub y_offset: u32,
    /// `uint32`.
    pub height: u32,
    /// `uint32`.
    pub width: u32,
    /// `bool`.
    pub do_rectify: bool,
}

impl ros2_client::Message for RegionOfInterest {}

impl crate::interface::MessageType for RegionOfInterest {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "RegionOfInterest";
}
