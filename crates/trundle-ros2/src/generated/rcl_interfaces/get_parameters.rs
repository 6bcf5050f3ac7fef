//! `rcl_interfaces/srv/GetParameters`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `GetParametersRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetParametersRequest {
    /// `string[]`.
    pub names: Vec<std::string::String>,
}

impl ros2_client::Message for GetParametersRequest {}

/// `rcl_interfaces`: `GetParametersResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetParametersResponse {
    /// `ParameterValue[]`.
    pub values: Vec<crate::generated::rcl_interfaces::ParameterValue>,
}

impl ros2_client::Message for GetParametersResponse {}

/// `rcl_interfaces/srv/GetParameters`.
#[derive(Debug, Clone, Copy)]
pub enum GetParameters {}

impl crate::interface::ServiceType for GetParameters {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "GetParameters";
    type Request = GetParametersRequest;
    type Response = GetParametersResponse;
}
