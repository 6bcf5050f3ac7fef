//! `nav2_msgs/action/FollowPath`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `FollowPathGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowPathGoal {
    /// `nav_msgs/Path`.
    pub path: crate::generated::nav_msgs::PathMessage,
    /// `string`.
    pub controller_id: std::string::String,
    /// `string`.
    pub goal_checker_id: std::string::String,
    /// `string`.
    pub progress_checker_id: std::string::String,
}

impl ros2_client::Message for FollowPathGoal {}

/// `nav2_msgs`: `FollowPathResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowPathResult {
    /// `std_msgs/Empty`.
    pub result: crate::generated::std_msgs::Empty,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for FollowPathResult {}

impl FollowPathResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 100;
    /// `uint16`.
    pub const INVALID_CONTROLLER: u16 = 101;
    /// `uint16`.
    pub const TF_ERROR: u16 = 102;
    /// `uint16`.
    pub const INVALID_PATH: u16 = 103;
    /// `uint16`.
    pub const PATIENCE_EXCEEDED: u16 = 104;
    /// `uint16`.
    pub const FAILED_TO_MAKE_PROGRESS: u16 = 105;
    /// `uint16`.
    pub const NO_VALID_CONTROL: u16 = 106;
    /// `uint16`.
    pub const CONTROLLER_TIMED_OUT: u16 = 107;
}

/// `nav2_msgs`: `FollowPathFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowPathFeedback {
    /// `float32`.
    pub distance_to_goal: f32,
    /// `float32`.
    pub speed: f32,
}

impl ros2_client::Message for FollowPathFeedback {}

/// `nav2_msgs/action/FollowPath`.
#[derive(Debug, Clone, Copy)]
pub enum FollowPath {}

impl crate::interface::ActionType for FollowPath {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "FollowPath";
    type Goal = FollowPathGoal;
    type Result = FollowPathResult;
    type Feedback = FollowPathFeedback;
}
