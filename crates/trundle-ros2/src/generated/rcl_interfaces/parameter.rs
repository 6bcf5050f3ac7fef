//! `rcl_interfaces/msg/Parameter`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `Parameter`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// `string`.
    pub name: std::string::String,
    /// `ParameterValue`.
    pub value: crate::generated::rcl_interfaces::ParameterValue,
}

impl ros2_client::Message for Parameter {}

impl crate::interface::MessageType for Parameter {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "Parameter";
}
