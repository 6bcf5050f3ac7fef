//! `lifecycle_msgs/srv/GetAvailableTransitions`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `GetAvailableTransitionsRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetAvailableTransitionsRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for GetAvailableTransitionsRequest {}

/// `lifecycle_msgs`: `GetAvailableTransitionsResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetAvailableTransitionsResponse {
    /// `TransitionDescription[]`.
    pub available_transitions: Vec<crate::generated::lifecycle_msgs::TransitionDescription>,
}

impl ros2_client::Message for GetAvailableTransitionsResponse {}

/// `lifecycle_msgs/srv/GetAvailableTransitions`.
#[derive(Debug, Clone, Copy)]
pub enum GetAvailableTransitions {}

impl crate::interface::ServiceType for GetAvailableTransitions {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "GetAvailableTransitions";
    type Request = GetAvailableTransitionsRequest;
    type Response = GetAvailableTransitionsResponse;
}
