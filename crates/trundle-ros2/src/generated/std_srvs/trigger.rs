//! `std_srvs/srv/Trigger`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_srvs`: `TriggerRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TriggerRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for TriggerRequest {}

/// `std_srvs`: `TriggerResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TriggerResponse {
    /// `bool`.
    pub success: bool,
    /// `string`.
    pub message: std::string::String,
}

impl ros2_client::Message for TriggerResponse {}

/// `std_srvs/srv/Trigger`.
#[derive(Debug, Clone, Copy)]
pub enum Trigger {}

impl crate::interface::ServiceType for Trigger {
    const PACKAGE: &str = "std_srvs";
    const NAME: &str = "Trigger";
    type Request = TriggerRequest;
    type Response = TriggerResponse;
}
