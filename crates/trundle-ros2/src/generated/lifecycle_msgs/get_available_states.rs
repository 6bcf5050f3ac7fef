//! `lifecycle_msgs/srv/GetAvailableStates`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `GetAvailableStatesRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetAvailableStatesRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for GetAvailableStatesRequest {}

/// `lifecycle_msgs`: `GetAvailableStatesResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetAvailableStatesResponse {
    /// `State[]`.
    pub available_states: Vec<crate::generated::lifecycle_msgs::State>,
}

impl ros2_client::Message for GetAvailableStatesResponse {}

/// `lifecycle_msgs/srv/GetAvailableStates`.
#[derive(Debug, Clone, Copy)]
pub enum GetAvailableStates {}

impl crate::interface::ServiceType for GetAvailableStates {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "GetAvailableStates";
    type Request = GetAvailableStatesRequest;
    type Response = GetAvailableStatesResponse;
}
