//! `lifecycle_msgs/srv/GetState`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `GetStateRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetStateRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for GetStateRequest {}

/// `lifecycle_msgs`: `GetStateResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetStateResponse {
    /// `State`.
    pub current_state: crate::generated::lifecycle_msgs::State,
}

impl ros2_client::Message for GetStateResponse {}

/// `lifecycle_msgs/srv/GetState`.
#[derive(Debug, Clone, Copy)]
pub enum GetState {}

impl crate::interface::ServiceType for GetState {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "GetState";
    type Request = GetStateRequest;
    type Response = GetStateResponse;
}
