//! `geometry_msgs/msg/Polygon`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Polygon`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Polygon {
    /// `Point32[]`.
    pub points: Vec<crate::generated::geometry_msgs::Point32>,
}

impl ros2_client::Message for Polygon {}

impl crate::interface::MessageType for Polygon {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Polygon";
}
