//! `diagnostic_msgs/msg/KeyValue`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `diagnostic_msgs`: `KeyValue`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KeyValue {
    /// `string`.
    pub key: std::string::String,
    /// `string`.
    pub value: std::string::String,
}

impl ros2_client::Message for KeyValue {}

impl crate::interface::MessageType for KeyValue {
    const PACKAGE: &str = "diagnostic_msgs";
    const NAME: &str = "KeyValue";
}
