//! `sensor_msgs/msg/PointField`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `PointField`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PointField {
    /// `string`.
    pub name: std::string::String,
    /// `uint32`.
    pub offset: u32,
    /// `uint8`.
    pub datatype: u8,
    /// `uint32`.
    pub count: u32,
}

impl ros2_client::Message for PointField {}

impl PointField {
    /// `uint8`.
    pub const INT8: u8 = 1;
    /// `uint8`.
    pub const UINT8: u8 = 2;
    /// `uint8`.
    pub const INT16: u8 = 3;
    /// `uint8`.
    pub const UINT16: u8 = 4;
    /// `uint8`.
    pub const INT32: u8 = 5;
    /// `uint8`.
    pub const UINT32: u8 = 6;
    /// `uint8`.
    pub const FLOAT32: u8 = 7;
    /// `uint8`.
    pub const FLOAT64: u8 = 8;
}

impl crate::interface::MessageType for PointField {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "PointField";
}
