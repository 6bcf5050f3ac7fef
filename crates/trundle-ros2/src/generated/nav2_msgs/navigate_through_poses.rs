//! `nav2_msgs/action/NavigateThroughPoses`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `NavigateThroughPosesGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateThroughPosesGoal {
    /// `nav_msgs/Goals`.
    pub poses: crate::generated::nav_msgs::Goals,
    /// `string`.
    pub behavior_tree: std::string::String,
}

impl ros2_client::Message for NavigateThroughPosesGoal {}

/// `nav2_msgs`: `NavigateThroughPosesResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateThroughPosesResult {
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
    /// `WaypointStatus[]`.
    pub waypoint_statuses: Vec<crate::generated::nav2_msgs::WaypointStatus>,
}

impl ros2_client::Message for NavigateThroughPosesResult {}

impl NavigateThroughPosesResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 9100;
    /// `uint16`.
    pub const FAILED_TO_LOAD_BEHAVIOR_TREE: u16 = 9101;
    /// `uint16`.
    pub const TF_ERROR: u16 = 9102;
    /// `uint16`.
    pub const TIMEOUT: u16 = 9103;
    /// `uint16`.
    pub const NO_VALID_WAYPOINTS: u16 = 9104;
}

/// `nav2_msgs`: `NavigateThroughPosesFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateThroughPosesFeedback {
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
    /// `int16`.
    pub number_of_poses_remaining: i16,
    /// `WaypointStatus[]`.
    pub waypoint_statuses: Vec<crate::generated::nav2_msgs::WaypointStatus>,
}

impl ros2_client::Message for NavigateThroughPosesFeedback {}

/// `nav2_msgs/action/NavigateThroughPoses`.
#[derive(Debug, Clone, Copy)]
pub enum NavigateThroughPoses {}

impl crate::interface::ActionType for NavigateThroughPoses {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "NavigateThroughPoses";
    type Goal = NavigateThroughPosesGoal;
    type Result = NavigateThroughPosesResult;
    type Feedback = NavigateThroughPosesFeedback;
}
