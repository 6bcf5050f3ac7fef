//! `tf2_msgs/msg/TFMessage`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `tf2_msgs`: `TFMessage`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TFMessage {
    /// `geometry_msgs/TransformStamped[]`.
    pub transforms: Vec<crate::generated::geometry_msgs::TransformStamped>,
}

impl ros2_client::Message for TFMessage {}

impl crate::interface::MessageType for TFMessage {
    const PACKAGE: &str = "tf2_msgs";
    const NAME: &str = "TFMessage";
}
