//! `nav_msgs/srv/GetMap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `GetMapRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetMapRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for GetMapRequest {}

/// `nav_msgs`: `GetMapResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetMapResponse {
    /// `OccupancyGrid`.
    pub map: crate::generated::nav_msgs::OccupancyGridMessage,
}

impl ros2_client::Message for GetMapResponse {}

/// `nav_msgs/srv/GetMap`.
#[derive(Debug, Clone, Copy)]
pub enum GetMap {}

impl crate::interface::ServiceType for GetMap {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "GetMap";
    type Request = GetMapRequest;
    type Response = GetMapResponse;
}
