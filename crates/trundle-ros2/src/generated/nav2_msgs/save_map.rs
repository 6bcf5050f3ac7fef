//! `nav2_msgs/srv/SaveMap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `SaveMapRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SaveMapRequest {
    /// `string`.
    pub map_topic: std::string::String,
    /// `string`.
    pub map_url: std::string::String,
    /// `string`.
    pub image_format: std::string::String,
    /// `string`.
    pub map_mode: std::string::String,
    /// `float32`.
    pub free_thresh: f32,
    /// `float32`.
    pub occupied_thresh: f32,
}

impl ros2_client::Message for SaveMapRequest {}

/// `nav2_msgs`: `SaveMapResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SaveMapResponse {
    /// `bool`.
    pub result: bool,
}

impl ros2_client::Message for SaveMapResponse {}

/// `nav2_msgs/srv/SaveMap`.
#[derive(Debug, Clone, Copy)]
pub enum SaveMap {}

impl crate::interface::ServiceType for SaveMap {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "SaveMap";
    type Request = SaveMapRequest;
    type Response = SaveMapResponse;
}
