//! `geometry_msgs/msg/PoseWithCovariance`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `PoseWithCovariance`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseWithCovariance {
    /// `Pose`.
    pub pose: crate::generated::geometry_msgs::Pose,
    /// `float64[36]`.
    pub covariance: crate::wire::FixedArray<f64, 36>,
}

impl ros2_client::Message for PoseWithCovariance {}

impl crate::interface::MessageType for PoseWithCovariance {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "PoseWithCovariance";
}
