//! `nav_msgs/msg/MapMetaData`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `MapMetaData`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MapMetaData {
    /// `builtin_interfaces/Time`.
    pub map_load_time: crate::generated::builtin_interfaces::Time,
    /// `float32`.
    pub resolution: f32,
    /// `uint32`.
    pub width: u32,
    /// `uint32`.
    pub height: u32,
    /// `geometry_msgs/Pose`.
    pub origin: crate::generated::geometry_msgs::Pose,
}

impl ros2_client::Message for MapMetaData {}

impl crate::interface::MessageType for MapMetaData {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "MapMetaData";
}
