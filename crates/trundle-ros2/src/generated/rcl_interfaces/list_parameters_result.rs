//! `rcl_interfaces/msg/ListParametersResult`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `ListParametersResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ListParametersResult {
    /// `string[]`.
    pub names: Vec<std::string::String>,
    /// `string[]`.
    pub prefixes: Vec<std::string::String>,
}

impl ros2_client::Message for ListParametersResult {}

impl crate::interface::MessageType for ListParametersResult {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "ListParametersResult";
}
