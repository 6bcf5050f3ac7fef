//! Whether the robot is connected.

use super::header::MessageHeader;
use serde::Serialize;

/// Whether the robot is connected.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConnectionMessage {
    /// The header.
    #[serde(flatten)]
    pub header: MessageHeader,
    /// State of the connection.
    pub connection_state: ConnectionState,
}

/// Whether the robot is connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ConnectionState {
    /// The robot is connected.
    Online,
    /// The robot disconnected in order.
    Offline,
    /// The broker lost the robot: its last will.
    ConnectionBroken,
}
