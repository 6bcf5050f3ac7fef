//! `rcl_interfaces/srv/SetParametersAtomically`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `SetParametersAtomicallyRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParametersAtomicallyRequest {
    /// `Parameter[]`.
    pub parameters: Vec<crate::generated::rcl_interfaces::Parameter>,
}

impl ros2_client::Message for SetParametersAtomicallyRequest {}

/// `rcl_interfaces`: `SetParametersAtomicallyResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParametersAtomicallyResponse {
    /// `SetParametersResult`.
    pub result: crate::generated::rcl_interfaces::SetParametersResult,
}

impl ros2_client::Message for SetParametersAtomicallyResponse {}

/// `rcl_interfaces/srv/SetParametersAtomically`.
#[derive(Debug, Clone, Copy)]
pub enum SetParametersAtomically {}

impl crate::interface::ServiceType for SetParametersAtomically {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "SetParametersAtomically";
    type Request = SetParametersAtomicallyRequest;
    type Response = SetParametersAtomicallyResponse;
}
