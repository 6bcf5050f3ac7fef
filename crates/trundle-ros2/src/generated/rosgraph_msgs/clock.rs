//! `rosgraph_msgs/msg/Clock`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rosgraph_msgs`: `Clock`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// `builtin_interfaces/Time`.
    pub clock: crate::generated::builtin_interfaces::Time,
}

impl ros2_client::Message for Clock {}

impl crate::interface::MessageType for Clock {
    const PACKAGE: &str = "rosgraph_msgs";
    const NAME: &str = "Clock";
}
