//! `rcl_interfaces/srv/GetParameterTypes`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `GetParameterTypesRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetParameterTypesRequest {
    /// `string[]`.
    pub names: Vec<std::string::String>,
}

impl ros2_client::Message for GetParameterTypesRequest {}

/// `rcl_interfaces`: `GetParameterTypesResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GetParameterTypesResponse {
    /// `uint8[]`.
    pub types: crate::wire::Bytes,
}

impl ros2_client::Message for GetParameterTypesResponse {}

/// `rcl_interfaces/srv/GetParameterTypes`.
#[derive(Debug, Clone, Copy)]
pub enum GetParameterTypes {}

impl crate::interface::ServiceType for GetParameterTypes {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "GetParameterTypes";
    type Request = GetParameterTypesRequest;
    type Response = GetParameterTypesResponse;
}
