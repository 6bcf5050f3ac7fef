//! `std_msgs/msg/Bool`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `Bool`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bool {
    /// `bool`.
    pub data: bool,
}

impl ros2_client::Message for Bool {}

impl crate::interface::MessageType for Bool {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "Bool";
}
