//! `nav2_msgs/srv/ClearEntireCostmap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `ClearEntireCostmapRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearEntireCostmapRequest {
    /// `std_msgs/Empty`.
    pub request: crate::generated::std_msgs::Empty,
}

impl ros2_client::Message for ClearEntireCostmapRequest {}

/// `nav2_msgs`: `ClearEntireCostmapResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearEntireCostmapResponse {
    /// `std_msgs/Empty`.
    pub response: crate::generated::std_msgs::Empty,
}

impl ros2_client::Message for ClearEntireCostmapResponse {}

/// `nav2_msgs/srv/ClearEntireCostmap`.
#[derive(Debug, Clone, Copy)]
pub enum ClearEntireCostmap {}

impl crate::interface::ServiceType for ClearEntireCostmap {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "ClearEntireCostmap";
    type Request = ClearEntireCostmapRequest;
    type Response = ClearEntireCostmapResponse;
}
