//! `rcl_interfaces/msg/ParameterType`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ParameterType`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterType {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for ParameterType {}

impl ParameterType {
    /// `uint8`.
    pub const PARAMETER_NOT_SET: u8 = 0;
    /// `uint8`.
    pub const PARAMETER_BOOL: u8 = 1;
    /// `uint8`.
    pub const PARAMETER_INTEGER: u8 = 2;
    /// `uint8`.
    pub const PARAMETER_DOUBLE: u8 = 3;
    /// `uint8`.
    pub const PARAMETER_STRING: u8 = 4;
    /// `uint8`.
    pub const PARAMETER_BYTE_ARRAY: u8 = 5;
    /// `uint8`.
    pub const PARAMETER_BOOL_ARRAY: u8 = 6;
    /// `uint8`.
    pub const PARAMETER_INTEGER_ARRAY: u8 = 7;
    /// `uint8`.
    pub const PARAMETER_DOUBLE_ARRAY: u8 = 8;
    /// `uint8`.
    pub const PARAMETER_STRING_ARRAY: u8 = 9;
}

impl crate::interface::MessageType for ParameterType {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ParameterType";
}
