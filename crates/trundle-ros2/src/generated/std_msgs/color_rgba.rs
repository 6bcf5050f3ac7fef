//! `std_msgs/msg/ColorRGBA`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `std_msgs`: `ColorRGBA`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ColorRGBA {
    /// `float32`.
    pub r: f32,
    /// `float32`.
    pub g: f32,
    /// `float32`.
    pub b: f32,
    /// `float32`.
    pub a: f32,
}

impl ros2_client::Message for ColorRGBA {}

impl crate::interface::MessageType for ColorRGBA {
    const PACKAGE: &str = "std_msgs";
    const NAME: &str = "ColorRGBA";
}
