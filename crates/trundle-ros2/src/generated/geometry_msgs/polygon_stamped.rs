//! `geometry_msgs/msg/PolygonStamped`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `PolygonStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PolygonStamped {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `Polygon`.
    pub polygon: crate::generated::geometry_msgs::Polygon,
}

impl ros2_client::Message for PolygonStamped {}

impl crate::interface::MessageType for PolygonStamped {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "PolygonStamped";
}
