//! `std_msgs/msg/Float32`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `Float32`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Float32 {
    /// `float32`.
    pub data: f32,
}

impl ros2_client::Message for Float32 {}

impl crate::interface::MessageType for Float32 {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "Float32";
}
