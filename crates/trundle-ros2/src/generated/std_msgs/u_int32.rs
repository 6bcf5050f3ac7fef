//! `std_msgs/msg/UInt32`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `UInt32`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UInt32 {
    /// `uint32`.
    pub data: u32,
}

impl ros2_client::Message for UInt32 {}

impl crate::interface::MessageType for UInt32 {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "UInt32";
}
