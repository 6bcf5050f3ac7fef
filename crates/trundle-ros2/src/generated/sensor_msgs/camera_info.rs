//! `sensor_msgs/msg/CameraInfo`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `CameraInfo`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraInfoMessage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `uint32`.
    pub height: u32,
    /// `uint32`.
    pub width: u32,
    /// `string`.
    pub distortion_model: std::string::String,
    /// `float64[]`.
    pub d: Vec<f64>,
    /// `float64[9]`.
    pub k: [f64; 9],
    /// `float64[9]`.
    pub r: [f64; 9],
    /// `float64[12]`.
    pub p: [f64; 12],
    /// `uint32`.
    pub binning_x: u32,
    /// `uint32`.
    pub binning_y: u32,
    /// `RegionOfInterest`.
    pub roi: crate::generated::sensor_msgs::RegionOfInterest,
}

impl ros2_client::Message for CameraInfoMessage {}

impl crate::interface::MessageType for CameraInfoMessage {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "CameraInfo";
}
