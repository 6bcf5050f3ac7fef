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
    /// Whether it is.
    pub connection_state: ConnectionState,
}

/// Whether the robot is connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ConnectionState {
    /// It is.
    Online,
    /// It has left in order.
    Offline,
    /// The broker lost it: its last will.
    ConnectionBroken,
}
