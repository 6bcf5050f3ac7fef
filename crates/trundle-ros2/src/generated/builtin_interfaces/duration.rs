//! `builtin_interfaces/msg/Duration`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces`: `Duration`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Duration {
    /// `int32`.
    pub sec: i32,
    /// `uint32`.
    pub nanosec: u32,
}

impl ros2_client::Message for Duration {}

impl crate::interface::MessageType for Duration {
    const PACKAGE: &str = "builtin_interfaces";
    const NAME: &str = "Duration";
}
