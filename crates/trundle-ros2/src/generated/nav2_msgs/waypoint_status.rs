//! `nav2_msgs/msg/WaypointStatus`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `WaypointStatus`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct WaypointStatus {
    /// `uint8`.
    pub waypoint_status: u8,
    /// `uint32`.
    pub waypoint_index: u32,
    /// `geometry_msgs/PoseStamped`.
    pub waypoint_pose: crate::generated::geometry_msgs::PoseStamped,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for WaypointStatus {}

impl WaypointStatus {
    /// `uint8`.
    pub const PENDING: u8 = 0;
    /// `uint8`.
    pub const COMPLETED: u8 = 1;
    /// `uint8`.
    pub const SKIPPED: u8 = 2;
    /// `uint8`.
    pub const FAILED: u8 = 3;
}

impl crate::interface::MessageType for WaypointStatus {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "WaypointStatus";
}
