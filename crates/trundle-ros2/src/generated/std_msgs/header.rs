//! `std_msgs/msg/Header`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `Header`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// `builtin_interfaces/Time`.
    pub stamp: crate::generated::builtin_interfaces::Time,
    /// `string`.
    pub frame_id: std::string::String,
}

impl ros2_client::Message for Header {}

impl crate::interface::MessageType for Header {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "Header";
}
