//! `nav2_msgs/action/UndockRobot`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `UndockRobotGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UndockRobotGoal {
    /// `string`.
    pub dock_type: std::string::String,
    /// `float32`.
    pub max_undocking_time: f32,
}

impl ros2_client::Message for UndockRobotGoal {}

/// `nav2_msgs`: `UndockRobotResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UndockRobotResult {
    /// `bool`.
    pub success: bool,
    /// `uint16`.
    pub error_code: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for UndockRobotResult {}

impl UndockRobotResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const DOCK_NOT_VALID: u16 = 902;
    /// `uint16`.
    pub const FAILED_TO_CONTROL: u16 = 905;
    /// `uint16`.
    pub const TIMEOUT: u16 = 907;
    /// `uint16`.
    pub const UNKNOWN: u16 = 999;
}

/// `nav2_msgs`: `UndockRobotFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UndockRobotFeedback {
    /// `uint8`: a structure without members has this one on the wire.
    pub structure_needs_at_least_one_member: u8,
}

impl ros2_client::Message for UndockRobotFeedback {}

/// `nav2_msgs/action/UndockRobot`.
#[derive(Debug, Clone, Copy)]
pub enum UndockRobot {}

impl crate::interface::ActionType for UndockRobot {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "UndockRobot";
    type Goal = UndockRobotGoal;
    type Result = UndockRobotResult;
    type Feedback = UndockRobotFeedback;
}
