//! `geometry_msgs/msg/Point32`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Point32`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Point32 {
    /// `float32`.
    pub x: f32,
    /// `float32`.
    pub y: f32,
    /// `float32`.
    pub z: f32,
}

impl ros2_client::Message for Point32 {}

impl crate::interface::MessageType for Point32 {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Point32";
}
