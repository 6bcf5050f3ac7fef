//! `std_srvs/srv/Empty`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_srvs`: `EmptyRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EmptyRequest {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for EmptyRequest {}

/// `std_srvs`: `EmptyResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EmptyResponse {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for EmptyResponse {}

/// `std_srvs/srv/Empty`.
#[derive(Debug, Clone, Copy)]
pub enum Empty {}

impl crate::interface::ServiceType for Empty {
    const PACKAGE: &str = "std_srvs";
    const NAME: &str = "Empty";
    type Request = EmptyRequest;
    type Response = EmptyResponse;
}
