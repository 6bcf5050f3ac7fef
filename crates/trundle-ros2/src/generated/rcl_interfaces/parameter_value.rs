//! `rcl_interfaces/msg/ParameterValue`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ParameterValue`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterValue {
    /// `uint8`.
    pub r#type: u8,
    /// `bool`.
    pub bool_value: bool,
    /// `int64`.
    pub integer_value: i64,
    /// `float64`.
    pub double_value: f64,
    /// `string`.
    pub string_value: std::string::String,
    /// `byte[]`.
    pub byte_array_value: crate::wire::Bytes,
    /// `bool[]`.
    pub bool_array_value: Vec<bool>,
    /// `int64[]`.
    pub integer_array_value: Vec<i64>,
    /// `float64[]`.
    pub double_array_value: Vec<f64>,
    /// `string[]`.
    pub string_array_value: Vec<std::string::String>,
}

impl ros2_client::Message for ParameterValue {}

impl crate::interface::MessageType for ParameterValue {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ParameterValue";
}
