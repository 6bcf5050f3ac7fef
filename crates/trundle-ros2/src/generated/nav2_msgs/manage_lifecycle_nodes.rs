//! `nav2_msgs/srv/ManageLifecycleNodes`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `ManageLifecycleNodesRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ManageLifecycleNodesRequest {
    /// `uint8`.
    pub command: u8,
}

impl ros2_client::Message for ManageLifecycleNodesRequest {}

impl ManageLifecycleNodesRequest {
    /// `uint8`.
    pub const STARTUP: u8 = 0;
    /// `uint8`.
    pub const PAUSE: u8 = 1;
    /// `uint8`.
    pub const RESUME: u8 = 2;
    /// `uint8`.
    pub const RESET: u8 = 3;
    /// `uint8`.
    pub const SHUTDOWN: u8 = 4;
    /// `uint8`.
    pub const CONFIGURE: u8 = 5;
    /// `uint8`.
    pub const CLEANUP: u8 = 6;
}

/// `nav2_msgs`: `ManageLifecycleNodesResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ManageLifecycleNodesResponse {
    /// `bool`.
    pub success: bool,
}

impl ros2_client::Message for ManageLifecycleNodesResponse {}

/// `nav2_msgs/srv/ManageLifecycleNodes`.
#[derive(Debug, Clone, Copy)]
pub enum ManageLifecycleNodes {}

impl crate::interface::ServiceType for ManageLifecycleNodes {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "ManageLifecycleNodes";
    type Request = ManageLifecycleNodesRequest;
    type Response = ManageLifecycleNodesResponse;
}
