//! `lifecycle_msgs/srv/ChangeState`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `ChangeStateRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ChangeStateRequest {
    /// `Transition`.
    pub transition: crate::generated::lifecycle_msgs::Transition,
}

impl ros2_client::Message for ChangeStateRequest {}

/// `lifecycle_msgs`: `ChangeStateResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ChangeStateResponse {
    /// `bool`.
    pub success: bool,
}

impl ros2_client::Message for ChangeStateResponse {}

/// `lifecycle_msgs/srv/ChangeState`.
#[derive(Debug, Clone, Copy)]
pub enum ChangeState {}

impl crate::interface::ServiceType for ChangeState {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "ChangeState";
    type Request = ChangeStateRequest;
    type Response = ChangeStateResponse;
}
