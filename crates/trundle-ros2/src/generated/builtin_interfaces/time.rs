//! `builtin_interfaces/msg/Time`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces`: `Time`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// `int32`.
    pub sec: i32,
    /// `uint32`.
    pub nanosec: u32,
}

impl ros2_client::Message for Time {}

impl crate::interface::MessageType for Time {
    const PACKAGE: &str = "builtin_interfaces";
    const NAME: &str = "Time";
}
