//! `visualization_msgs/msg/UVCoordinate`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `visualization_msgs`: `UVCoordinate`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UVCoordinate {
    /// `float32`.
    pub u: f32,
    /// `float32`.
    pub v: f32,
}

impl ros2_client::Message for UVCoordinate {}

impl crate::interface::MessageType for UVCoordinate {
    const PACKAGE: &str = "visualization_msgs";
    const NAME: &str = "UVCoordinate";
}
