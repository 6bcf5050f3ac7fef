//! `nav2_msgs/action/NavigateToPose`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `NavigateToPoseGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateToPoseGoal {
    /// `geometry_msgs/PoseStamped`.
    pub pose: crate::generated::geometry_msgs::PoseStamped,
    /// `string`.
    pub behavior_tree: std::string::String,
}

impl ros2_client::Message for NavigateToPoseGoal {}

/// `nav2_msgs`: `NavigateToPoseResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateToPoseResult {
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for NavigateToPoseResult {}

impl NavigateToPoseResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 9000;
    /// `uint16`.
    pub const FAILED_TO_LOAD_BEHAVIOR_TREE: u16 = 9001;
    /// `uint16`.
    pub const TF_ERROR: u16 = 9002;
    /// `uint16`.
    pub const TIMEOUT: u16 = 9003;
}

/// `nav2_msgs`: `NavigateToPoseFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateToPoseFeedback {
    /// `geometry_msgs/PoseStamped`.
    pub current_pose: crate::generated::geometry_msgs::PoseStamped,
    /// `builtin_interfaces/Duration`.
    pub navigation_time: crate::generated::builtin_interfaces::Duration,
    /// `builtin_interfaces/Duration`.
    pub estimated_time_remaining: crate::generated::builtin_interfaces::Duration,
    /// `int16`.
    pub number_of_recoveries: i16,
    /// `float32`.
    pub distance_remaining: f32,
}

impl ros2_client::Message for NavigateToPoseFeedback {}

/// `nav2_msgs/action/NavigateToPose`.
#[derive(Debug, Clone, Copy)]
pub enum NavigateToPose {}

impl crate::interface::ActionType for NavigateToPose {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "NavigateToPose";
    type Goal = NavigateToPoseGoal;
    type Result = NavigateToPoseResult;
    type Feedback = NavigateToPoseFeedback;
}
