//! `geometry_msgs/msg/TwistWithCovariance`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `geometry_msgs`: `TwistWithCovariance`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TwistWithCovariance {
    /// `Twist`.
    pub twist: crate::generated::geometry_msgs::Twist,
    /// `float64[36]`.
    pub covariance: crate::wire::FixedArray<f64, 36>,
}

impl ros2_client::Message for TwistWithCovariance {}

impl crate::interface::MessageType for TwistWithCovariance {
    const PACKAGE: &str = "geometry_msgs";
    const NAME: &str = "TwistWithCovariance";
}
