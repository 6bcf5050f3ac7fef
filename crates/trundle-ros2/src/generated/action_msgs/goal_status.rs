//! `action_msgs/msg/GoalStatus`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `action_msgs`: `GoalStatus`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GoalStatus {
    /// `GoalInfo`.
    pub goal_info: crate::generated::action_msgs::GoalInfo,
    /// `int8`.
    pub status: i8,
}

impl ros2_client::Message for GoalStatus {}

impl GoalStatus {
    /// `int8`.
    pub const STATUS_UNKNOWN: i8 = 0;
    /// `int8`.
    pub const STATUS_ACCEPTED: i8 = 1;
    /// `int8`.
    pub const STATUS_EXECUTING: i8 = 2;
    /// `int8`.
    pub const STATUS_CANCELING: i8 = 3;
    /// `int8`.
    pub const STATUS_SUCCEEDED: i8 = 4;
    /// `int8`.
    pub const STATUS_CANCELED: i8 = 5;
    /// `int8`.
    pub const STATUS_ABORTED: i8 = 6;
}

impl crate::interface::MessageType for GoalStatus {
    const PACKAGE: &str = "action_msgs";
    const NAME: &str = "GoalStatus";
}
