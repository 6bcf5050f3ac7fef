//! `sensor_msgs/msg/Imu`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `Imu`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Imu {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `geometry_msgs/Quaternion`.
    pub orientation: crate::generated::geometry_msgs::Quaternion,
    /// `float64[9]`.
    pub orientation_covariance: [f64; 9],
    /// `geometry_msgs/Vector3`.
    pub angular_velocity: crate::generated::geometry_msgs::Vector3Message,
    /// `float64[9]`.
    pub angular_velocity_covariance: [f64; 9],
    /// `geometry_msgs/Vector3`.
    pub linear_acceleration: crate::generated::geometry_msgs::Vector3Message,
    /// `float64[9]`.
    pub linear_acceleration_covariance: [f64; 9],
}

impl ros2_client::Message for Imu {}

impl crate::interface::MessageType for Imu {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "Imu";
}
