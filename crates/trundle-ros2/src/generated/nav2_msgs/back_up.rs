//! `nav2_msgs/action/BackUp`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `BackUpGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BackUpGoal {
    /// `geometry_msgs/Point`.
    pub target: crate::generated::geometry_msgs::Point,
    /// `float32`.
    pub speed: f32,
    /// `builtin_interfaces/Duration`.
    pub time_allowance: crate::generated::builtin_interfaces::Duration,
    /// `bool`.
    pub disable_collision_checks: bool,
}

impl ros2_client::Message for BackUpGoal {}

/// `nav2_msgs`: `BackUpResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BackUpResult {
    /// `builtin_interfaces/Duration`.
    pub total_elapsed_time: crate::generated::builtin_interfaces::Duration,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for BackUpResult {}

impl BackUpResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 710;
    /// `uint16`.
    pub const TIMEOUT: u16 = 711;
    /// `uint16`.
    pub const TF_ERROR: u16 = 712;
    /// `uint16`.
    pub const INVALID_INPUT: u16 = 713;
    /// `uint16`.
    pub const COLLISION_AHEAD: u16 = 714;
}

/// `nav2_msgs`: `BackUpFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BackUpFeedback {
    /// `float32`.
    pub distance_traveled: f32,
}

impl ros2_client::Message for BackUpFeedback {}

/// `nav2_msgs/action/BackUp`.
#[derive(Debug, Clone, Copy)]
pub enum BackUp {}

impl crate::interface::ActionType for BackUp {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "BackUp";
    type Goal = BackUpGoal;
    type Result = BackUpResult;
    type Feedback = BackUpFeedback;
}
