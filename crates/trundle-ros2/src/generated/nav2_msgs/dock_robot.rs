//! `nav2_msgs/action/DockRobot`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `nav2_msgs`: `DockRobotGoal`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DockRobotGoal {
    /// `bool`.
    pub use_dock_id: bool,
    /// `string`.
    pub dock_id: std::string::String,
    /// `geometry_msgs/PoseStamped`.
    pub dock_pose: crate::generated::geometry_msgs::PoseStamped,
    /// `string`.
    pub dock_type: std::string::String,
    /// `float32`.
    pub max_staging_time: f32,
    /// `bool`.
    pub navigate_to_staging_pose: bool,
}

impl ros2_client::Message for DockRobotGoal {}

/// `nav2_msgs`: `DockRobotResult`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DockRobotResult {
    /// `bool`.
    pub success: bool,
    /// `uint16`.
    pub error_code: u16,
    /// `uint16`.
    pub num_retries: u16,
    /// `string`.
    pub error_msg: std::string::String,
}

impl ros2_client::Message for DockRobotResult {}

impl DockRobotResult {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const DOCK_NOT_IN_DB: u16 = 901;
    /// `uint16`.
    pub const DOCK_NOT_VALID: u16 = 902;
    /// `uint16`.
    pub const FAILED_TO_STAGE: u16 = 903;
    /// `uint16`.
    pub const FAILED_TO_DETECT_DOCK: u16 = 904;
    /// `uint16`.
    pub const FAILED_TO_CONTROL: u16 = 905;
    /// `uint16`.
    pub const FAILED_TO_CHARGE: u16 = 906;
    /// `uint16`.
    pub const TIMEOUT: u16 = 907;
    /// `uint16`.
    pub const UNKNOWN: u16 = 999;
}

/// `nav2_msgs`: `DockRobotFeedback`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DockRobotFeedback {
    /// `uint16`.
    pub state: u16,
    /// `builtin_interfaces/Duration`.
    pub docking_time: crate::generated::builtin_interfaces::Duration,
    /// `uint16`.
    pub num_retries: u16,
}

impl ros2_client::Message for DockRobotFeedback {}

impl DockRobotFeedback {
    /// `uint16`.
    pub const NONE: u16 = 0;
    /// `uint16`.
    pub const NAV_TO_STAGING_POSE: u16 = 1;
    /// `uint16`.
    pub const INITIAL_PERCEPTION: u16 = 2;
    /// `uint16`.
    pub const CONTROLLING: u16 = 3;
    /// `uint16`.
    pub const WAIT_FOR_CHARGE: u16 = 4;
    /// `uint16`.
    pub const RETRY: u16 = 5;
}

/// `nav2_msgs/action/DockRobot`.
#[derive(Debug, Clone, Copy)]
pub enum DockRobot {}

impl crate::interface::ActionType for DockRobot {
    const PACKAGE: &str = "nav2_msgs";
    const NAME: &str = "DockRobot";
    type Goal = DockRobotGoal;
    type Result = DockRobotResult;
    type Feedback = DockRobotFeedback;
}
