//! `std_srvs/srv/SetBool`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_srvs`: `SetBoolRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetBoolRequest {
    /// `bool`.
    pub data: bool,
}

impl ros2_client::Message for SetBoolRequest {}

/// `std_srvs`: `SetBoolResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetBoolResponse {
    /// `bool`.
    pub success: bool,
    /// `string`.
    pub message: std::string::String,
}

impl ros2_client::Message for SetBoolResponse {}

/// `std_srvs/srv/SetBool`.
#[derive(Debug, Clone, Copy)]
pub enum SetBool {}

impl crate::interface::ServiceType for SetBool {
    const PACKAGE: &str = "std_srvs";
    const NAME: &str = "SetBool";
    type Request = SetBoolRequest;
    type Response = SetBoolResponse;
}
