//! `rcl_interfaces/msg/SetParametersResult`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `SetParametersResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SetParametersResult {
    /// `bool`.
    pub successful: bool,
    /// `string`.
    pub reason: std::string::String,
}

impl ros2_client::Message for SetParametersResult {}

impl crate::interface::MessageType for SetParametersResult {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "SetParametersResult";
}
