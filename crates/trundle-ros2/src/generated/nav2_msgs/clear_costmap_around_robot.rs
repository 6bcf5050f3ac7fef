//! `nav2_msgs/srv/ClearCostmapAroundRobot`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `ClearCostmapAroundRobotRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearCostmapAroundRobotRequest {
    /// `float32`.
    pub reset_distance: f32,
}

impl ros2_client::Message for ClearCostmapAroundRobotRequest {}

/// `nav2_msgs`: `ClearCostmapAroundRobotResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ClearCostmapAroundRobotResponse {
    /// `std_msgs/Empty`.
    pub response: crate::generated::std_msgs::Empty,
}

impl ros2_client::Message for ClearCostmapAroundRobotResponse {}

/// `nav2_msgs/srv/ClearCostmapAroundRobot`.
#[derive(Debug, Clone, Copy)]
pub enum ClearCostmapAroundRobot {}

impl crate::interface::ServiceType for ClearCostmapAroundRobot {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "ClearCostmapAroundRobot";
    type Request = ClearCostmapAroundRobotRequest;
    type Response = ClearCostmapAroundRobotResponse;
}
