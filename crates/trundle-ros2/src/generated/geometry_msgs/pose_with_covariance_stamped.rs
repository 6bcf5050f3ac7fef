//! `geometry_msgs/msg/PoseWithCovarianceStamped`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `PoseWithCovarianceStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseWithCovarianceStamped {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `PoseWithCovariance`.
    pub pose: crate::generated::geometry_msgs::PoseWithCovariance,
}

impl ros2_client::Message for PoseWithCovarianceStamped {}

impl crate::interface::MessageType for PoseWithCovarianceStamped {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "PoseWithCovarianceStamped";
}
