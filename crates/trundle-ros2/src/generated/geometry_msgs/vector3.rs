//! `geometry_msgs/msg/Vector3`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Vector3`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Vector3Message {
    /// `float64`.
    pub x: f64,
    /// `float64`.
    pub y: f64,
    /// `float64`.
    pub z: f64,
}

impl ros2_client::Message for Vector3Message {}

impl crate::interface::MessageType for Vector3Message {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Vector3";
}
