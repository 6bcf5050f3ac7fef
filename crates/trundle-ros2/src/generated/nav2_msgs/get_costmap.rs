//! `nav2_msgs/srv/GetCostmap`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `GetCostmapRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetCostmapRequest {
    /// `CostmapMetaData`.
    pub specs: crate::generated::nav2_msgs::CostmapMetaData,
}

impl ros2_client::Message for GetCostmapRequest {}

/// `nav2_msgs`: `GetCostmapResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetCostmapResponse {
    /// `Costmap`.
    pub map: crate::generated::nav2_msgs::Costmap,
}

impl ros2_client::Message for GetCostmapResponse {}

/// `nav2_msgs/srv/GetCostmap`.
#[derive(Debug, Clone, Copy)]
pub enum GetCostmap {}

impl crate::interface::ServiceType for GetCostmap {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "GetCostmap";
    type Request = GetCostmapRequest;
    type Response = GetCostmapResponse;
}
