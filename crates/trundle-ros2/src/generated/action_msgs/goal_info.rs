//! `action_msgs/msg/GoalInfo`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `action_msgs`: `GoalInfo`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GoalInfo {
    /// `unique_identifier_msgs/UUID`.
    pub goal_id: crate::generated::unique_identifier_msgs::UUID,
    /// `builtin_interfaces/Time`.
    pub stamp: crate::generated::builtin_interfaces::Time,
}

impl ros2_client::Message for GoalInfo {}

impl crate::interface::MessageType for GoalInfo {
    const PACKAGE: &str = "action_msgs";
    const NAME: &str = "GoalInfo";
}
