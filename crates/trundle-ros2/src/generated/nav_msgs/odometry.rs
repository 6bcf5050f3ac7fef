//! `nav_msgs/msg/Odometry`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav_msgs`: `Odometry`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct OdometryMessage {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `string`.
    pub child_frame_id: std::string::String,
    /// `geometry_msgs/PoseWithCovariance`.
    pub pose: crate::generated::geometry_msgs::PoseWithCovariance,
    /// `geometry_msgs/TwistWithCovariance`.
    pub twist: crate::generated::geometry_msgs::TwistWithCovariance,
}

impl ros2_client::Message for OdometryMessage {}

impl crate::interface::MessageType for OdometryMessage {
    const PACKAGE: &str = "nav_msgs";
    const NAME: &str = "Odometry";
}
