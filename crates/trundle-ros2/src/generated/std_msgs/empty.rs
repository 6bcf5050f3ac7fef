//! `std_msgs/msg/Empty`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `Empty`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Empty {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for Empty {}

impl crate::interface::MessageType for Empty {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "Empty";
}
