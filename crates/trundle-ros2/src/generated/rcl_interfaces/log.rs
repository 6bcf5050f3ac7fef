//! `rcl_interfaces/msg/Log`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `Log`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Log {
    /// `builtin_interfaces/Time`.
    pub stamp: crate::generated::builtin_interfaces::Time,
    /// `uint8`.
    pub level: u8,
    /// `string`.
    pub name: std::string::String,
    /// `string`.
    pub msg: std::string::String,
    /// `string`.
    pub file: std::string::String,
    /// `string`.
    pub function: std::string::String,
    /// `uint32`.
    pub line: u32,
}

impl ros2_client::Message for Log {}

impl Log {
    /// `uint8`.
    pub const DEBUG: u8 = 10;
    /// `uint8`.
    pub const INFO: u8 = 20;
    /// `uint8`.
    pub const WARN: u8 = 30;
    /// `uint8`.
    pub const ERROR: u8 = 40;
    /// `uint8`.
    pub const FATAL: u8 = 50;
}

impl crate::interface::MessageType for Log {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "Log";
}
