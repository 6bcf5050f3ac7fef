//! `sensor_msgs/msg/PointCloud2`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `PointCloud2`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PointCloud2 {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `uint32`.
    pub height: u32,
    /// `uint32`.
    pub width: u32,
    /// `PointField[]`.
    pub fields: Vec<crate::generated::sensor_msgs::PointField>,
    /// `bool`.
    pub is_bigendian: bool,
    /// `uint32`.
    pub point_step: u32,
    /// `uint32`.
    pub row_step: u32,
    /// `uint8[]`.
    pub data: crate::wire::Bytes,
    /// `bool`.
    pub is_dense: bool,
}

impl ros2_client::Message for PointCloud2 {}

impl crate::interface::MessageType for PointCloud2 {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "PointCloud2";
}
