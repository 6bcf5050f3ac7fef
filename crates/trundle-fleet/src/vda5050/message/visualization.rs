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
    /// Where the robot is.
    pub agv_position: RobotPosition,
    /// How fast it moves.
    pub velocity: Velocity,
}
