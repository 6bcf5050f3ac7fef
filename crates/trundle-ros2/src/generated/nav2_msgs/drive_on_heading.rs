//! `nav2_msgs/action/DriveOnHeading`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `DriveOnHeadingGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveOnHeadingGoal {
    /// `geometry_msgs/Point`.
    pub target: crate::generated::geometry_msgs::Point,
    /// `float32`.
    pub speed: f32,
    /// `builtin_interfaces/Duration`.
    pub time_allowance: crate::generated::builtin_interfaces::Duration,
    /// `bool`.
    pub disable_collision_checks: bool,
}

impl ros2_client::Message for DriveOnHeadingGoal {}

/// `nav2_msgs`: `DriveOnHeadingResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveOnHeadingResult {
    /// `builtin_interfaces/Duration`.
    pub total_elapsed_time: crate::generated::builtin_interfaces::Duration,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for DriveOnHeadingResult {}

impl DriveOnHeadingResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 720;
    /// `uint16`.
    pub const TIMEOUT: u16 = 721;
    /// `uint16`.
    pub const TF_ERROR: u16 = 722;
    /// `uint16`.
    pub const COLLISION_AHEAD: u16 = 723;
    /// `uint16`.
    pub const INVALID_INPUT: u16 = 724;
}

/// `nav2_msgs`: `DriveOnHeadingFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveOnHeadingFeedback {
    /// `float32`.
    pub distance_traveled: f32,
}

impl ros2_client::Message for DriveOnHeadingFeedback {}

/// `nav2_msgs/action/DriveOnHeading`.
#[derive(Debug, Clone, Copy)]
pub enum DriveOnHeading {}

impl crate::interface::ActionType for DriveOnHeading {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "DriveOnHeading";
    type Goal = DriveOnHeadingGoal;
    type Result = DriveOnHeadingResult;
    type Feedback = DriveOnHeadingFeedback;
}
