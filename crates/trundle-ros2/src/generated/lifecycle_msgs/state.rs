//! `lifecycle_msgs/msg/State`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `State`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// `uint8`.
    pub id: u8,
    /// `string`.
    pub label: std::string::String,
}

impl ros2_client::Message for State {}

impl State {
    /// `uint8`.
    pub const PRIMARY_STATE_UNKNOWN: u8 = 0;
    /// `uint8`.
    pub const PRIMARY_STATE_UNCONFIGURED: u8 = 1;
    /// `uint8`.
    pub const PRIMARY_STATE_INACTIVE: u8 = 2;
    /// `uint8`.
    pub const PRIMARY_STATE_ACTIVE: u8 = 3;
    /// `uint8`.
    pub const PRIMARY_STATE_FINALIZED: u8 = 4;
    /// `uint8`.
    pub const TRANSITION_STATE_CONFIGURING: u8 = 10;
    /// `uint8`.
    pub const TRANSITION_STATE_CLEANINGUP: u8 = 11;
    /// `uint8`.
    pub const TRANSITION_STATE_SHUTTINGDOWN: u8 = 12;
    /// `uint8`.
    pub const TRANSITION_STATE_ACTIVATING: u8 = 13;
    /// `uint8`.
    pub const TRANSITION_STATE_DEACTIVATING: u8 = 14;
    /// `uint8`.
    pub const TRANSITION_STATE_ERRORPROCESSING: u8 = 15;
}

impl crate::interface::MessageType for State {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "State";
}
