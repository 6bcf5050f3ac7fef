//! `unique_identifier_msgs/msg/UUID`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `unique_identifier_msgs`: `UUID`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UUID {
    /// `uint8[16]`.
    pub uuid: [u8; 16],
}

impl ros2_client::Message for UUID {}

impl crate::interface::MessageType for UUID {
    const PACKAGE: &str = "unique_identifier_msgs";
    const NAME: &str = "UUID";
}
