//! `geometry_msgs/msg/Transform`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `Transform`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Transform {
    /// `Vector3`.
    pub translation: crate::generated::geometry_msgs::Vector3Message,
    /// `Quaternion`.
    pub rotation: crate::generated::geometry_msgs::Quaternion,
}

impl ros2_client::Message for Transform {}

impl crate::interface::MessageType for Transform {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "Transform";
}
