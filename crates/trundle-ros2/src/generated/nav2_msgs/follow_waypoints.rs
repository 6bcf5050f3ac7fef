//! `nav2_msgs/action/FollowWaypoints`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `FollowWaypointsGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowWaypointsGoal {
    /// `uint32`.
    pub number_of_loops: u32,
    /// `uint32`.
    pub goal_index: u32,
    /// `geometry_msgs/PoseStamped[]`.
    pub poses: Vec<crate::generated::geometry_msgs::PoseStamped>,
}

impl ros2_client::Message for FollowWaypointsGoal {}

/// `nav2_msgs`: `FollowWaypointsResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowWaypointsResult {
    /// `WaypointStatus[]`.
    pub missed_waypoints: Vec<crate::generated::nav2_msgs::WaypointStatus>,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for FollowWaypointsResult {}

impl FollowWaypointsResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 600;
    /// `uint16`.
    pub const TASK_EXECUTOR_FAILED: u16 = 601;
    /// `uint16`.
    pub const NO_VALID_WAYPOINTS: u16 = 602;
    /// `uint16`.
    pub const STOP_ON_MISSED_WAYPOINT: u16 = 603;
}

/// `nav2_msgs`: `FollowWaypointsFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FollowWaypointsFeedback {
    /// `uint32`.
    pub current_waypoint: u32,
}

impl ros2_client::Message for FollowWaypointsFeedback {}

/// `nav2_msgs/action/FollowWaypoints`.
#[derive(Debug, Clone, Copy)]
pub enum FollowWaypoints {}

impl crate::interface::ActionType for FollowWaypoints {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "FollowWaypoints";
    type Goal = FollowWaypointsGoal;
    type Result = FollowWaypointsResult;
    type Feedback = FollowWaypointsFeedback;
}
