//! `sensor_msgs/msg/LaserScan`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `LaserScan`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LaserScan {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `float32`.
    pub angle_min: f32,
    /// `float32`.
    pub angle_max: f32,
    /// `float32`.
    pub angle_increment: f32,
    /// `float32`.
    pub time_increment: f32,
    /// `float32`.
    pub scan_time: f32,
    /// `float32`.
    pub range_min: f32,
    /// `float32`.
    pub range_max: f32,
    /// `float32[]`.
    pub ranges: Vec<f32>,
    /// `float32[]`.
    pub intensities: Vec<f32>,
}

impl ros2_client::Message for LaserScan {}

impl crate::interface::MessageType for LaserScan {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "LaserScan";
}
