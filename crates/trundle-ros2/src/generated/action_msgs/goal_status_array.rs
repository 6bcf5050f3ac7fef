//! `action_msgs/msg/GoalStatusArray`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `action_msgs`: `GoalStatusArray`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GoalStatusArray {
    /// `GoalStatus[]`.
    pub status_list: Vec<crate::generated::action_msgs::GoalStatus>,
}

impl ros2_client::Message for GoalStatusArray {}

impl crate::interface::MessageType for GoalStatusArray {
    const PACKAGE: &str = "action_msgs";
    const NAME: &str = "GoalStatusArray";
}
