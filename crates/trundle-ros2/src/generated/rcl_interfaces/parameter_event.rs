//! `rcl_interfaces/msg/ParameterEvent`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ParameterEvent`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterEvent {
    /// `builtin_interfaces/Time`.
    pub stamp: crate::generated::builtin_interfaces::Time,
    /// `string`.
    pub node: std::string::String,
    /// `Parameter[]`.
    pub new_parameters: Vec<crate::generated::rcl_interfaces::Parameter>,
    /// `Parameter[]`.
    pub changed_parameters: Vec<crate::generated::rcl_interfaces::Parameter>,
    /// `Parameter[]`.
    pub deleted_parameters: Vec<crate::generated::rcl_interfaces::Parameter>,
}

impl ros2_client::Message for ParameterEvent {}

impl crate::interface::MessageType for ParameterEvent {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ParameterEvent";
}
