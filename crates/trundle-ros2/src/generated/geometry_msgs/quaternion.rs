//! `geometry_msgs/msg/Quaternion`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Quaternion`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Quaternion {
    /// `float64`.
    pub x: f64,
    /// `float64`.
    pub y: f64,
    /// `float64`.
    pub z: f64,
    /// `float64`.
    pub w: f64,
}

impl ros2_client::Message for Quaternion {}

impl crate::interface::MessageType for Quaternion {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Quaternion";
}
