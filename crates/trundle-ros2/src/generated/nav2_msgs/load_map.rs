//! `nav2_msgs/srv/LoadMap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `LoadMapRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadMapRequest {
    /// `string`.
    pub map_url: std::string::String,
}

impl ros2_client::Message for LoadMapRequest {}

/// `nav2_msgs`: `LoadMapResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadMapResponse {
    /// `nav_msgs/OccupancyGrid`.
    pub map: crate::generated::nav_msgs::OccupancyGridMessage,
    /// `uint8`.
    pub result: u8,
}

impl ros2_client::Message for LoadMapResponse {}

impl LoadMapResponse {
    /// `uint8`.
    pub const RESULT_SUCCESS: u8 = 0;
    /// `uint8`.
    pub const RESULT_MAP_DOES_NOT_EXIST: u8 = 1;
    /// `uint8`.
    pub const RESULT_INVALID_MAP_DATA: u8 = 2;
    /// `uint8`.
    pub const RESULT_INVALID_MAP_METADATA: u8 = 3;
    /// `uint8`.
    pub const RESULT_UNDEFINED_FAILURE: u8 = 255;
}

/// `nav2_msgs/srv/LoadMap`.
#[derive(Debug, Clone, Copy)]
pub enum LoadMap {}

impl crate::interface::ServiceType for LoadMap {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "LoadMap";
    type Request = LoadMapRequest;
    type Response = LoadMapResponse;
}
