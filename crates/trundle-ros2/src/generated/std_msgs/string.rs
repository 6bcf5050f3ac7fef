//! `std_msgs/msg/String`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `String`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct String {
    /// `string`.
    pub data: std::string::String,
}

impl ros2_client::Message for String {}

impl crate::interface::MessageType for String {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "String";
}
