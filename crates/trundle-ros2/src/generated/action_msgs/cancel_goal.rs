//! `action_msgs/srv/CancelGoal`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `action_msgs`: `CancelGoalRequest`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CancelGoalRequest {
    /// `GoalInfo`.
    pub goal_info: crate::generated::action_msgs::GoalInfo,
}

impl ros2_client::Message for CancelGoalRequest {}

/// `action_msgs`: `CancelGoalResponse`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CancelGoalResponse {
    /// `int8`.
    pub return_code: i8,
    /// `GoalInfo[]`.
    pub goals_canceling: Vec<crate::generated::action_msgs::GoalInfo>,
}

impl ros2_client::Message for CancelGoalResponse {}

impl CancelGoalResponse {
    /// `int8`.
    pub const ERROR_NONE: i8 = 0;
    /// `int8`.
    pub const ERROR_REJECTED: i8 = 1;
    /// `int8`.
    pub const ERROR_UNKNOWN_GOAL_ID: i8 = 2;
    /// `int8`.
    pub const ERROR_GOAL_TERMINATED: i8 = 3;
}

/// `action_msgs/srv/CancelGoal`.
#[derive(Debug, Clone, Copy)]
pub enum CancelGoal {}

impl crate::interface::ServiceType for CancelGoal {
    const PACKAGE: &str = "action_msgs";
    const NAME: &str = "CancelGoal";
    type Request = CancelGoalRequest;
    type Response = CancelGoalResponse;
}
