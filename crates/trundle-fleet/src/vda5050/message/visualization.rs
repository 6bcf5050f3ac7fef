//! The position of the robot, for pictures.

use super::header::MessageHeader;
use super::state::{RobotPosition, Velocity};
use serde::Serialize;

/// The position of the robot, for pictures.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Visualization {
    /// The header.
    #[serde(flatten)]
    pub header: MessageHeader,
    /// Position of the robot.
    pub agv_position: RobotPosition,
    /// Velocity of the robot.
    pub velocity: Velocity,
}
