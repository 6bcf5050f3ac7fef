//! `nav2_msgs/action/Spin`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `SpinGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SpinGoal {
    /// `float32`.
    pub target_yaw: f32,
    /// `builtin_interfaces/Duration`.
    pub time_allowance: crate::generated::builtin_interfaces::Duration,
    /// `bool`.
    pub disable_collision_checks: bool,
}

impl ros2_client::Message for SpinGoal {}

/// `nav2_msgs`: `SpinResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SpinResult {
    /// `builtin_interfaces/Duration`.
    pub total_elapsed_time: crate::generated::builtin_interfaces::Duration,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for SpinResult {}

impl SpinResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const UNKNOWN: u16 = 700;
    /// `uint16`.
    pub const TIMEOUT: u16 = 701;
    /// `uint16`.
    pub const TF_ERROR: u16 = 702;
    /// `uint16`.
    pub const COLLISION_AHEAD: u16 = 703;
}

/// `nav2_msgs`: `SpinFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SpinFeedback {
    /// `float32`.
    pub angular_distance_traveled: f32,
}

impl ros2_client::Message for SpinFeedback {}

/// `nav2_msgs/action/Spin`.
#[derive(Debug, Clone, Copy)]
pub enum Spin {}

impl crate::interface::ActionType for Spin {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "Spin";
    type Goal = SpinGoal;
    type Result = SpinResult;
    type Feedback = SpinFeedback;
}
