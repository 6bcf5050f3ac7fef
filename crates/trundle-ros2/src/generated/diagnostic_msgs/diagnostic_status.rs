//! `diagnostic_msgs/msg/DiagnosticStatus`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `diagnostic_msgs`: `DiagnosticStatus`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// `byte`.
    pub level: u8,
    /// `string`.
    pub name: std::string::String,
    /// `string`.
    pub message: std::string::String,
    /// `string`.
    pub hardware_id: std::string::String,
    /// `KeyValue[]`.
    pub values: Vec<crate::generated::diagnostic_msgs::KeyValue>,
}

impl ros2_client::Message for DiagnosticStatus {}

impl DiagnosticStatus {
    /// `byte`.
    pub const OK: u8 = 0;
    /// `byte`.
    pub const WARN: u8 = 1;
    /// `byte`.
    pub const ERROR: u8 = 2;
    /// `byte`.
    pub const STALE: u8 = 3;
}

impl crate::interface::MessageType for DiagnosticStatus {
    const PACKAGE: &str = "diagnostic_msgs";
    const NAME: &str = "DiagnosticStatus";
}
