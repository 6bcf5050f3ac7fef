//! `service_msgs/msg/ServiceEventInfo`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `service_msgs`: `ServiceEventInfo`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ServiceEventInfo {
    /// `uint8`.
    pub event_type: u8,
    /// `builtin_interfaces/Time`.
    pub stamp: crate::generated::builtin_interfaces::Time,
    /// `char[16]`.
    pub client_gid: [u8; 16],
    /// `int64`.
    pub sequence_number: i64,
}

impl ros2_client::Message for ServiceEventInfo {}

impl ServiceEventInfo {
    /// `uint8`.
    pub const REQUEST_SENT: u8 = 0;
    /// `uint8`.
    pub const REQUEST_RECEIVED: u8 = 1;
    /// `uint8`.
    pub const RESPONSE_SENT: u8 = 2;
    /// `uint8`.
    pub const RESPONSE_RECEIVED: u8 = 3;
}

impl crate::interface::MessageType for ServiceEventInfo {
    const PACKAGE: &str = "service_msgs";
    const NAME: &str = "ServiceEventInfo";
}
