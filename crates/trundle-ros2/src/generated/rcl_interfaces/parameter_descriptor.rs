//! `rcl_interfaces/msg/ParameterDescriptor`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ParameterDescriptor`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    /// `string`.
    pub name: std::string::String,
    /// `uint8`.
    pub r#type: u8,
    /// `string`.
    pub description: std::string::String,
    /// `string`.
    pub additional_constraints: std::string::String,
    /// `bool`.
    pub read_only: bool,
    /// `bool`.
    pub dynamic_typing: bool,
    /// `FloatingPointRange[]`.
    pub floating_point_range: Vec<crate::generated::rcl_interfaces::FloatingPointRange>,
    /// `IntegerRange[]`.
    pub integer_range: Vec<crate::generated::rcl_interfaces::IntegerRange>,
}

impl ros2_client::Message for ParameterDescriptor {}

impl crate::interface::MessageType for ParameterDescriptor {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ParameterDescriptor";
}
