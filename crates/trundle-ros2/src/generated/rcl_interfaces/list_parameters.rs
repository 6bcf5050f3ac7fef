//! `rcl_interfaces/srv/ListParameters`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ListParametersRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ListParametersRequest {
    /// `string[]`.
    pub prefixes: Vec<std::string::String>,
    /// `uint64`.
    pub depth: u64,
}

impl ros2_client::Message for ListParametersRequest {}

impl ListParametersRequest {
    /// `uint64`.
    pub const DEPTH_RECURSIVE: u64 = 0;
}

/// `rcl_interfaces`: `ListParametersResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ListParametersResponse {
    /// `ListParametersResult`.
    pub result: crate::generated::rcl_interfaces::ListParametersResult,
}

impl ros2_client::Message for ListParametersResponse {}

/// `rcl_interfaces/srv/ListParameters`.
#[derive(Debug, Clone, Copy)]
pub enum ListParameters {}

impl crate::interface::ServiceType for ListParameters {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ListParameters";
    type Request = ListParametersRequest;
    type Response = ListParametersResponse;
}
