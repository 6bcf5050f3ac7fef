//! `nav2_msgs/msg/CostmapMetaData`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `CostmapMetaData`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CostmapMetaData {
    /// `builtin_interfaces/Time`.
    pub map_load_time: crate::generated::builtin_interfaces::Time,
    /// `builtin_interfaces/Time`.
    pub update_time: crate::generated::builtin_interfaces::Time,
    /// `string`.
    pub layer: std::string::String,
    /// `float32`.
    pub resolution: f32,
    /// `uint32`.
    pub size_x: u32,
    /// `uint32`.
    pub size_y: u32,
    /// `geometry_msgs/Pose`.
    pub origin: crate::generated::geometry_msgs::Pose,
}

impl ros2_client::Message for CostmapMetaData {}

impl crate::interface::MessageType for CostmapMetaData {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "CostmapMetaData";
}
