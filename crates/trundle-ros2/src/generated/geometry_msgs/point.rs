//! `geometry_msgs/msg/Point`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Point`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// `float64`.
    pub x: f64,
    /// `float64`.
    pub y: f64,
    /// `float64`.
    pub z: f64,
}

impl ros2_client::Message for Point {}

impl crate::interface::MessageType for Point {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Point";
}
