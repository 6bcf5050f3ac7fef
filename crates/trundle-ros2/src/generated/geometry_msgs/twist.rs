//! `geometry_msgs/msg/Twist`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Twist`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// `Vector3`.
    pub linear: crate::generated::geometry_msgs::Vector3Message,
    /// `Vector3`.
    pub angular: crate::generated::geometry_msgs::Vector3Message,
}

impl ros2_client::Message for Twist {}

impl crate::interface::MessageType for Twist {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Twist";
}
