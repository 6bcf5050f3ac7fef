//! `rcl_interfaces/srv/SetParameters`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `SetParametersRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParametersRequest {
    /// `Parameter[]`.
    pub parameters: Vec<crate::generated::rcl_interfaces::Parameter>,
}

impl ros2_client::Message for SetParametersRequest {}

/// `rcl_interfaces`: `SetParametersResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParametersResponse {
    /// `SetParametersResult[]`.
    pub results: Vec<crate::generated::rcl_interfaces::SetParametersResult>,
}

impl ros2_client::Message for SetParametersResponse {}

/// `rcl_interfaces/srv/SetParameters`.
#[derive(Debug, Clone, Copy)]
pub enum SetParameters {}

impl crate::interface::ServiceType for SetParameters {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "SetParameters";
    type Request = SetParametersRequest;
    type Response = SetParametersResponse;
}
