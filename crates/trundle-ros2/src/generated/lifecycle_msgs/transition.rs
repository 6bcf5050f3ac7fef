//! `lifecycle_msgs/msg/Transition`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `Transition`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// `uint8`.
    pub id: u8,
    /// `string`.
    pub label: std::string::String,
}

impl ros2_client::Message for Transition {}

impl Transition {
    /// `uint8`.
    pub const TRANSITION_CREATE: u8 = 0;
    /// `uint8`.
    pub const TRANSITION_CONFIGURE: u8 = 1;
    /// `uint8`.
    pub const TRANSITION_CLEANUP: u8 = 2;
    /// `uint8`.
    pub const TRANSITION_ACTIVATE: u8 = 3;
    /// `uint8`.
    pub const TRANSITION_DEACTIVATE: u8 = 4;
    /// `uint8`.
    pub const TRANSITION_UNCONFIGURED_SHUTDOWN: u8 = 5;
    /// `uint8`.
    pub const TRANSITION_INACTIVE_SHUTDOWN: u8 = 6;
    /// `uint8`.
    pub const TRANSITION_ACTIVE_SHUTDOWN: u8 = 7;
    /// `uint8`.
    pub const TRANSITION_DESTROY: u8 = 8;
    /// `uint8`.
    pub const TRANSITION_ON_CONFIGURE_SUCCESS: u8 = 10;
    /// `uint8`.
    pub const TRANSITION_ON_CONFIGURE_FAILURE: u8 = 11;
    /// `uint8`.
    pub const TRANSITION_ON_CONFIGURE_ERROR: u8 = 12;
    /// `uint8`.
    pub const TRANSITION_ON_CLEANUP_SUCCESS: u8 = 20;
    /// `uint8`.
    pub const TRANSITION_ON_CLEANUP_FAILURE: u8 = 21;
    /// `uint8`.
    pub const TRANSITION_ON_CLEANUP_ERROR: u8 = 22;
    /// `uint8`.
    pub const TRANSITION_ON_ACTIVATE_SUCCESS: u8 = 30;
    /// `uint8`.
    pub const TRANSITION_ON_ACTIVATE_FAILURE: u8 = 31;
    /// `uint8`.
    pub const TRANSITION_ON_ACTIVATE_ERROR: u8 = 32;
    /// `uint8`.
    pub const TRANSITION_ON_DEACTIVATE_SUCCESS: u8 = 40;
    /// `uint8`.
    pub const TRANSITION_ON_DEACTIVATE_FAILURE: u8 = 41;
    /// `uint8`.
    pub const TRANSITION_ON_DEACTIVATE_ERROR: u8 = 42;
    /// `uint8`.
    pub const TRANSITION_ON_SHUTDOWN_SUCCESS: u8 = 50;
    /// `uint8`.
    pub const TRANSITION_ON_SHUTDOWN_FAILURE: u8 = 51;
    /// `uint8`.
    pub const TRANSITION_ON_SHUTDOWN_ERROR: u8 = 52;
    /// `uint8`.
    pub const TRANSITION_ON_ERROR_SUCCESS: u8 = 60;
    /// `uint8`.
    pub const TRANSITION_ON_ERROR_FAILURE: u8 = 61;
    /// `uint8`.
    pub const TRANSITION_ON_ERROR_ERROR: u8 = 62;
    /// `uint8`.
    pub const TRANSITION_CALLBACK_SUCCESS: u8 = 97;
    /// `uint8`.
    pub const TRANSITION_CALLBACK_FAILURE: u8 = 98;
    /// `uint8`.
    pub const TRANSITION_CALLBACK_ERROR: u8 = 99;
}

impl crate::interface::MessageType for Transition {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "Transition";
}
