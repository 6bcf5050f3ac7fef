//! `visualization_msgs/msg/MarkerArray`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `visualization_msgs`: `MarkerArray`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MarkerArray {
    /// `Marker[]`.
    pub markers: Vec<crate::generated::visualization_msgs::Marker>,
}

impl ros2_client::Message for MarkerArray {}

impl crate::interface::MessageType for MarkerArray {
    const PACKAGE: &str = "visualization_msgs";
    const NAME: &str = "MarkerArray";
}
