//! `nav2_msgs/srv/SetInitialPose`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `SetInitialPoseRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetInitialPoseRequest {
    /// `geometry_msgs/PoseWithCovarianceStamped`.
    pub pose: crate::generated::geometry_msgs::PoseWithCovarianceStamped,
}

impl ros2_client::Message for SetInitialPoseRequest {}

/// `nav2_msgs`: `SetInitialPoseResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetInitialPoseResponse {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for SetInitialPoseResponse {}

/// `nav2_msgs/srv/SetInitialPose`.
#[derive(Debug, Clone, Copy)]
pub enum SetInitialPose {}

impl crate::interface::ServiceType for SetInitialPose {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "SetInitialPose";
    type Request = SetInitialPoseRequest;
    type Response = SetInitialPoseResponse;
}
