//! `geometry_msgs/msg/TwistStamped`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `TwistStamped`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TwistStamped {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `Twist`.
    pub twist: crate::generated::geometry_msgs::Twist,
}

impl ros2_client::Message for TwistStamped {}

impl crate::interface::MessageType for TwistStamped {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "TwistStamped";
}
