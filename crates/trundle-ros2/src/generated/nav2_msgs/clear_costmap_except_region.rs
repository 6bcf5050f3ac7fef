//! `nav2_msgs/srv/ClearCostmapExceptRegion`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `ClearCostmapExceptRegionRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearCostmapExceptRegionRequest {
    /// `float32`.
    pub reset_distance: f32,
}

impl ros2_client::Message for ClearCostmapExceptRegionRequest {}

/// `nav2_msgs`: `ClearCostmapExceptRegionResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearCostmapExceptRegionResponse {
    /// `std_msgs/Empty`.
    pub response: crate::generated::std_msgs::Empty,
}

impl ros2_client::Message for ClearCostmapExceptRegionResponse {}

/// `nav2_msgs/srv/ClearCostmapExceptRegion`.
#[derive(Debug, Clone, Copy)]
pub enum ClearCostmapExceptRegion {}

impl crate::interface::ServiceType for ClearCostmapExceptRegion {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "ClearCostmapExceptRegion";
    type Request = ClearCostmapExceptRegionRequest;
    type Response = ClearCostmapExceptRegionResponse;
}
