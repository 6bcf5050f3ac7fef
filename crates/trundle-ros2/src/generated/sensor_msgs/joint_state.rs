//! `sensor_msgs/msg/JointState`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `JointState`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `string[]`.
    pub name: Vec<std::string::String>,
    /// `float64[]`.
    pub position: Vec<f64>,
    /// `float64[]`.
    pub velocity: Vec<f64>,
    /// `float64[]`.
    pub effort: Vec<f64>,
}

impl ros2_client::Message for JointState {}

impl crate::interface::MessageType for JointState {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "JointState";
}
