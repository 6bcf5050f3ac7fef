//! `rcl_interfaces/srv/DescribeParameters`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `DescribeParametersRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DescribeParametersRequest {
    /// `string[]`.
    pub names: Vec<std::string::String>,
}

impl ros2_client::Message for DescribeParametersRequest {}

/// `rcl_interfaces`: `DescribeParametersResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DescribeParametersResponse {
    /// `ParameterDescriptor[]`.
    pub descriptors: Vec<crate::generated::rcl_interfaces::ParameterDescriptor>,
}

impl ros2_client::Message for DescribeParametersResponse {}

/// `rcl_interfaces/srv/DescribeParameters`.
#[derive(Debug, Clone, Copy)]
pub enum DescribeParameters {}

impl crate::interface::ServiceType for DescribeParameters {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "DescribeParameters";
    type Request = DescribeParametersRequest;
    type Response = DescribeParametersResponse;
}
