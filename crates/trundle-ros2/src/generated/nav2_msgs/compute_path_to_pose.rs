//! `nav2_msgs/action/ComputePathToPose`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `ComputePathToPoseGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ComputePathToPoseGoal {
    /// `geometry_msgs/PoseStamped`.
    pub goal: crate::generated::geometry_msgs::PoseStamped,
    /// `geometry_msgs/PoseStamped`.
    pub start: crate::generated::geometry_msgs::PoseStamped,
    /// `string`.
    pub planner_id: std::string::String,
    /// `bool`.
    pub use_start: bool,
}

impl ros2_client::Message for ComputePathToPoseGoal {}

/// `nav2_msgs`: `ComputePathToPoseResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ComputePathToPoseResult {
    /// `nav_msgs/Path`.
    pub path: crate::generated::nav_msgs::PathMessage,
    /// `builtin_interfaces/Duration`.
    pub planning_time: crate::generated::builtin_interfaces::Duration,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for ComputePathToPoseResult {}

impl ComputePathToPoseResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 200;
    /// `uint16`.
    pub const INVALID_PLANNER: u16 = 201;
    /// `uint16`.
    pub const TF_ERROR: u16 = 202;
    /// `uint16`.
    pub const START_OUTSIDE_MAP: u16 = 203;
    /// `uint16`.
    pub const GOAL_OUTSIDE_MAP: u16 = 204;
    /// `uint16`.
    pub const START_OCCUPIED: u16 = 205;
    /// `uint16`.
    pub const GOAL_OCCUPIED: u16 = 206;
    /// `uint16`.
    pub const TIMEOUT: u16 = 207;
    /// `uint16`.
    pub const NO_VALID_PATH: u16 = 208;
}

/// `nav2_msgs`: `ComputePathToPoseFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ComputePathToPoseFeedback {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for ComputePathToPoseFeedback {}

/// `nav2_msgs/action/ComputePathToPose`.
#[derive(Debug, Clone, Copy)]
pub enum ComputePathToPose {}

impl crate::interface::ActionType for ComputePathToPose {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "ComputePathToPose";
    type Goal = ComputePathToPoseGoal;
    type Result = ComputePathToPoseResult;
    type Feedback = ComputePathToPoseFeedback;
}
